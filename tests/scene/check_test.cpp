// The same rules for scenes made through the API, and that the flat tree is a tree.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/scene/build.h"
#include "host/scene/rules.h"
#include "tests/scene/scene_text.h"

namespace solidcast {
namespace {

std::string checked(const Scene& scene) {
  std::vector<std::string> warnings;
  try {
    checkScene(scene, warnings);
  } catch (const Error& error) { return error.what(); }
  return warnings.empty() ? "fine" : "warning: " + warnings[0];
}

std::string checked(const Shape& shape) {
  Scene scene;
  addSolid(scene.world, shape);
  return checked(scene);
}

TEST(CheckScene, Shapes) {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(checked(Sphere{{0, 0, 0}, 1}), "fine");
  EXPECT_EQ(checked(Sphere{{0, nan, 0}, 1}), "scene: sphere 0/center/1: nan is not finite, expected a finite number");
  EXPECT_EQ(checked(Sphere{{0, 0, 0}, inf}), "scene: sphere 0/radius: inf is not finite, expected a finite number");
  EXPECT_EQ(checked(Disc{{0, 0, 0}, {0, 0, -inf}, 1}),
            "scene: disc 0/normal/2: -inf is not finite, expected a finite number");
  EXPECT_EQ(checked(AABox{{0, 0, 0}, {1, 1, nan}}),
            "scene: box 0/corner2/2: nan is not finite, expected a finite number");
  EXPECT_EQ(checked(Triangle{{0, 0, 0}, {nan, 0, 0}, {0, 1, 0}}),
            "scene: triangle 0/vertices/1/0: nan is not finite, expected a finite number");
  EXPECT_EQ(checked(Quad{{0, 0, nan}, {1, 0, 0}, {0, 1, 0}}),
            "scene: quad 0/vertex/2: nan is not finite, expected a finite number");
  EXPECT_EQ(checked(InfinitePlane{{0, 0, 0}, {0, 0, 0}}),
            "scene: infinite_plane 0/normal: the vector is zero, expected a direction");
  EXPECT_EQ(checked(Quadric{{1, 1, 1, 0, 0, 0, 0, 0, 0, nan}}),
            "scene: quadric 0/coefficients/9: nan is not finite, expected a finite number");
  EXPECT_EQ(checked(AABox{{0, 0, 0}, {1, 1, 0}}),
            "warning: scene: box 0: the box has no extent along z: it is a rectangle");
}

TEST(CheckScene, View) {
  Scene scene = aSolids();
  EXPECT_EQ(checked(scene), "fine");
  scene.height = 0;
  EXPECT_EQ(checked(scene),
            "a_solids: /image/height: size 0 is out of range, expected a whole number of pixels from 1 to 100000");
  scene = aSolids();
  std::get<PerspectiveCamera>(scene.camera).up = {0, 0, 3};
  EXPECT_EQ(checked(scene), "a_solids: /camera/up: up is parallel to forward, expected another direction");
  std::get<PerspectiveCamera>(scene.camera).up = {0, 1e-9, 3};
  EXPECT_EQ(checked(scene),
            "warning: a_solids: /camera/up: up is nearly parallel to forward: the picture's turn about forward is "
            "uncertain");
  scene = aSolids();
  scene.distParameters->farDist = scene.distParameters->nearDist;
  EXPECT_EQ(checked(scene), "a_solids: /integrator/far_dist: far_dist equals near_dist (4), expected two distances");
}

TEST(CheckScene, Names) {
  Scene scene = aSolids();
  std::vector<SolidEntry> solids(scene.world.solids.begin(), scene.world.solids.end());
  solids[8].name = "sphere 1";
  scene.world.solids = Solids(solids);
  EXPECT_EQ(checked(scene),
            "a_solids: sphere 1: duplicate name \"sphere 1\", expected a name of its own (it is that of sphere 0)");
}

TEST(CheckScene, Tree) {
  Scene scene;
  const Shape ball = Sphere{{0, 0, 0}, 1};
  const auto group = addGroup(scene.world, "inner");
  addSolid(scene.world, ball, "", group);
  addSolid(scene.world, ball);
  EXPECT_EQ(checked(scene), "fine");

  Scene wrong = scene;
  wrong.world.solids.push_back({"lost", ball, 0});
  EXPECT_EQ(checked(wrong), "scene: /solids: the groups hold 2 solids and 1 groups, expected all 3 and 1");
  wrong = scene;
  wrong.world.groups[0].members[1].index = 7;
  EXPECT_EQ(checked(wrong), "scene: /solids: solid 7 does not exist, expected an index into the world's lists");
  wrong = scene;
  std::swap(wrong.world.groups[0].members[0], wrong.world.groups[0].members[1]);
  EXPECT_EQ(checked(wrong),
            "scene: /solids: solid 1 is out of order or in the wrong group, expected solids depth first");
  wrong = scene;
  wrong.world.groups[1].members.push_back({true, 1});  // a group inside itself
  EXPECT_EQ(checked(wrong), "scene: /solids: group 1 is a member of group 1, expected only its parent's");
  wrong = scene;
  wrong.world.groups[0].members.push_back({true, 1});  // twice
  EXPECT_EQ(checked(wrong), "scene: /solids: group 1 is a member of group 0, expected only its parent's");
  wrong = scene;
  wrong.world.groups.clear();
  EXPECT_EQ(checked(wrong), "scene: /solids: the world has no root, expected groups[0] to be its own parent");

  Scene deep;
  std::uint32_t bottom = 0;
  for (int i = 0; i < kMaxGroupDepth; ++i) bottom = addGroup(deep.world, "", bottom);
  EXPECT_EQ(checked(deep), "fine");
  addGroup(deep.world, "", bottom);
  EXPECT_EQ(checked(deep), "scene: /solids: groups are nested too deep, expected at most 1000");
}

}  // namespace
}  // namespace solidcast
