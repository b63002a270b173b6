#include "host/bench/rays.h"

#include <cmath>
#include <glm/glm.hpp>

#include "host/bench/vec.h"

namespace solidcast::bench {
namespace {

constexpr int padded(int n, int to) { return (n + to - 1) / to * to; }
void store(float (&to)[3], glm::dvec3 v) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(v[i]);
}

}  // namespace

Rays::Rays(const Scene& scene, int width, int height)
    : camera_(static_cast<CameraKind>(scene.camera.index())), width_(width), height_(height) {
  const int stride = padded(width, kPacketWidth);
  p_.resize(static_cast<std::size_t>(stride));
  q_.resize(p_.size());
  rows_.resize(static_cast<std::size_t>(padded(height, kPacketRows)));
  const auto place = [](int at, int of) { return (2 * at + 1.0) / of - 1; };
  const auto axes = [](const auto& camera) {
    const glm::dvec3 forward = glm::normalize(vec(camera.forward));
    const glm::dvec3 right = glm::normalize(glm::cross(forward, vec(camera.up)));
    return glm::dmat3(right, glm::cross(right, forward), forward);
  };
  const auto each = [&](const auto& camera, auto column, auto row) {
    const glm::dmat3 m = axes(camera);
    for (int i = 0; i < stride; ++i)
      column(place(i, width), p_[static_cast<std::size_t>(i)], q_[static_cast<std::size_t>(i)]);
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      rows_[j] = {};
      store(rows_[j].origin, vec(camera.center));
      row(-place(static_cast<int>(j), height), m, rows_[j]);
    }
  };
  if (const auto* c = std::get_if<PerspectiveCamera>(&scene.camera)) {
    const double reachX = std::tan(glm::radians(c->horizontalAngle / 2)),
                 reachY = std::tan(glm::radians(c->verticalAngle / 2));
    each(
        *c, [&](double x, float& p, float& q) { p = static_cast<float>(x * reachX), q = 0; },
        [&](double y, const glm::dmat3& m, RayRow& row) {
          store(row.a, m[2] + y * reachY * m[1]);
          store(row.b, m[0]);
        });
  } else if (const auto* o = std::get_if<OrthographicCamera>(&scene.camera)) {
    each(
        *o, [&](double x, float& p, float& q) { p = static_cast<float>(x * o->scaleX / 2), q = 0; },
        [&](double y, const glm::dmat3& m, RayRow& row) {
          store(row.origin, vec(o->center) + y * o->scaleY / 2 * m[1]);
          store(row.across, m[0]);
          store(row.a, m[2]);
        });
  } else {
    const auto& e = std::get<EnvironmentCamera>(scene.camera);
    each(
        e,
        [&](double x, float& p, float& q) {
          const double theta = x * glm::radians(e.horizontalAngle / 2);
          p = static_cast<float>(std::cos(theta)), q = static_cast<float>(std::sin(theta));
        },
        [&](double y, const glm::dmat3& m, RayRow& row) {
          const double phi = y * glm::radians(e.verticalAngle / 2);
          store(row.a, std::sin(phi) * m[1]);
          store(row.b, std::cos(phi) * m[2]);
          store(row.c, std::cos(phi) * m[0]);
        });
  }
}

RayView Rays::view() const {
  return {p_.data(), q_.data(), rows_.data(), camera_, width_, height_, static_cast<int>(p_.size())};
}

std::size_t Rays::pixels() const { return p_.size() * rows_.size(); }

Light lightOf(const Scene& scene) {
  Light light{};
  light.twoSided = scene.twoSided;
  if (const auto* dist = std::get_if<RayCastingDistIntegrator>(&scene.integrator)) {
    light.dist = true;
    store(light.nearColor, vec(dist->nearColor));
    store(light.step, vec(dist->farColor) - vec(dist->nearColor));
    light.nearDist = static_cast<float>(dist->nearDist);
    light.scale = static_cast<float>(1 / (dist->farDist - dist->nearDist));
  }
  return light;
}

}  // namespace solidcast::bench
