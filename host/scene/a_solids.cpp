// The course sheet's scene, in the sheet's order (which decides ties).
#include "host/scene/build.h"
#include "host/scene/load.h"

namespace solidcast {

Scene aSolids() {
  Scene scene;
  scene.file = "a_solids";
  scene.width = 640;
  scene.height = 480;
  scene.camera = PerspectiveCamera{
      .center = {0, 0, 10}, .forward = {0, 0, -1}, .up = {0, 1, 0}, .verticalAngle = 45, .horizontalAngle = 60};
  scene.integrator = RayCastingIntegrator{};
  scene.distParameters =
      RayCastingDistIntegrator{.nearColor = {1, 0.2, 0}, .nearDist = 4, .farColor = {0.2, 1, 0}, .farDist = 12};

  World& world = scene.world;
  addSolid(world, Sphere{{-2, 1.7, 0}, 2}, "sphere 1");
  addSolid(world, Sphere{{1, -1, 1}, 2.2}, "sphere 2");
  addSolid(world, Sphere{{3, 0.8, -2}, 2}, "sphere 3");
  addSolid(world, InfinitePlane{{0, -1, 0}, {0, 1, 0}}, "plane");
  addSolid(world, Triangle{{-2, 3.7, 0}, {1, 2, 1}, {3, 2.8, -2}}, "triangle 5");
  addSolid(world, Triangle{{3, 2, 3}, {3, 2, -3}, {-3, 2, -3}}, "triangle 6");
  addSolid(world, Quad{{1, -0.9, 4.5}, {-2, 0, 0}, {0, 0.1, -2}}, "quad");
  addSolid(world, Disc{{-3, -0.75, 1.5}, {0, 0.5, 0.5}, 1.5}, "disc");
  addSolid(world, AABox{{2, 1.5, -0.5}, {3, 2.5, 2.5}}, "box");
  return scene;
}

}  // namespace solidcast
