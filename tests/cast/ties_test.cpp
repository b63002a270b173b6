// Ties of `fast`: solids of different kinds in one plane show the one with the lower index, whichever kind it is, and only
// such scenes pay for the comparison of indices.
#include "host/cast/ties.h"

#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

class Ties : public OnDevice {
 protected:
  Scene scene() {
    Scene s = loaded("a_solids.json");
    s.world.solids = {};
    return s;
  }
  static void fill(Scene& s, const std::vector<Shape>& shapes) {
    s.world.solids = {};
    for (const Shape& shape : shapes) s.world.solids.push_back({"", shape});
  }
  static bool mayTieFrom(const Scene& s) { return eyeRecords(s.world, eyeFrame(s, RealType::f32), RealType::f32).ties; }
  // Solid that the middle of the picture shows, in both plans.
  int shown(const Scene& s) {
    RenderJob job;
    job.width = job.height = 32;
    job.channels.solid = true;
    int index = -2;
    for (const Plan plan : {Plan::uniform, Plan::baked}) {
      ImageCaster caster(device(), s, job, {.method = Method::fast, .plan = plan});
      caster.render([&](Band& band) {
        const int now = band.solid[16 * 32 + 16];
        EXPECT_TRUE(index == -2 || index == now);
        index = now;
      });
    }
    return index;
  }
};

TEST_F(Ties, TheLowerIndexWins) {
  const Shape quad = Quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}, plane = InfinitePlane{{0, 0, 0}, {0, 0, 1}};
  const Shape disc = Disc{{0, 0, 0}, {0, 0, 1}, 1}, box = AABox{{-1, -1, -1}, {1, 1, 0}};
  const std::vector<Shape> all = {quad, plane, disc, box};
  for (const Shape& first : all)
    for (const Shape& second : all) {
      if (first.index() == second.index()) continue;
      Scene s = scene();
      fill(s, {first, second});
      EXPECT_TRUE(mayTieFrom(s)) << first.index() << ' ' << second.index();
      EXPECT_EQ(shown(s), 0) << first.index() << ' ' << second.index();
    }
}

TEST_F(Ties, AreLookedForOnlyWhereTheyCanBe) {
  EXPECT_FALSE(mayTieFrom(loaded("a_solids.json")));
  Scene s = scene();
  fill(s, {InfinitePlane{{0, 0, 0}, {0, 0, 1}}, Disc{{0, 0, 1e-3}, {0, 0, 1}, 1}});
  EXPECT_FALSE(mayTieFrom(s));
  // The eye cannot see the face that stands on the plane.
  fill(s, {InfinitePlane{{0, 0, 0}, {0, 0, 1}}, AABox{{-1, -1, 0}, {1, 1, 1}}});
  EXPECT_FALSE(mayTieFrom(s));
  fill(s, {Sphere{{0, 0, 0}, 1}, std::get<Quadric>(loaded("quadrics.json").world.solids[0].shape)});
  EXPECT_TRUE(mayTieFrom(s));
}

}  // namespace
}  // namespace solidcast
