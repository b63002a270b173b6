// A scene in POV-Ray's language: the camera by its own vectors, which also settles the handedness; a white light of
// diffuse 1 in the camera makes radiance the cosine, of both sides of a surface: what `--two-sided` shows.
#include <cmath>
#include <sstream>

#include "host/bench/processes.h"
#include "host/bench/vec.h"

namespace solidcast::bench {
namespace {

std::ostream& operator<<(std::ostream& out, const Vec& v) {
  return out << '<' << v.x + 0.0 << ',' << v.y + 0.0 << ',' << v.z + 0.0 << '>';  // no "-0"
}

struct Solids {
  std::ostream& out;
  void operator()(const InfinitePlane& s) const {
    const Vec n = glm::normalize(vec(s.normal));
    out << "plane{" << n << ',' << glm::dot(n, vec(s.origin));
  }
  void operator()(const AABox& s) const {
    const Vec a = vec(s.corner1), b = vec(s.corner2);
    out << "box{" << glm::min(a, b) << ',' << glm::max(a, b);
  }
  void operator()(const Sphere& s) const { out << "sphere{" << vec(s.center) << ',' << s.radius; }
  void operator()(const Disc& s) const { out << "disc{" << vec(s.center) << ',' << vec(s.normal) << ',' << s.radius; }
  void operator()(const Triangle& s) const { out << "triangle{" << vec(s.v1) << ',' << vec(s.v2) << ',' << vec(s.v3); }
  void operator()(const Quad& s) const {
    const Vec v = vec(s.vertex), a = vec(s.span1), b = vec(s.span2);
    out << "polygon{5," << v << ',' << v + a << ',' << v + a + b << ',' << v + b << ',' << v;
  }
  void operator()(const Quadric& s) const {
    const auto& k = s.coefficients;
    out << "quadric{" << Vec(k[0], k[1], k[2]) << ',' << Vec(k[3], k[4], k[5]) << ',' << Vec(k[6], k[7], k[8]) << ','
        << k[9];
  }
};

struct Axes {
  Vec center, forward, right, up;
};
template <class C>
Axes axesOf(const C& camera) {
  Axes a{vec(camera.center), glm::normalize(vec(camera.forward)), {}, {}};
  a.right = glm::normalize(glm::cross(a.forward, vec(camera.up)));
  a.up = glm::cross(a.right, a.forward);
  return a;
}
double extent(double degrees) { return 2 * std::tan(degrees * M_PI / 360); }

struct Cameras {
  std::ostream& out;
  void write(const char* kind, const Axes& a, double across, double upwards, const std::string& more = "") const {
    out << "camera{" << kind << " location " << a.center << " direction " << a.forward << " right " << a.right * across
        << " up " << a.up * upwards << more << "}\n";
  }
  void operator()(const PerspectiveCamera& c) const {
    write("perspective", axesOf(c), extent(c.horizontalAngle), extent(c.verticalAngle));
  }
  void operator()(const OrthographicCamera& c) const { write("orthographic", axesOf(c), c.scaleX, c.scaleY); }
  void operator()(const EnvironmentCamera& c) const {
    std::ostringstream angles;
    angles << " angle " << c.horizontalAngle << ' ' << c.verticalAngle;
    write("spherical", axesOf(c), 1, 1, angles.str());
  }
};

}  // namespace

std::string povrayScene(const Scene& scene) {
  std::ostringstream out;
  out.precision(17);
  out << "#version 3.7;\nglobal_settings{assumed_gamma 1 max_trace_level 1}\nbackground{rgb 0}\n"
         "#default{texture{pigment{rgb 1} finish{ambient 0 diffuse 1}}}\n";
  std::visit(Cameras{out}, scene.camera);
  std::visit([&](const auto& c) { out << "light_source{" << vec(c.center) << ", rgb 1 shadowless}\n"; }, scene.camera);
  for (const SolidEntry& solid : scene.world.solids) {
    std::visit(Solids{out}, solid.shape);
    out << "}\n";
  }
  return out.str();
}

}  // namespace solidcast::bench
