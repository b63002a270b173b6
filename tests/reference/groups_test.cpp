// Groups: the first of equals wins, nesting of any depth, and what is no tree.
#include <gtest/gtest.h>

#include "reference_cpu/build.h"
#include "tests/reference/scenes.h"

namespace solidcast::reference {
namespace {

QueryHit castAt(const solidcast::World& world, const QueryRay& ray, Precision precision = Precision::f64) {
  QueryHit hit;
  cast(world, {&ray, 1}, {&hit, 1}, precision, 1);
  return hit;
}

/// `depth` groups, each inside the one before; the innermost holds `inner`, every other a far sphere before its group
/// when `spheres` is set. Solids are in depth-first order.
solidcast::World nested(int depth, const Shape& inner, bool spheres) {
  solidcast::World world;
  world.groups.resize(depth);
  for (int i = 0; i < depth; ++i) {
    GroupEntry& group = world.groups[i];
    group.parent = i > 0 ? i - 1 : 0;
    const bool innermost = i == depth - 1;
    if (innermost || spheres) {
      group.members.push_back({false, static_cast<std::uint32_t>(world.solids.size())});
      world.solids.push_back(
          {"", innermost ? inner : Shape(solidcast::Sphere{{0, 0, -100.0 - i}, 1}), static_cast<std::uint32_t>(i)});
    }
    if (!innermost) group.members.push_back({true, static_cast<std::uint32_t>(i + 1)});
  }
  return world;
}

TEST(Groups, AtEqualDistanceTheEarlierSolidWins) {
  const solidcast::Sphere sphere{{0, 0, 0}, 1};
  const solidcast::AABox box{{-1, -1, -1}, {1, 1, 1}};
  const solidcast::Quadric quadric{{1, 1, 1, 0, 0, 0, 0, 0, 0, -1}};
  const QueryRay ray{{0, 0, 5}, {0, 0, -1}};
  for (Precision precision : {Precision::f32, Precision::f64, Precision::f128}) {
    EXPECT_EQ(castAt(worldOf({sphere, box, quadric}), ray, precision).index, 0);
    EXPECT_EQ(castAt(worldOf({box, quadric, sphere}), ray, precision).index, 0);
    EXPECT_EQ(castAt(worldOf({solidcast::Sphere{{0, 0, 0}, 0.5}, quadric, box, sphere}), ray, precision).index, 1);
  }
  // Across groups: the earlier one lies in an inner group, then the other way round.
  solidcast::World world = worldOf({sphere, box});
  world.groups.push_back({"", 0, {{false, 0}}});
  world.groups[0].members = {{true, 1}, {false, 1}};
  EXPECT_EQ(castAt(world, ray).index, 0);
  world.groups[0].members = {{false, 0}, {true, 1}};
  world.groups[1].members = {{false, 1}};
  EXPECT_EQ(castAt(world, ray).index, 0);
}

TEST(Groups, MembersAfterAnInnerGroupAreSeen) {
  solidcast::World world = worldOf({solidcast::Sphere{{0, 0, 0}, 1}, solidcast::Sphere{{5, 0, 0}, 1},
                                    solidcast::Sphere{{0, 5, 0}, 1}, solidcast::Sphere{{5, 5, 0}, 1}});
  world.groups.resize(4);
  world.groups[0].members = {{true, 1}, {true, 3}, {false, 3}};
  world.groups[1].members = {{false, 0}, {true, 2}, {false, 2}};
  world.groups[2].members = {{false, 1}};
  for (int i = 0; i < 4; ++i) {
    const QueryHit hit = castAt(world, {{i % 2 ? 5.0f : 0, i / 2 ? 5.0f : 0, 9}, {0, 0, -1}});
    EXPECT_EQ(hit.index, i);
    EXPECT_EQ(hit.t, 8);
  }
}

TEST(Groups, NestTenThousandDeepAndBeyond) {
  for (int depth : {1, 10'000, 300'000})
    for (bool spheres : {false, true}) {
      const solidcast::World world = nested(depth, solidcast::Sphere{{0, 0, 0}, 1}, spheres);
      const int last = static_cast<int>(world.solids.size()) - 1;
      for (Precision precision : {Precision::f32, Precision::f64, Precision::f128}) {
        const QueryHit hit = castAt(world, {{0, 0, 5}, {0, 0, -1}}, precision);
        EXPECT_EQ(hit.index, last) << depth;
        EXPECT_EQ(hit.t, 4);
      }
    }
}

TEST(Groups, DeepOnesRenderOnThreads) {
  Scene scene = sceneOf(nested(10'000, solidcast::Sphere{{0, 0, 0}, 3}, false));
  scene.width = scene.height = 16;
  const Band band = renderWhole(scene, jobOf(scene, {.solid = true}), Precision::f128, 4);
  EXPECT_EQ(band.solid[8 * 16 + 8], 0);
  EXPECT_EQ(band.solid[0], -1);
}

TEST(Groups, AMemberSharedFromOutsideSurvivesTheGroup) {
  auto inner = std::make_shared<SimpleGroup<double>>();
  inner->add(std::make_shared<Sphere<double>>(Vec<double>{0, 0, 0}, 1));
  {
    SimpleGroup<double> outer;
    outer.add(inner);
    EXPECT_TRUE(outer.intersect({{0, 0, 5}, {0, 0, -1}}, 10));
  }
  EXPECT_TRUE(inner->intersect({{0, 0, 5}, {0, 0, -1}}, 10));
}

TEST(Groups, WhatIsNoTreeIsRefused) {
  const QueryRay ray{{0, 0, 5}, {0, 0, -1}};
  solidcast::World ring = worldOf({solidcast::Sphere{{0, 0, 0}, 1}});
  ring.groups[0].members.push_back({true, 0});
  EXPECT_THROW(castAt(ring, ray), Error);
  solidcast::World twice = worldOf({solidcast::Sphere{{0, 0, 0}, 1}});
  twice.groups.resize(2);
  twice.groups[0].members = {{true, 1}, {true, 1}};
  EXPECT_THROW(castAt(twice, ray), Error);
  solidcast::World outOfRange = worldOf({solidcast::Sphere{{0, 0, 0}, 1}});
  outOfRange.groups[0].members.push_back({false, 7});
  EXPECT_THROW(castAt(outOfRange, ray), Error);
}

TEST(Groups, AnEmptyWorldIsAMiss) {
  EXPECT_FALSE(castAt({}, {{0, 0, 5}, {0, 0, -1}}));
  EXPECT_EQ(castAt({}, {{0, 0, 5}, {0, 0, -1}}).index, -1);
}

}  // namespace
}  // namespace solidcast::reference
