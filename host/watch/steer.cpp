#include "host/watch/steer.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace solidcast::watch {
namespace {

constexpr double kSteepest = 89;   // degrees from the horizontal
constexpr double kNearest = 1e-6;  // of what is looked at, relative to the scene's coordinates

glm::dvec3 vec(const Triple& t) { return {t[0], t[1], t[2]}; }
Triple triple(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

glm::dvec3 turned(const glm::dvec3& v, const glm::dvec3& axis, double degrees) {
  return glm::dmat3(glm::rotate(glm::dmat4(1), glm::radians(degrees), axis)) * v;
}

struct Axes {
  glm::dvec3 center, forward, up, right;

  explicit Axes(const Camera& camera) {
    std::visit(
        [this](const auto& c) {
          center = vec(c.center);
          forward = glm::normalize(vec(c.forward));
          up = glm::normalize(vec(c.up));
        },
        camera);
    right = glm::normalize(glm::cross(forward, up));
  }
};

Camera placed(Camera camera, const glm::dvec3& center, const glm::dvec3& forward) {
  std::visit(
      [&](auto& c) {
        c.center = triple(center);
        c.forward = triple(forward);
      },
      camera);
  return camera;
}

/// Width and height of what is seen at the pivot's distance.
glm::dvec2 extent(const Camera& camera, double distance) {
  if (const auto* ortho = std::get_if<OrthographicCamera>(&camera)) return {ortho->scaleX, ortho->scaleY};
  const auto across = [distance](double angle) {
    return 2 * distance * std::tan(glm::radians(std::min(angle, 170.0)) / 2);
  };
  return std::visit(
      [&across](const auto& c) -> glm::dvec2 {
        if constexpr (requires { c.horizontalAngle; }) return {across(c.horizontalAngle), across(c.verticalAngle)};
        else return {};
      },
      camera);
}

}  // namespace

Camera orbited(const Camera& camera, const Triple& pivot, double right, double up) {
  const Axes axes(camera);
  const double slope = glm::degrees(std::asin(std::clamp(glm::dot(axes.forward, axes.up), -1.0, 1.0)));
  const double most = std::max(kSteepest, std::abs(slope));
  const double pitch = std::clamp(slope + up, -most, most) - slope;
  const auto moved = [&](const glm::dvec3& v) { return turned(turned(v, axes.right, pitch), axes.up, right); };
  return placed(camera, vec(pivot) + moved(axes.center - vec(pivot)), glm::normalize(moved(axes.forward)));
}

Camera panned(const Camera& camera, const Triple& pivot, double right, double up) {
  const Axes axes(camera);
  const double distance = std::max(glm::dot(vec(pivot) - axes.center, axes.forward), 0.0);
  const glm::dvec2 seen = extent(camera, distance > 0 ? distance : 1);
  const glm::dvec3 upward = glm::cross(axes.right, axes.forward);
  return placed(camera, axes.center - right * seen.x * axes.right - up * seen.y * upward, axes.forward);
}

Camera zoomed(const Camera& camera, const Triple& pivot, double factor) {
  if (std::holds_alternative<EnvironmentCamera>(camera)) return camera;
  if (auto ortho = camera; auto* c = std::get_if<OrthographicCamera>(&ortho)) {
    c->scaleX *= factor;
    c->scaleY *= factor;
    return ortho;
  }
  const Axes axes(camera);
  const glm::dvec3 away = axes.center - vec(pivot);
  const double least = kNearest * (1 + glm::length(vec(pivot)));
  if (glm::length(away) * factor < least) return camera;
  return placed(camera, vec(pivot) + factor * away, axes.forward);
}

}  // namespace solidcast::watch
