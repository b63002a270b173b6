// The numbers of an explanation against ones calculated here on their own, on cases whose trouble is known.
#include <cmath>

#include "tests/explain/fixture.h"

namespace solidcast::explain {
namespace {

double bitsOf(double error) { return -std::log2(error); }
double relative(f128 got, f128 truth) { return static_cast<double>(fabsq((got - truth) / truth)); }

/// The textbook's b^2 - a C of a sphere of radius 1 at 10,000, seen from the origin: catalogue S2 and S3.
TEST_F(Explain, FarSmallSphereLosesItsDiscriminant) {
  for (const double slope : {0x1.797cc4p-14, 0x1.a79fecp-14}) {
    const Scene scene = onePixel({Sphere{{0, 0, 10000}, 1}}, {0, 0, 0}, {slope, 0, 1});
    const Explanation e = at(scene, 0, 0, Method::naive);
    const Candidate* c = candidate(e, 0);
    ASSERT_NE(c, nullptr);
    const Stage* q = stage(*c, "q = b^2 - a C");
    ASSERT_NE(q, nullptr);
    // In fp32 as the textbook has it; f.f - r^2 and b^2 are near 1e8, where fp32 numbers are 8 apart.
    const V3 unit = normalized(V3{slope, 0, 1});
    const auto dx = static_cast<float>(e.seen.direction.x), dz = static_cast<float>(e.seen.direction.z);
    const float a = dx * dx + dz * dz, b = -10000.f * dz, C = 1e8f - 1.f;
    const float discriminant = b * b - a * C;
    EXPECT_EQ(q->shader[0], discriminant);
    // Truly r^2 - |f x d|^2, by another formula than q's.
    const f128 across = 10000 * unit.x, truth = 1 - across * across;
    EXPECT_LT(relative(q->truth[0], truth), 1e-24);
    EXPECT_LT(q->digits, 1);
    EXPECT_GT(q->lost, 22);
    EXPECT_EQ(c->trial.worst(), q);
    // One operand apart: C is right to all digits.
    EXPECT_LT(stage(*c, "C = |f|^2 - r^2")->lost, 1);
    // q is in doubt by its bound, which must hold.
    const Decision* d = c->trial.decisive();
    ASSERT_NE(d, nullptr);
    EXPECT_LT(d->margin, 1);
    EXPECT_GE(d->bound, static_cast<double>(fabsq(d->shader - d->truth)));
  }
}

/// n.o - n.p0 of a plane two million away from the origin cancels; n.(p0 - o) would not.
TEST_F(Explain, PlaneFarFromTheOriginLosesItsDistance) {
  const Triple n{0.3, 0.8, -0.5}, p{1e6, -2e6, 3e6}, eye{1e6 + 3, -2e6 + 4, 3e6 + 5};
  const Scene scene = onePixel({InfinitePlane{p, n}}, eye, {-0.1, -1, 0.2});
  const Explanation naive = at(scene, 0, 0, Method::naive);
  const Candidate* c = candidate(naive, 0);
  ASSERT_NE(c, nullptr);
  const Stage* distance = stage(*c, "n.o + D");
  const f128 truth = dot(normalized(V3(n)), V3(eye) - V3(p));
  EXPECT_LT(relative(distance->truth[0], truth), 1e-24);
  EXPECT_EQ(c->trial.worst(), distance);
  EXPECT_GT(distance->lost, 15);
  EXPECT_NEAR(distance->digits, std::max(0., bitsOf(relative(distance->shader[0], truth))), 1e-6);
  EXPECT_FALSE(naive.gpu.right);
  EXPECT_NE(naive.conclusion.find("the CPU is right; the GPU gives t with an error of"), std::string::npos);
  // fast has the distance from the host, in binary128.
  const Explanation fast = at(scene, 0, 0, Method::fast);
  EXPECT_TRUE(fast.gpu.right) << fast.conclusion;
  EXPECT_EQ(candidate(fast, 0)->trial.worst(), nullptr);
}

/// A flat angle: n.d loses what its terms cancel, by the rounding of the ray and not of the plane.
TEST_F(Explain, GrazingPlaneLosesItsSlopeByTheRay) {
  const double angle = 1e-5;
  const Scene scene = onePixel({InfinitePlane{{0, 0, 0}, {0, 1, 0}}}, {0, 1, 0}, {0.6, -angle, 0.8});
  // Looking along another axis, so that the direction is rounded where it is small against the rest: naive's direction
  // has 24 digits of each component, fast's in camera axes has the slope in the record.
  const Explanation naive = at(scene, 0, 0, Method::naive), fast = at(scene, 0, 0, Method::fast);
  EXPECT_TRUE(naive.followed && fast.followed);
  const f128 truth = -angle / sqrtq(f128(0.6) * 0.6 + f128(0.8) * 0.8 + f128(angle) * angle);
  const Stage* slope = stage(*candidate(naive, 0), "n.d");
  ASSERT_NE(slope, nullptr);
  EXPECT_LT(relative(slope->truth[0], truth), 1e-30);
  const auto off = static_cast<double>(fabsq(slope->shader[0] - truth) / fabsq(truth));
  EXPECT_NEAR(slope->byRay, off, 1e-3 * off + 1e-12);
  EXPECT_EQ(slope->byRecords, 0);
}

/// Spans 1 : 1e7: the two halves of det cancel. Catalogue T13's kind of triangle.
TEST_F(Explain, SliverTriangleLosesItsDeterminant) {
  const Triangle sliver{{0.1, 0.2, -3}, {1.1, 1.2000001, -4.5}, {2.1, 2.2000003, -6.0000005}};
  const Scene scene = onePixel({sliver}, {0, 0, 0}, {0.9, 1.0000001, -4.2});
  const Explanation e = at(scene, 0, 0, Method::naive);
  EXPECT_TRUE(e.followed);
  const Candidate* c = candidate(e, 0);
  ASSERT_NE(c, nullptr);
  const Stage* det = stage(*c, "determinant e1.p");
  ASSERT_NE(det, nullptr);
  const V3 v1(sliver.v1), e1 = V3(sliver.v2) - v1, e2 = V3(sliver.v3) - v1;
  const f128 truth = -dot(normalized(V3{0.9, 1.0000001, -4.2}), cross(e1, e2));  // e1.(d x e2) = -d.(e1 x e2)
  EXPECT_LT(relative(det->truth[0], truth), 1e-24);
  EXPECT_LT(det->digits, 12);
  double least = 24;
  for (const Stage& s : c->trial.stages)
    if (s.name.rfind("p = d x e2", 0) == 0) least = s.digits;
  EXPECT_NEAR(det->lost, std::min(24., least) - det->digits, 12);
  for (const Decision& d : c->trial.decisions)
    EXPECT_TRUE(!std::isfinite(d.bound) || d.bound * 1.001 >= static_cast<double>(fabsq(d.shader - d.truth))) << d.name;
}

/// Two surfaces nearer to each other than the first pass may decide: the order is its doubt, and the truth tells them
/// apart; exactly the same surface twice is a tie of which the earlier wins.
TEST_F(Explain, NearTiesGoToTheSecondPass) {
  const auto quad = [](double z) { return Quad{{-1, -1, z}, {2, 0, 0}, {0, 2, 0}}; };
  const Triple eye{0.1, 0.2, 0}, forward{0.1, 0.05, -1};
  const Explanation near = at(onePixel({quad(-3 * (1 + 0x1p-30)), quad(-3)}, eye, forward), 0, 0, Method::exact);
  EXPECT_TRUE(near.secondPass && near.followed && near.gpu.right);
  EXPECT_EQ(near.gpu.index, 1);
  ASSERT_EQ(near.doubts.size(), 1u);
  EXPECT_EQ(near.doubts[0].rfind("order of quad 1 and quad 0", 0), 0u) << near.doubts[0];
  EXPECT_FALSE(near.tie);

  const Explanation tie = at(onePixel({quad(-3), quad(-3)}, eye, forward), 0, 0, Method::exact);
  EXPECT_TRUE(tie.secondPass && tie.followed && tie.tie);
  EXPECT_EQ(tie.gpu.index, 0);

  const Explanation apart = at(onePixel({quad(-3 * (1 + 0x1p-20)), quad(-3)}, eye, forward), 0, 0, Method::exact);
  EXPECT_TRUE(!apart.secondPass && apart.followed && apart.doubts.empty());
}

/// A bound that is exceeded would be worse than none.
TEST_F(Explain, BoundsHold) {
  std::size_t decisions = 0;
  for (const oracle::Kind kind : oracle::kKinds)
    for (const char* family : {"perspective", "far", "orthographic"}) {
      const Scene scene = oracle::makeImage(kind, family, 32, 24, 7);
      for (const Method method : kMethods)
        for (const auto& [x, y] : {std::pair{3, 4}, {16, 12}, {25, 19}}) {
          const Setting setting = settingOf(scene, method, method == Method::exact ? RealType::f64 : RealType::f32,
                                            scene.width, scene.height, x, y);
          const Trial trial = tryOn(scene.world.solids[0].shape, 0, setting);
          for (const Decision& d : trial.decisions) {
            ++decisions;
            if (!std::isfinite(d.bound) || isnanq(d.shader) || isnanq(d.truth)) continue;
            EXPECT_GE(d.bound * 1.0001, static_cast<double>(fabsq(d.shader - d.truth)))
                << oracle::nameOf(kind) << " " << family << " " << nameOf(method) << " " << d.name;
            EXPECT_FALSE(d.margin > 1 && d.wrong()) << oracle::nameOf(kind) << " " << family << " " << d.name;
          }
        }
    }
  EXPECT_GT(decisions, 300u);
}

}  // namespace
}  // namespace solidcast::explain
