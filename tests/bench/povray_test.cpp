// The scene that POV-Ray gets: every kind of solid and camera, by POV-Ray's words.
#include <gtest/gtest.h>

#include "host/bench/processes.h"
#include "host/scene/load.h"

namespace solidcast::bench {
namespace {

Scene sceneOf(Shape shape) {
  Scene scene;
  scene.world.solids.push_back({"", std::move(shape), 0});
  scene.world.groups[0].members.push_back({false, 0});
  return scene;
}

TEST(PovrayScene, SaysEverySolid) {
  const std::pair<Shape, const char*> all[] = {
      {InfinitePlane{{0, 3, 0}, {0, 2, 0}}, "plane{<0,1,0>,3}"},
      {AABox{{1, -1, 1}, {-1, 1, -1}}, "box{<-1,-1,-1>,<1,1,1>}"},
      {Sphere{{1, 2, 3}, 4}, "sphere{<1,2,3>,4}"},
      {Disc{{1, 2, 3}, {0, 0, 1}, 4}, "disc{<1,2,3>,<0,0,1>,4}"},
      {Triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, "triangle{<0,0,0>,<1,0,0>,<0,1,0>}"},
      {Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, "polygon{5,<0,0,0>,<1,0,0>,<1,1,0>,<0,1,0>,<0,0,0>}"},
      {Quadric{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}}, "quadric{<1,2,3>,<4,5,6>,<7,8,9>,10}"}};
  for (const auto& [shape, text] : all)
    EXPECT_NE(povrayScene(sceneOf(shape)).find(text), std::string::npos) << povrayScene(sceneOf(shape));
}

TEST(PovrayScene, SaysEveryCameraByItsOwnAxes) {
  Scene scene;
  scene.camera = PerspectiveCamera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90, 90};
  EXPECT_NE(povrayScene(scene).find("direction <0,0,-1> right <1.99"), std::string::npos) << povrayScene(scene);
  scene.camera = OrthographicCamera{{0, 0, 0}, {0, 0, -2}, {0, 1, 0}, 3, 2};
  EXPECT_NE(povrayScene(scene).find("orthographic location <0,0,0> direction <0,0,-1> right <3,0,0> up <0,2,0>"),
            std::string::npos)
      << povrayScene(scene);
  scene.camera = EnvironmentCamera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 180, 360};
  EXPECT_NE(povrayScene(scene).find(" angle 360 180}"), std::string::npos) << povrayScene(scene);
}

}  // namespace
}  // namespace solidcast::bench
