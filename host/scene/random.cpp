#include "host/scene/random.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "host/error.h"
#include "host/scene/build.h"
#include "host/scene/fields.h"
#include "host/scene/quadric_forms.h"
#include "host/scene/rules.h"
#include "host/scene/triple.h"

namespace solidcast {
namespace {

constexpr double kCloudRadius = 10;

/// Six decimals: short to print, and still exactly what is read back.
double shorten(double x) { return std::round(x * 1e6) / 1e6; }
Triple shorten(const Triple& v) { return {shorten(v[0]), shorten(v[1]), shorten(v[2])}; }

Triple unit(const Triple& v) { return scaled(v, 1 / std::sqrt(dot(v, v))); }

class Maker {
 public:
  Maker(std::uint64_t seed, double room) : bits_(seed), room_(room) {}

  Shape shape(const std::string& kind) {
    if (kind == "sphere") return Sphere{place(), size()};
    if (kind == "box") return box();
    if (kind == "disc") return Disc{place(), shorten(direction()), size()};
    if (kind == "triangle") {
      const Triple middle = place();
      return Triangle{corner(middle), corner(middle), corner(middle)};
    }
    if (kind == "quad") {
      const Triple vertex = place();
      return Quad{vertex, shorten(arm()), shorten(arm())};
    }
    if (kind == "quadric") return ellipsoid();
    return facet();
  }

  std::size_t upTo(std::size_t count) { return static_cast<std::size_t>(uniform() * count); }

 private:
  /// In [0, 1). The standard's distributions differ between libraries; its engines do not.
  double uniform() { return (bits_() >> 11) * 0x1p-53; }

  Triple inUnitBall() {
    Triple p;
    do {
      for (double& x : p) x = 2 * uniform() - 1;
    } while (dot(p, p) > 1);
    return p;
  }

  Triple direction() {
    Triple p;
    do p = inUnitBall();
    while (dot(p, p) < 1e-3);
    return unit(p);
  }

  Triple place() { return shorten(scaled(inUnitBall(), kCloudRadius)); }
  double size() { return std::max(1e-6, shorten((0.2 + 0.4 * uniform()) * room_)); }
  Triple arm() {
    const Triple along = direction();
    return scaled(along, size());
  }
  Triple corner(const Triple& middle) { return shorten(plus(middle, arm())); }

  Shape box() {
    const Triple middle = place(), half = {size(), size(), size()};
    return AABox{shorten(plus(middle, scaled(half, -1))), shorten(plus(middle, half))};
  }

  /// Faces zero from behind the cloud (z > 0 is where the camera is).
  Shape facet() {
    Triple normal = direction();
    normal[2] = std::abs(normal[2]);
    return InfinitePlane{shorten(scaled(normal, -kCloudRadius)), shorten(normal)};
  }

  /// Sum over three orthonormal directions q of (q.(x-c)/r)^2 = 1.
  Shape ellipsoid() {
    const Triple c = place(), first = direction();
    Triple other = direction();
    while (std::abs(dot(first, other)) > 0.9) other = direction();
    const Triple second = unit(cross(first, other));
    std::array<double, 10> k{};
    k[9] = -1;
    for (const Triple& q : {first, second, cross(first, second)}) {
      const double r = size(), w = 1 / (r * r), along = dot(q, c);
      for (int i = 0; i < 3; ++i) k[i] += w * q[i] * q[i];
      k[3] += 2 * w * q[0] * q[1];
      k[4] += 2 * w * q[0] * q[2];
      k[5] += 2 * w * q[1] * q[2];
      for (int i = 0; i < 3; ++i) k[6 + i] -= 2 * w * along * q[i];
      k[9] += w * along * along;
    }
    return Quadric{k};
  }

  std::mt19937_64 bits_;
  double room_;  // edge of the cube that one solid has for itself
};

/// Sound shapes only: chance may make a sliver.
Shape soundShape(Maker& maker, const std::string& kind) {
  for (;;) {
    const Shape shape = maker.shape(kind);
    std::vector<Fault> warnings;
    try {
      checkShape(shape, warnings);
    } catch (const Fault&) { continue; }
    if (warnings.empty()) return shape;
  }
}

}  // namespace

const std::vector<std::string>& randomKinds() {
  static const std::vector<std::string> kinds = {"mixed",    "sphere", "box",     "disc",
                                                 "triangle", "quad",   "quadric", "infinite_plane"};
  return kinds;
}

Scene randomScene(const std::string& kind, std::uint32_t count, std::uint64_t seed) {
  const std::vector<std::string>& kinds = randomKinds();
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw Error(Exit::usage,
                "unknown kind " + inQuotes(kind) + ", expected " + oneOf(kind, Names(kinds.begin(), kinds.end())));
  Scene scene;
  // Square pixels at 640x480: tan(h/2) = 4/3 tan(v/2).
  scene.camera = PerspectiveCamera{{0, 0, 30}, {0, 0, -1}, {0, 1, 0}, 45, 57.822402};
  scene.distParameters = RayCastingDistIntegrator{{1, 0.8, 0.3}, 20, {0.1, 0.2, 0.6}, 40};
  Maker maker(seed, shorten(2 * kCloudRadius / std::cbrt(std::max(count, 1u))));
  for (std::uint32_t i = 0; i < count; ++i) {
    if (kind != "mixed") addSolid(scene.world, soundShape(maker, kind));
    else if (i == 0) addSolid(scene.world, InfinitePlane{{0, -kCloudRadius, 0}, {0, 1, 0}});
    else addSolid(scene.world, soundShape(maker, kinds[1 + maker.upTo(6)]));
  }
  return scene;
}

}  // namespace solidcast
