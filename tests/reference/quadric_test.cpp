// Quadrics: the degenerate equations, where the textbook's formula loses the hit.
#include "reference_cpu/quadric.h"

#include <gtest/gtest.h>

#include <cmath>

namespace solidcast::reference {
namespace {

template <class T>
double distance(const QuadricCoefficients& q, const Vec<T>& o, const Vec<T>& d) {
  const Intersection<T> hit = Quadric<T>(q).intersect({o, d}, infinity<T>());
  return hit ? double(hit.distance()) : -1;
}

using V = Vec<double>;
const QuadricCoefficients unitSphere{1, 1, 1, 0, 0, 0, 0, 0, 0, -1};
const QuadricCoefficients cone{1, 1, -1, 0, 0, 0, 0, 0, 0, 0};
const QuadricCoefficients paraboloid{1, 1, 0, 0, 0, 0, 0, 0, -1, 0};

TEST(Quadric, SphereAndItsMultiples) {
  for (double scale : {1.0, -1.0, 1e30, 1e-30, -1e-42, 1e300}) {
    QuadricCoefficients q = unitSphere;
    for (double& value : q) value *= scale;
    EXPECT_NEAR(distance<double>(q, {5, 0, 0}, {-1, 0, 0}), 4, 1e-14) << scale;
    EXPECT_NEAR(distance<float>(q, {5, 0, 0}, {-1, 0, 0}), 4, 2e-6) << scale;
    EXPECT_NEAR(distance<__float128>(q, {5, 0, 0}, {-1, 0, 0}), 4, 1e-15) << scale;
    const auto hit = Quadric<double>(q).intersect({{5, 0, 0}, {-1, 0, 0}}, infinity<double>());
    EXPECT_EQ(hit.normal().x, scale > 0 ? 1 : -1);  // along the gradient
  }
  EXPECT_EQ(distance<double>(unitSphere, {0, 0, 0}, {0, 1, 0}), 1);
  EXPECT_EQ(distance<double>(unitSphere, {1, 0, 0}, {-1, 0, 0}), 2);  // on the surface, inwards
  EXPECT_EQ(distance<double>(unitSphere, {1, 0, 0}, {1, 0, 0}), -1);
  EXPECT_EQ(distance<double>(unitSphere, {1, 0, -5}, {0, 0, 1}), 5);                       // tangent
  EXPECT_EQ(distance<double>({1, 1, 1, 0, 0, 0, 0, 0, 0, 1}, {5, 0, 0}, {-1, 0, 0}), -1);  // imaginary
}

TEST(Quadric, LinearAlongTheRay) {
  EXPECT_EQ(distance<double>(paraboloid, {1, 0, 9}, {0, 0, -1}), 8);  // A = 0
  // A = 1e-10 only: the textbook's root is all cancellation. 1e-10 t^2 + t - 8.6875 = 0 from x = 0.
  EXPECT_NEAR(distance<double>(paraboloid, {0, 0, 8.6875}, {1e-5, 0, -1}), 8.6874999924531, 1e-12);
  EXPECT_EQ(distance<double>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0}, {0, 0, 5}, {0, 0, -1}), 5);     // a plane
  EXPECT_EQ(distance<double>({0, 0, 0, 0, 0, 0, 0, 0, 1, 0}, {0, 0, 5}, {1, 0, 0}), -1);     // parallel to it
  EXPECT_EQ(distance<double>({0, 0, 0, 1, 0, 0, 0, 0, -1, 0}, {2, 3, 9}, {0, 0, -1}), 3);    // z = xy along z
  EXPECT_EQ(distance<double>({1, 1, 0, 0, 0, 0, 0, 0, 0, -1}, {0.5, 0, 0}, {0, 0, 1}), -1);  // along a cylinder, inside
  EXPECT_EQ(distance<double>({1, 1, 0, 0, 0, 0, 0, 0, 0, -1}, {1, 0, 0}, {0, 0, 1}), -1);    // and in its surface
}

TEST(Quadric, HeadOnAStiffEllipsoid) {
  EXPECT_NEAR(distance<double>({1e12, 1, 1, 0, 0, 0, 0, 0, 0, -1}, {5, 0, 0}, {-1, 0, 0}), 4.999999, 1e-15);
}

TEST(Quadric, FarAwayTheOutlineStays) {
  // From 1e6 the ray passes the unit sphere's center at 1 - 1e-9 and 1 + 1e-9.
  const double t = distance<double>(unitSphere, {1e6, 1 - 1e-9, 0}, {-1, 0, 0});
  EXPECT_NEAR(t, 1e6 - std::sqrt(2e-9), 1e-9);
  EXPECT_EQ(distance<double>(unitSphere, {1e6, 1 + 1e-9, 0}, {-1, 0, 0}), -1);
}

TEST(Quadric, Cones) {
  EXPECT_EQ(distance<double>(cone, {5, 0, 0}, {-1, 0, 0}), 5);  // the apex
  EXPECT_EQ(distance<double>(cone, {5, 0, 1}, {-1, 0, 0}), 4);
  EXPECT_EQ(distance<double>(cone, {1, 0, 1}, {1, 0, 1}), -1);  // along a generator, in the surface
  EXPECT_EQ(distance<double>(cone, {3, 0, 1}, {-1, 0, 1}), 1);  // the far sheet is parallel: one root
  const auto apex = Quadric<double>(cone).intersect({{5, 0, 0}, {-2, 0, 0}}, infinity<double>());
  EXPECT_EQ(apex.normal(), (V{1, 0, 0}));  // no gradient: back along the ray
}

TEST(Quadric, PairsOfPlanes) {
  EXPECT_EQ(distance<double>({0, 0, 1, 0, 0, 0, 0, 0, 0, -1}, {0, 0, 5}, {0, 0, -1}), 4);  // z = +-1
  EXPECT_EQ(distance<double>({0, 0, 1, 0, 0, 0, 0, 0, 0, -1}, {0, 0, 0}, {0, 0, -1}), 1);  // between them
  EXPECT_EQ(distance<double>({0, 0, 1, 0, 0, 0, 0, 0, 0, -1}, {0, 0, 5}, {1, 0, 0}), -1);
  const QuadricCoefficients doublePlane{0, 0, 1, 0, 0, 0, 0, 0, -2, 1};  // (z - 1)^2 = 0
  EXPECT_EQ(distance<double>(doublePlane, {0, 0, 6}, {0, 0, -1}), 5);
  const auto hit = Quadric<double>(doublePlane).intersect({{0, 0, 6}, {0, 0, -3}}, infinity<double>());
  EXPECT_EQ(hit.normal(), (V{0, 0, 1}));
}

TEST(Quadric, WithoutAGradientTheNormalPointsBackDespiteRounding) {
  // A double plane hit where t and the hit point are rounded: what is left of the gradient there is noise.
  const Quadric<__float128> doublePlane({0, 0, 1, 0, 0, 0, 0, 0, -2, 1});
  for (double z : {6.1, 7.3, 2.9, 11.7}) {
    const Vec<__float128> d{0.1, 0.2, -0.7};
    const auto hit = doublePlane.intersect({{0.3, 0.7, z}, d}, infinity<__float128>());
    ASSERT_TRUE(hit) << z;
    EXPECT_LT(double(length(hit.normal() + normalized(d))), 1e-30) << z;
  }
}

TEST(Quadric, TheNearerSheetOfAHyperboloid) {
  const QuadricCoefficients twoSheets{1, 1, -1, 0, 0, 0, 0, 0, 0, 1};  // z^2 = 1 + x^2 + y^2
  EXPECT_EQ(distance<double>(twoSheets, {0, 0, 5}, {0, 0, -1}), 4);
  EXPECT_EQ(distance<double>(twoSheets, {0, 0, 0}, {0, 0, -1}), 1);
  EXPECT_EQ(distance<double>(twoSheets, {5, 0, 0}, {-1, 0, 0}), -1);  // between the sheets
  const QuadricCoefficients oneSheet{1, 1, -1, 0, 0, 0, 0, 0, 0, -1};
  EXPECT_EQ(distance<double>(oneSheet, {5, 0, 0}, {-1, 0, 0}), 4);
  EXPECT_EQ(distance<double>(oneSheet, {0, 0, 0}, {1, 0, 0}), 1);
}

TEST(Quadric, MixedTermsAndLocalCoordinates) {
  // xy = 1, met at (2, 1/2, 3) by a ray along x, where the gradient is (y, x, 0).
  const auto hit = Quadric<double>({0, 0, 0, 1, 0, 0, 0, 0, 0, -1}).intersect({{7, 0.5, 3}, {-1, 0, 0}}, 100);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.distance(), 5);
  EXPECT_EQ(hit.local(), (V{2, 0.5, 3}));
  EXPECT_NEAR(hit.normal().x, 0.5 / std::sqrt(4.25), 1e-15);
  EXPECT_NEAR(hit.normal().y, 2 / std::sqrt(4.25), 1e-15);
  // Every coefficient counts: values of the equation at the hits of one ray, term by term.
  for (int term = 0; term < 9; ++term) {
    QuadricCoefficients q{1, 2, 3, 0, 0, 0, 0, 0, 0, -4};
    q[term] += 0.75;
    const Vec<double> o{4, 3, 2}, d{-1, -0.8, -0.45};
    const double t = distance<double>(q, o, d);
    ASSERT_GT(t, 0) << term;
    const double x = 4 - t, y = 3 - 0.8 * t, z = 2 - 0.45 * t;
    EXPECT_NEAR(q[0] * x * x + q[1] * y * y + q[2] * z * z + q[3] * x * y + q[4] * x * z + q[5] * y * z + q[6] * x +
                    q[7] * y + q[8] * z + q[9],
                0, 1e-12)
        << term;
    const auto n = Quadric<double>(q).intersect({o, d}, 100).normal();
    const V g{2 * q[0] * x + q[3] * y + q[4] * z + q[6], 2 * q[1] * y + q[3] * x + q[5] * z + q[7],
              2 * q[2] * z + q[4] * x + q[5] * y + q[8]};
    const V unit = normalized(g);
    EXPECT_NEAR(dot(n, unit), 1, 1e-14) << term;
  }
}

}  // namespace
}  // namespace solidcast::reference
