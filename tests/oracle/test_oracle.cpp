// The oracle against closed forms, against itself in exact arithmetic, against properties that need no oracle, and
// (as a cross-check only) against reference_cpu in binary128.
#include <gtest/gtest.h>
#include <quadmath.h>

#include <cmath>
#include <variant>

#include "host/oracle/families.h"
#include "host/oracle/forms.h"
#include "host/oracle/oracle.h"
#include "host/oracle/random.h"
#include "reference_cpu/reference.h"
#include "tests/oracle/helpers.h"

namespace solidcast::oracle {
namespace {

Truth shoot(const Shape& shape, const QueryRay& ray, Effort effort = Effort::enough) {
  return intersect(shape, exactRay(ray), effort);
}

void expectNormal(const Truth& truth, double x, double y, double z) {
  EXPECT_NEAR(static_cast<double>(truth.normal[0]), x, 1e-12);
  EXPECT_NEAR(static_cast<double>(truth.normal[1]), y, 1e-12);
  EXPECT_NEAR(static_cast<double>(truth.normal[2]), z, 1e-12);
}

const Sphere kUnit{{0, 0, 0}, 1};
const AABox kCube{{-1, -1, -1}, {1, 1, 1}};

// --- exact arithmetic -------------------------------------------------------------------------------------------

TEST(Dyadic, HoldsNumbersExactlyAndRoundsThemBack) {
  for (const double x : {0.0, 1.0, -1.0 / 3, 0x1p-1074, -0x1.fffffffffffffp1023, 3e-310}) {
    EXPECT_TRUE(Dyadic(x).rounded() == x) << x;
    EXPECT_TRUE(Dyadic(static_cast<Real>(x)).rounded() == x) << x;
  }
  const Real third = Real(1) / 3, tiny = 0x1p-1074Q * 0x1p-1000Q;
  EXPECT_TRUE(Dyadic(-third).rounded() == -third);
  EXPECT_TRUE((Dyadic(third) + Dyadic(tiny) - Dyadic(third)).rounded() == tiny);
  EXPECT_TRUE((Dyadic(1e300) * Dyadic(1e-300) - Dyadic(1e300) * Dyadic(1e-300)).sign() == 0);
}

TEST(Dyadic, QuotientAndRootAreCutOffBelow) {
  const Dyadic third = quotient(Dyadic(1.0), Dyadic(3.0), 448);
  EXPECT_LT(relative(third.rounded(), Real(1) / 3), 1e-33);
  EXPECT_GT((Dyadic(1.0) - third * Dyadic(3.0)).sign(), 0);
  EXPECT_LT((Dyadic(1.0) - third * Dyadic(3.0)).rounded(), 0x1p-440Q);
  EXPECT_EQ((quotient(Dyadic(-21.0), Dyadic(1.75), 448) + Dyadic(12.0)).sign(), 0) << "exact where it can be";
  EXPECT_EQ((squareRoot(Dyadic(0x1.2p5), 448) - Dyadic(6.0)).sign(), 0);
  const Dyadic root = squareRoot(Dyadic(2.0), 448);
  EXPECT_LT(relative(root.rounded(), sqrtq(2)), 1e-33);
  EXPECT_GT((Dyadic(2.0) - root * root).sign(), 0);
}

Root<Exact> rootOf(Root<Exact>::Kind kind, double a, double b, double d) {
  return {kind, Exact::of(a), Exact::of(b), Exact::of(d)};
}

TEST(Root, ComparesSquareRootsExactly) {
  using R = Root<Exact>;
  const R two = rootOf(R::rational, 4, 2, 0);
  EXPECT_EQ(compare(two, rootOf(R::above, 1, 2, 9)), 0);   // (1 + 3)/2
  EXPECT_EQ(compare(two, rootOf(R::below, 10, 2, 9)), 0);  // 10/(2 + 3)
  EXPECT_EQ(compare(two, rootOf(R::below, 12, 3, 9)), 0);  // b^2 == d
  EXPECT_EQ(compare(two, rootOf(R::rational, -5, -2, 0)), -1);
  // (sqrt 8)/2 == 2/(0 + sqrt 2) == sqrt 2, and sqrt 2 against its neighbours.
  EXPECT_EQ(compare(rootOf(R::above, 0, 2, 8), rootOf(R::below, 2, 0, 2)), 0);
  EXPECT_EQ(compare(rootOf(R::above, 0, 1, 2), rootOf(R::rational, 0x1.6a09e667f3bcdp0, 1, 0)), -1);
  EXPECT_EQ(compare(rootOf(R::above, 0, 1, 2), rootOf(R::rational, 0x1.6a09e667f3bccp0, 1, 0)), 1);
  // 1 + sqrt(2) = 1/(sqrt(2) - 1): the same number through different forms; 1 + sqrt(2 + 2^-50) is larger.
  EXPECT_EQ(compare(rootOf(R::above, 1, 1, 2), rootOf(R::below, 1, -1, 2)), 0);
  EXPECT_EQ(compare(rootOf(R::above, 1, 1, 2 + 0x1p-50), rootOf(R::below, 1, -1, 2)), 1);
  // 3 + sqrt 5 against 2 + sqrt 10 (5.2360 and 5.1622): needs the second squaring.
  EXPECT_EQ(compare(rootOf(R::above, 3, 1, 5), rootOf(R::above, 2, 1, 10)), 1);
  EXPECT_EQ(compare(rootOf(R::above, 2, 1, 10), rootOf(R::above, 3, 1, 5)), -1);
}

TEST(Root, OrderAgreesWithValuesOnRandomRoots) {
  Random random(7);
  for (int i = 0; i < 3000; ++i) {
    Root<Exact> pair[2];
    for (auto& root : pair) {
      // Small integers, so that equal values occur.
      const auto kind = static_cast<Root<Exact>::Kind>(random.integer(0, 2));
      root = rootOf(kind, random.integer(1, 6), random.integer(1, 4), random.integer(0, 9));
    }
    const Real difference = evaluate(pair[0]).value.rounded() - evaluate(pair[1]).value.rounded();
    const int expected = fabsq(difference) < 1e-30Q ? 0 : difference < 0 ? -1 : 1;
    ASSERT_EQ(compare(pair[0], pair[1]), expected) << i;
  }
}

// --- closed forms -----------------------------------------------------------------------------------------------

TEST(Oracle, SphereFromOutsideInsideAndOn) {
  const Truth outside = shoot(kUnit, {{0, 0, 5}, {0, 0, -2}});
  ASSERT_TRUE(outside.hit);
  EXPECT_TRUE(outside.t == 2) << "half, the direction is twice as long";
  expectNormal(outside, 0, 0, 1);
  const Truth inside = shoot(kUnit, {{0, 0, 0.5f}, {0, 0, 1}});
  ASSERT_TRUE(inside.hit);
  EXPECT_TRUE(inside.t == 0.5);
  expectNormal(inside, 0, 0, 1);
  EXPECT_FALSE(shoot(kUnit, {{0, 0, 1}, {0, 0, 1}}).hit) << "leaving the surface";
  EXPECT_TRUE(shoot(kUnit, {{0, 0, 1}, {0, 0, -1}}).t == 2) << "entering from the surface: the far side";
  EXPECT_FALSE(shoot(kUnit, {{0, 0, 1}, {1, 0, 0}}).hit) << "tangent at the origin";
  EXPECT_FALSE(shoot(kUnit, {{0, 0, 5}, {0, 0, 1}}).hit) << "behind";
}

TEST(Oracle, TangentsAreClosed) {
  const Truth touching = shoot(kUnit, {{1, 0, -5}, {0, 0, 1}});
  ASSERT_TRUE(touching.hit);
  EXPECT_TRUE(touching.t == 5);
  EXPECT_TRUE(touching.exactlyOnEdge);
  EXPECT_EQ(touching.marginUlps, 0);
  EXPECT_EQ(touching.level, Level::exact);
  const Truth within = shoot(kUnit, {{std::nextafter(1.f, 0.f), 0, -5}, {0, 0, 1}});
  ASSERT_TRUE(within.hit);
  EXPECT_FALSE(within.exactlyOnEdge);
  EXPECT_LT(relative(within.t, 5 - sqrtq(1 - powq(1 - 0x1p-24Q, 2))), 1e-14);
  EXPECT_FALSE(shoot(kUnit, {{std::nextafter(1.f, 2.f), 0, -5}, {0, 0, 1}}).hit);
}

TEST(Oracle, PlaneParallelAndInsideMiss) {
  const InfinitePlane ground{{0, 0, 0}, {0, 3, 0}};
  EXPECT_FALSE(shoot(ground, {{0, 1, 0}, {1, 0, 0}}).hit);
  EXPECT_FALSE(shoot(ground, {{0, 0, 0}, {1, 0, 0}}).hit) << "inside";
  EXPECT_FALSE(shoot(ground, {{0, 0, 0}, {1, 1, 0}}).hit) << "t = 0";
  const Truth below = shoot(ground, {{0, -1, 0}, {0, 2, 0}});
  ASSERT_TRUE(below.hit);
  EXPECT_TRUE(below.t == 0.5);
  expectNormal(below, 0, 1, 0);
}

TEST(Oracle, BoxEdgesFacesAndInside) {
  EXPECT_TRUE(shoot(kCube, {{1, 0, -5}, {0, 0, 1}}).t == 4) << "along a face";
  EXPECT_TRUE(shoot(kCube, {{1, 1, -5}, {-0.f, 0, 1}}).t == 4) << "along an edge";
  EXPECT_FALSE(shoot(kCube, {{std::nextafter(1.f, 2.f), 0, -5}, {0, 0, 1}}).hit);
  const Truth corner = shoot(kCube, {{-3, -3, -3}, {1, 1, 1}});
  ASSERT_TRUE(corner.hit);
  EXPECT_EQ(corner.faceMarginUlps, 0);
  expectNormal(corner, -1, 0, 0);
  const Truth leaving = shoot(kCube, {{0, 0.5f, 0}, {0, 1, 0.25f}});
  EXPECT_TRUE(leaving.t == 0.5);
  expectNormal(leaving, 0, 1, 0);
  EXPECT_FALSE(shoot(kCube, {{1, 0, 0}, {1, 0.5f, 0}}).hit) << "on a face, leaving";
  EXPECT_TRUE(shoot(kCube, {{1, 0, 0}, {-1, 0, 0}}).t == 2) << "on a face, entering";
  EXPECT_TRUE(shoot(AABox{{1, 1, 1}, {-1, -1, -1}}, {{0, 0, 5}, {0, 0, -1}}).t == 4) << "corners in any order";
  // Past an edge x = z = 1 by the touch, then by less than nothing.
  EXPECT_TRUE(shoot(kCube, {{3, 0, -1}, {-1, 0, 1}}).exactlyOnEdge);
  EXPECT_FALSE(shoot(kCube, {{3, 0, std::nextafter(-1.f, 0.f)}, {-1, 0, 1}}).hit);
}

TEST(Oracle, DiscTriangleAndQuadEdgesAreClosed) {
  const Disc disc{{0, 0, 0}, {0, 0, 7}, 5};
  EXPECT_TRUE(shoot(disc, {{3, 4, 2}, {0, 0, -1}}).exactlyOnEdge);
  EXPECT_FALSE(shoot(disc, {{3, std::nextafter(4.f, 5.f), 2}, {0, 0, -1}}).hit);
  EXPECT_FALSE(shoot(disc, {{9, 0, 0}, {-1, 0, 0}}).hit) << "in its plane";
  const Triangle triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  for (const auto& [x, y] : {std::pair{0.f, 0.f}, {4.f, 0.f}, {0.f, 4.f}, {2.f, 2.f}, {1.f, 0.f}, {0.f, 3.f}}) {
    const Truth truth = shoot(triangle, {{x, y, -1}, {0, 0, 1}});
    EXPECT_TRUE(truth.hit && truth.exactlyOnEdge) << x << ' ' << y;
    EXPECT_TRUE(truth.local[1] == x / 4 && truth.local[2] == y / 4);
    expectNormal(truth, 0, 0, 1);
  }
  EXPECT_FALSE(shoot(triangle, {{2, std::nextafter(2.f, 3.f), -1}, {0, 0, 1}}).hit);
  EXPECT_FALSE(shoot(triangle, {{-0x1p-149f, 1, -1}, {0, 0, 1}}).hit) << "by the smallest denormal";
  const Quad quad{{0, 0, 0}, {4, 0, 0}, {1, 4, 0}};
  const Truth corner = shoot(quad, {{5, 4, 1}, {0, 0, -1}});
  EXPECT_TRUE(corner.exactlyOnEdge && corner.local[0] == 1 && corner.local[1] == 1 && corner.local[2] == 0);
  EXPECT_FALSE(shoot(quad, {{std::nextafter(5.f, 6.f), 4, 1}, {0, 0, -1}}).hit);
  EXPECT_TRUE(shoot(quad, {{2, 1, 1}, {0, 0, -1}}).local[1] == 0.25);
}

TEST(Oracle, QuadricSpecialPlaces) {
  const Quadric cone{{1, 1, -1, 0, 0, 0, 0, 0, 0, 0}};
  const Truth apex = shoot(cone, {{5, 0, 0}, {-2, 0, 0}});
  ASSERT_TRUE(apex.hit);
  EXPECT_TRUE(apex.t == 2.5);
  expectNormal(apex, 1, 0, 0);  // no gradient there: against the direction
  EXPECT_FALSE(shoot(cone, {{5, 0, 5}, {-1, 0, -1}}).hit) << "inside the surface";
  const Truth parallel = shoot(cone, {{0, 1, 0}, {1, 0, 1}});  // 1 = 0: A = B = 0
  EXPECT_FALSE(parallel.hit);
  EXPECT_TRUE(shoot(cone, {{0, 0, -2}, {1, 0, 1}}).t == 1) << "parallel to a generator: linear";
  const Quadric paraboloid{{1, 1, 0, 0, 0, 0, 0, 0, -1, 0}};
  EXPECT_TRUE(shoot(paraboloid, {{0.5f, 0, 9}, {0, 0, -1}}).t == 8.75) << "A = 0";
  const Quadric doublePlane{{1, 0, 0, 0, 0, 0, -10, 0, 0, 25}};
  EXPECT_TRUE(shoot(doublePlane, {{0, 3, 4}, {1, 0, 0}}).t == 5);
  EXPECT_FALSE(shoot(Quadric{{1, 1, 1, 0, 0, 0, 0, 0, 0, 1}}, {{0, 0, 5}, {0, 0, -1}}).hit) << "imaginary";
  const Quadric saddle{{0, 0, 0, 1, 0, 0, 0, 0, -1, 0}};  // z = xy
  EXPECT_TRUE(shoot(saddle, {{3, 2, 0}, {0, 0, 1}}).t == 6);
}

TEST(Oracle, LimitIsStrictAndExact) {
  const InfinitePlane plane{{0, 0, 0}, {0, 0, 1}};
  EXPECT_FALSE(shoot(plane, {{0, 0, 5}, {0, 0, -1}, 5}).hit);
  EXPECT_TRUE(shoot(plane, {{0, 0, 5}, {0, 0, -1}, std::nextafter(5.f, 6.f)}).hit);
  // t = sqrt(2) against its two neighbours in fp32.
  const Sphere sphere{{0, 0, 0}, 1.5};
  const QueryRay ray{{0.5f, 0, 0}, {0, 0, 1}, 0x1.6a09e6p0f};
  EXPECT_FALSE(shoot(sphere, ray).hit);
  QueryRay longer = ray;
  longer.tMax = std::nextafter(ray.tMax, 2.f);
  EXPECT_TRUE(shoot(sphere, longer).hit);
  EXPECT_LT(relative(shoot(sphere, longer, Effort::full).t, sqrtq(2)), 1e-33);
}

TEST(Oracle, TiesGoToTheEarlierSolidExactly) {
  // Through (3,4,0): sphere of radius 5, plane, disc rim; and a sphere larger by one unit of fp64.
  const QueryRay ray{{9, 4, 0}, {-1, 0, 0}};
  const Sphere sphere{{0, 0, 0}, 5};
  const InfinitePlane plane{{3, 0, 0}, {1, 0, 0}};
  const WorldTruth first = cast(worldOf({sphere, plane}), exactRay(ray));
  EXPECT_EQ(first.index, 0);
  EXPECT_TRUE(first.tie);
  EXPECT_EQ(cast(worldOf({plane, sphere}), exactRay(ray)).index, 0);
  const Sphere larger{{0, 0, 0}, std::nextafter(5.0, 6.0)}, smaller{{0, 0, 0}, std::nextafter(5.0, 4.0)};
  EXPECT_EQ(cast(worldOf({plane, larger}), exactRay(ray)).index, 1) << "nearer by 1e-15";
  EXPECT_EQ(cast(worldOf({smaller, plane}), exactRay(ray)).index, 1);
  EXPECT_FALSE(cast(worldOf({smaller, plane}), exactRay(ray)).tie);
  // The same irrational t: two spheres of radius sqrt(7)-ish offset along the ray's normal plane.
  const QueryRay through{{0, 0, -5}, {0, 0, 1}};
  EXPECT_TRUE(cast(worldOf({Sphere{{1, 0, 0}, 2}, Sphere{{0, -1, 0}, 2}}), exactRay(through)).tie);
}

TEST(Oracle, SecondHitAndTilt) {
  const World world = worldOf({InfinitePlane{{0, 0, 0}, {0, 0, 1}}, kUnit});
  const WorldTruth truth = cast(world, exactRay({{0, 0, 5}, {0, 0, -1}}));
  EXPECT_EQ(truth.index, 1);
  EXPECT_TRUE(truth.truth.t == 4 && truth.secondT == 5);
  const Ray128 edge = exactRay({{0.9999999f, 0, 5}, {0, 0, -1}});
  EXPECT_TRUE(flipsWhenTilted(world, edge, 2e-6));
  EXPECT_FALSE(flipsWhenTilted(world, edge, 1e-9));
  EXPECT_FALSE(flipsWhenTilted(world, exactRay({{0.5f, 0, 5}, {0, 0, -1}}), 2e-6));
}

TEST(Oracle, PixelRaysOfTheSheetsScene) {
  const PerspectiveCamera camera{{0, 0, 10}, {0, 0, -1}, {0, 1, 0}, 45, 60};
  const InfinitePlane plane{{0, -1, 0}, {0, 1, 0}};
  const Truth truth = intersect(plane, pixelRay(camera, 640, 480, 320.5, 479.5));
  ASSERT_TRUE(truth.hit);
  EXPECT_NEAR(static_cast<double>(truth.t), 2.617784, 1e-6);
  const Truth sphere = intersect(Sphere{{1, -1, 1}, 2.2}, pixelRay(camera, 640, 480, 320.5, 240.5));
  EXPECT_NEAR(static_cast<double>(sphere.t), 7.307164, 1e-6);
  // Orthographic: straight down a grid; environment: the middle looks forward, a quarter turn to the right.
  const OrthographicCamera flat{{0, 0, 10}, {0, 0, -4}, {0, 1, 0}, 8, 6};
  const Ray128 ray = pixelRay(flat, 8, 6, 7.5, 0.5);
  EXPECT_TRUE(ray.origin[0] == 3.5 && ray.origin[1] == 2.5 && ray.origin[2] == 10);
  EXPECT_TRUE(intersect(InfinitePlane{{0, 0, 0}, {0, 0, 1}}, ray).t == 10) << "distance, though |direction| is 4";
  const EnvironmentCamera round{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 180, 360};
  const Ray128 right = pixelRay(round, 4, 2, 3, 1);
  EXPECT_NEAR(static_cast<double>(right.direction[0]), 1, 1e-30);
  const Ray128 up = pixelRay(round, 4, 2, 2, 0);
  EXPECT_NEAR(static_cast<double>(up.direction[1]), 1, 1e-30);
}

TEST(Ulps, AreThoseOfFp32) {
  EXPECT_EQ(ulpError(1.f, 1), 0);
  EXPECT_EQ(ulpError(std::nextafter(1.f, 2.f), 1), 1);
  EXPECT_EQ(ulpError(std::nextafter(1.f, 0.f), 1), 0.5);
  EXPECT_EQ(ulpError(1.f, 1 + Real(0x1p-24)), 0.5);
  EXPECT_EQ(ulpError(0x1p-149f, Real(0x1p-148)), 1);
  EXPECT_TRUE(std::isinf(ulpError(NAN, 1)));
  EXPECT_TRUE(std::isinf(ulpError(INFINITY, 1)));
  EXPECT_EQ(ulpError(INFINITY, Real(1e39)), 0);
  EXPECT_FALSE(beyondFloat(0x1.fffffep127));
  EXPECT_TRUE(beyondFloat(Real(0x1p128)));
  EXPECT_EQ(normalError({1, 0, 0x1p-23f}, {1, 0, 0}), 1);
  EXPECT_TRUE(std::isinf(normalError({1, NAN, 0}, {1, 0, 0})));
  EXPECT_EQ(localError({4, 0x1p-21f, 0}, {4, 0, 0}), 1) << "in units of the largest component";
}

}  // namespace
}  // namespace solidcast::oracle
