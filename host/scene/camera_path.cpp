#include "host/scene/camera_path.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <glm/glm.hpp>
#include <iterator>

#include "host/error.h"
#include "host/scene/glm_triple.h"
#include "host/scene/read.h"

namespace solidcast {
namespace {

struct Axes {
  glm::dvec3 center, forward, up;
};

Axes axesOf(const Camera& camera) {
  return std::visit(
      [](const auto& c) {
        return Axes{vec(c.center), glm::normalize(vec(c.forward)), glm::normalize(vec(c.up))};
      },
      camera);
}

Camera withAxes(Camera camera, const Axes& axes) {
  std::visit([&](auto& c) { c.center = triple(axes.center), c.forward = triple(axes.forward), c.up = triple(axes.up); },
             camera);
  return camera;
}

template <class C>
auto extent(C& camera) {
  if constexpr (std::is_same_v<std::remove_const_t<C>, OrthographicCamera>)
    return std::pair{&camera.scaleX, &camera.scaleY};
  else return std::pair{&camera.horizontalAngle, &camera.verticalAngle};
}

Camera mixed(const Camera& a, const Camera& b, double part) {
  const Axes from = axesOf(a), to = axesOf(b);
  const glm::dvec3 forward = glm::mix(from.forward, to.forward, part), up = glm::mix(from.up, to.up, part);
  if (glm::length(glm::cross(forward, up)) < 1e-6)
    throw Error(Exit::usage,
                "camera path: half way between two keys nothing says where to look, expected keys that look "
                "less than half a turn apart");
  Camera camera = withAxes(a, {glm::mix(from.center, to.center, part), forward, up});
  std::visit(
      [&](auto& c) {
        const auto mine = extent(c);
        const auto other = extent(std::get<std::decay_t<decltype(c)>>(b));
        *mine.first = glm::mix(*mine.first, *other.first, part);
        *mine.second = glm::mix(*mine.second, *other.second, part);
      },
      camera);
  return camera;
}

struct Middle {
  glm::dvec3 sum{0};
  int count = 0;
  void add(const glm::dvec3& p) { sum += p, ++count; }
  void operator()(const InfinitePlane&) {}
  void operator()(const Quadric&) {}
  void operator()(const AABox& b) { add((vec(b.corner1) + vec(b.corner2)) * 0.5); }
  void operator()(const Sphere& s) { add(vec(s.center)); }
  void operator()(const Disc& d) { add(vec(d.center)); }
  void operator()(const Triangle& t) { add((vec(t.v1) + vec(t.v2) + vec(t.v3)) / 3.0); }
  void operator()(const Quad& q) { add(vec(q.vertex) + (vec(q.span1) + vec(q.span2)) * 0.5); }
};

}  // namespace

CameraPath loadCameraPath(const std::string& file, std::vector<std::string>& warnings) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw Error(Exit::usage, file + ": cannot be read, expected a camera path (a JSON list of cameras)");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const Json list = Json::parse(text, nullptr, false, true);
  if (list.is_discarded()) throw Error(Exit::usage, file + ": is not JSON, expected a list of cameras");
  if (!list.is_array() || list.empty())
    throw Error(Exit::usage,
                file + ": holds " + (list.is_array() ? "no camera" : typeName(list)) + ", expected a list of cameras");
  CameraPath path;
  std::vector<Fault> found;
  try {
    for (std::size_t i = 0; i < list.size(); ++i) {
      path.push_back(readCamera(Fields(list[i], numbered("/", i)), found));
      if (path[i].index() != path[0].index())
        throw Fault{numbered("/", i) + "/type", "another kind of camera than the first, expected all of one kind"};
    }
  } catch (const Fault& fault) { throw Error(Exit::usage, file + ": " + fault.where + ": " + fault.text); }
  for (const Fault& warning : found) warnings.push_back(file + ": " + warning.where + ": " + warning.text);
  return path;
}

Camera cameraAt(const CameraPath& path, double position) {
  const double place = std::clamp(position, 0.0, 1.0) * static_cast<double>(path.size() - 1);
  const auto key = static_cast<std::size_t>(place);
  if (key + 1 >= path.size()) return path.back();
  const double part = place - static_cast<double>(key);
  return part == 0 ? path[key] : mixed(path[key], path[key + 1], part);
}

Triple pointLookedAt(const Scene& scene) {
  Middle middle;
  for (const SolidEntry& solid : scene.world.solids) std::visit(middle, solid.shape);
  const Axes axes = axesOf(scene.camera);
  double ahead = 1;
  if (middle.count > 0) {
    const double along = glm::dot(middle.sum / double(middle.count) - axes.center, axes.forward);
    if (along > 0) ahead = along;
  }
  return triple(axes.center + ahead * axes.forward);
}

Camera orbited(const Camera& camera, const Triple& pivot, double angle) {
  Axes axes = axesOf(camera);
  const glm::dvec3 right = glm::normalize(glm::cross(axes.forward, axes.up)), axis = glm::cross(right, axes.forward);
  const double radians = angle * M_PI / 180, c = std::cos(radians), s = std::sin(radians);
  // Rodrigues' formula.
  const auto turned = [&](const glm::dvec3& v) {
    return v * c + glm::cross(axis, v) * s + axis * (glm::dot(axis, v) * (1 - c));
  };
  axes.center = vec(pivot) + turned(axes.center - vec(pivot));
  axes.forward = turned(axes.forward);
  axes.up = turned(axes.up);
  return withAxes(camera, axes);
}

}  // namespace solidcast
