// Scenes made by hand from the plain structs, so that these tests need no loader, and short cuts to render them.
#pragma once
#include <initializer_list>
#include <utility>
#include <vector>

#include "host/image/band.h"
#include "reference_cpu/reference.h"

namespace solidcast::reference {

inline solidcast::World worldOf(std::initializer_list<Shape> shapes) {
  solidcast::World world;
  for (const Shape& shape : shapes) {
    world.groups[0].members.push_back({false, static_cast<std::uint32_t>(world.solids.size())});
    world.solids.push_back({"", shape});
  }
  return world;
}

inline Scene sceneOf(solidcast::World world) {
  Scene scene;
  scene.camera = solidcast::PerspectiveCamera{{0, 0, 10}, {0, 0, -1}, {0, 1, 0}, 45, 60};
  scene.world = std::move(world);
  return scene;
}

/// The course sheet's scene of nine solids.
inline Scene courseScene() {
  return sceneOf(worldOf(
      {solidcast::Sphere{{-2, 1.7, 0}, 2}, solidcast::Sphere{{1, -1, 1}, 2.2}, solidcast::Sphere{{3, 0.8, -2}, 2},
       solidcast::InfinitePlane{{0, -1, 0}, {0, 1, 0}}, solidcast::Triangle{{-2, 3.7, 0}, {1, 2, 1}, {3, 2.8, -2}},
       solidcast::Triangle{{3, 2, 3}, {3, 2, -3}, {-3, 2, -3}},
       solidcast::Quad{{1, -0.9, 4.5}, {-2, 0, 0}, {0, 0.1, -2}}, solidcast::Disc{{-3, -0.75, 1.5}, {0, 0.5, 0.5}, 1.5},
       solidcast::AABox{{2, 1.5, -0.5}, {3, 2.5, 2.5}}}));
}

/// Its second integrator.
inline solidcast::RayCastingDistIntegrator courseDistance() { return {{1, 0.2, 0}, 4, {0.2, 1, 0}, 12}; }

/// Ellipsoid, cylinder, sphere and paraboloid.
inline Scene quadricScene() {
  return sceneOf(worldOf(
      {solidcast::Quadric{{0.25, 1, 1, 0, 0, 0, 0, 0, 0, -5}}, solidcast::Quadric{{1, 0, 1, 0, 0, 0, -4, 0, 0, 2}},
       solidcast::Quadric{{1, 1, 1, 0, 0, 0, 4, -4, -4, 8}}, solidcast::Quadric{{0, 1, 1, 0, 0, 0, -0.25, 4, -2, 4}}}));
}

inline RenderJob jobOf(const Scene& scene, const Channels& channels) {
  RenderJob job;
  job.width = scene.width;
  job.height = scene.height;
  job.channels = channels;
  return job;
}

inline Channels allChannels() { return {true, true, true, true, true, true, true}; }

template <class Value>
void append(std::vector<Value>& whole, const std::vector<Value>& part) {
  whole.insert(whole.end(), part.begin(), part.end());
}

/// All bands of a job in one.
inline Band renderWhole(const Scene& scene, const RenderJob& job, Precision precision, int threads = 0) {
  Band whole;
  render(
      scene, job, precision,
      [&](Band& band) {
        whole.rows += band.rows;
        whole.width = band.width;
        append(whole.rgb8, band.rgb8);
        append(whole.radiance, band.radiance);
        append(whole.distance, band.distance);
        append(whole.solid, band.solid);
        append(whole.normal, band.normal);
        append(whole.local, band.local);
        append(whole.position, band.position);
      },
      threads);
  return whole;
}

}  // namespace solidcast::reference
