// The sheet's theory tasks, on cases whose answers are known without the formulas of theory.cpp.
#include "host/scene/theory.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/error.h"
#include "host/scene/exact.h"

namespace solidcast {
namespace {

TEST(PlaneFromEquation, PointLiesOnItAndIsTheFoot) {
  const InfinitePlane plane = planeFromEquation(0, 3, 4, -50);  // distance 10 from zero along (0, 0.6, 0.8)
  EXPECT_EQ(plane, (InfinitePlane{{0, 6, 8}, {0, 3, 4}}));
  EXPECT_EQ(planeFromEquation(0, -3, -4, 50).origin, plane.origin);  // the same plane, its other normal
  EXPECT_EQ(planeFromEquation(1, 2, 3, 0), (InfinitePlane{{0, 0, 0}, {1, 2, 3}}));
  EXPECT_EQ(planeFromEquation(0, 0, 1e-200, 1e-200), (InfinitePlane{{0, 0, -1}, {0, 0, 1e-200}}));  // squares underflow
  EXPECT_THROW(planeFromEquation(0, 0, 0, 1), Error);
}

TEST(PlaneFromPoints, CounterClockwiseGivesTheNormalTowardsTheViewer) {
  const InfinitePlane plane = planeFromPoints({1, 1, 5}, {3, 1, 5}, {1, 2, 5});  // counter-clockwise seen from +z
  EXPECT_EQ(plane, (InfinitePlane{{1, 1, 5}, {0, 0, 2}}));
  EXPECT_EQ(planeFromPoints({1, 1, 5}, {1, 2, 5}, {3, 1, 5}).normal, (Triple{0, 0, -2}));
  EXPECT_THROW(planeFromPoints({0, 0, 0}, {1, 2, 3}, {-2, -4, -6}), Error);
}

TEST(PlaneFromPoints, TinyPlanesKeepTheirNormal) {
  const Triple normal = planeFromPoints({0, 0, 0}, {1e-300, 0, 0}, {0, 1e-300, 0}).normal;
  EXPECT_EQ(normal[0], 0);
  EXPECT_EQ(normal[1], 0);
  EXPECT_GT(normal[2], 0);
}

TEST(Centroid, IsWhereTheMediansMeet) {
  const Triangle triangle{{0, 0, 0}, {3, 0, 6}, {0, 9, 3}};
  const Triple centroid = pointFromBarycentric(triangle, centroidBarycentric());
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(centroid[i], (Triple{1, 3, 3})[i], 1e-15);
}

double distanceToLine(const Triple& p, const Triple& a, const Triple& b) {
  const WideTriple twice = exactCross(p, a, b);
  return std::hypot(double(twice[0]), double(twice[1]), double(twice[2])) /
         std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

TEST(Incenter, OfTheRightTriangle345) {
  const Triangle triangle{{0, 0, 0}, {4, 0, 0}, {0, 3, 0}};  // inscribed radius 1, at (1, 1, 0)
  const Triple weights = incenterBarycentric(triangle);
  EXPECT_NEAR(weights[0], 5. / 12, 1e-15);
  EXPECT_NEAR(weights[1], 3. / 12, 1e-15);
  EXPECT_NEAR(weights[2], 4. / 12, 1e-15);
  const Triple center = pointFromBarycentric(triangle, weights);
  EXPECT_NEAR(center[0], 1, 1e-15);
  EXPECT_NEAR(center[1], 1, 1e-15);
}

TEST(Incenter, HasOneDistanceToAllEdges) {
  std::mt19937 bits(7);
  std::uniform_real_distribution<double> anywhere(-10, 10);
  for (int i = 0; i < 1000; ++i) {
    Triangle t;
    for (Triple* v : {&t.v1, &t.v2, &t.v3}) *v = {anywhere(bits), anywhere(bits), anywhere(bits)};
    const Triple center = pointFromBarycentric(t, incenterBarycentric(t));
    const double distance = distanceToLine(center, t.v1, t.v2);
    EXPECT_NEAR(distance, distanceToLine(center, t.v2, t.v3), 1e-12);
    EXPECT_NEAR(distance, distanceToLine(center, t.v3, t.v1), 1e-12);
    EXPECT_GT(distance, 0);
  }
}

TEST(ExactCross, SeesOneUlpAndNothingWhereThereIsNothing) {
  std::mt19937 bits(11);
  std::uniform_real_distribution<double> anywhere(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    // Two steps of the same vector, on a grid on which the sums are exact: collinear for certain.
    Triple p, q, r;
    for (int k = 0; k < 3; ++k) {
      const double start = std::ldexp(std::round(std::ldexp(anywhere(bits), 40)), -20);
      const double step = std::ldexp(std::round(std::ldexp(anywhere(bits), 20)), -20);
      p[k] = start;
      q[k] = start + step;
      r[k] = start + 3 * step;
    }
    ASSERT_TRUE(isZero(exactCross(p, q, r)));
    r[i % 3] = std::nextafter(r[i % 3], 1e300);
    ASSERT_FALSE(isZero(exactCross(p, q, r)));
  }
  EXPECT_TRUE(isZero(exactCross(Triple{1e-320, 2e-320, 0}, Triple{-3e38, -6e38, 0})) ==
              (1e-320 * 2 == 2e-320));  // denormals count as the numbers they are
  EXPECT_FALSE(isZero(exactCross(Triple{0x1p-1074, 0, 0}, Triple{0, 0x1p-1074, 0})));
}

TEST(ExactSum, CancelsToTheLastBit) {
  const Wide huge = Wide(0x1p200), tiny = Wide(0x1p-200);
  EXPECT_TRUE(exactSum({huge, tiny, -huge}) == tiny);
  EXPECT_TRUE(exactSum({tiny, huge, 1, -huge, -1, -tiny}) == 0);
}

}  // namespace
}  // namespace solidcast
