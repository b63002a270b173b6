// Named quadrics: points that must lie on them, the side their normals show, and rounding.
#include "host/scene/quadric_forms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/scene/scene_text.h"

namespace solidcast {
namespace {

double value(const Quadric& quadric, const Triple& p) {
  const auto& k = quadric.coefficients;
  const auto [x, y, z] = p;
  return k[0] * x * x + k[1] * y * y + k[2] * z * z + k[3] * x * y + k[4] * x * z + k[5] * y * z + k[6] * x + k[7] * y +
         k[8] * z + k[9];
}

struct FormCase {
  const char* form;
  std::vector<Triple> on;       // center zero, radii (2, 3, 5), axis z
  std::vector<Triple> inside;   // where the value is negative: the normals point away from here
  std::vector<Triple> outside;  // positive
};

const double kRoot2 = std::sqrt(2.0);
const FormCase kForms[] = {
    {"ellipsoid", {{2, 0, 0}, {0, -3, 0}, {0, 0, 5}}, {{0, 0, 0}}, {{2, 3, 0}, {0, 0, 6}}},
    {"cylinder", {{2, 0, 7}, {0, 3, -9}, {kRoot2, 1.5 * kRoot2, 0}}, {{0, 0, 99}}, {{2, 3, 0}}},
    {"cone", {{0, 0, 0}, {2, 0, 5}, {0, 3, -5}, {4, 0, 10}}, {{0, 0, 1}, {0, 0, -1}}, {{1, 0, 0}}},
    {"paraboloid", {{0, 0, 0}, {2, 0, 5}, {0, -3, 5}, {4, 0, 20}}, {{0, 0, 1}}, {{0, 0, -1}, {3, 0, 5}}},
    {"hyperboloid_one_sheet",
     {{2, 0, 0}, {0, 3, 0}, {2 * kRoot2, 0, 5}, {0, 3 * kRoot2, -5}},
     {{0, 0, 9}},
     {{3, 0, 0}}},
    {"hyperboloid_two_sheets", {{0, 0, 5}, {0, 0, -5}, {2, 0, 5 * kRoot2}}, {{0, 0, 9}, {0, 0, -9}}, {{0, 0, 0}}},
    {"hyperbolic_paraboloid", {{0, 0, 0}, {2, 0, 5}, {0, 3, -5}, {2, 3, 0}}, {{0, 0, 1}}, {{0, 0, -1}}},
    {"hyperbolic_cylinder", {{2, 0, 4}, {-2, 0, 4}, {2 * kRoot2, 3, 0}}, {{5, 0, 0}, {-5, 0, 0}}, {{0, 0, 0}}},
    {"parabolic_cylinder", {{0, 0, 8}, {2, 3, 0}, {-4, 12, 1}}, {{0, 1, 0}}, {{0, -1, 0}}},
};

TEST(QuadricForms, HoldTheirPointsAndSides) {
  ASSERT_EQ(std::size(kForms), std::size(kQuadricForms));
  for (const FormCase& c : kForms) {
    SCOPED_TRACE(c.form);
    const QuadricForm* form = findQuadricForm(c.form);
    ASSERT_NE(form, nullptr);
    const Triple center = {10, -20, 0.5};
    const Quadric atZero = makeQuadric(*form, {0, 0, 0}, {2, 3, 5}), moved = makeQuadric(*form, center, {2, 3, 5});
    const auto shifted = [&](const Triple& p) { return Triple{p[0] + center[0], p[1] + center[1], p[2] + center[2]}; };
    for (const Triple& p : c.on) {
      EXPECT_NEAR(value(atZero, p), 0, 1e-14);
      EXPECT_NEAR(value(moved, shifted(p)), 0, 1e-12);
    }
    for (const Triple& p : c.inside) EXPECT_LT(value(atZero, p), -1e-3);
    for (const Triple& p : c.inside) EXPECT_LT(value(moved, shifted(p)), -1e-3);
    for (const Triple& p : c.outside) EXPECT_GT(value(atZero, p), 1e-3);
  }
}

TEST(QuadricForms, TurnToEveryAxis) {
  // Radii stay with x, y, z; the two other axes keep the order x, y, z.
  const QuadricForm& saddle = *findQuadricForm("hyperbolic_paraboloid");
  EXPECT_EQ(makeQuadric(saddle, {0, 0, 0}, {2, 4, 8}, 2).coefficients,
            (std::array<double, 10>{1. / 4, -1. / 16, 0, 0, 0, 0, 0, 0, -1. / 8, 0}));
  EXPECT_EQ(makeQuadric(saddle, {0, 0, 0}, {2, 4, 8}, 1).coefficients,
            (std::array<double, 10>{1. / 4, 0, -1. / 64, 0, 0, 0, 0, -1. / 4, 0, 0}));
  EXPECT_EQ(makeQuadric(saddle, {0, 0, 0}, {2, 4, 8}, 0, true).coefficients,
            (std::array<double, 10>{0, 1. / 16, -1. / 64, 0, 0, 0, 1. / 2, 0, 0, 0}));
}

TEST(QuadricForms, ReadFromFiles) {
  const auto read = [](const std::string& fields) {
    return std::get<Quadric>(
               parse(withSolids(R"({"type": "quadric", "center": [0, 0, 0], )" + fields + "}")).world.solids[0].shape)
        .coefficients;
  };
  EXPECT_EQ(read(R"("form": "cylinder", "radii": [2, 4])"),
            (std::array<double, 10>{1. / 4, 1. / 16, 0, 0, 0, 0, 0, 0, 0, -1}));
  EXPECT_EQ(read(R"("form": "cylinder", "radii": [2, 4], "axis": "y")"),
            (std::array<double, 10>{1. / 4, 0, 1. / 16, 0, 0, 0, 0, 0, 0, -1}));
  EXPECT_EQ(read(R"("form": "cylinder", "radii": [2, 4], "axis": "x")"),
            (std::array<double, 10>{0, 1. / 4, 1. / 16, 0, 0, 0, 0, 0, 0, -1}));
  EXPECT_EQ(read(R"("form": "paraboloid", "radii": [1, 2, 4], "axis": "-y")"),
            (std::array<double, 10>{1, 0, 1. / 16, 0, 0, 0, 0, 1. / 2, 0, 0}));
}

TEST(QuadricForms, AreRoundedOnce) {
  // c^2/r^2 - 1 with c/r = 1 + 2^-40: fp64 steps would lose 2^-80; the rounded truth is 2^-39 + 2^-80.
  const Quadric ball = makeQuadric(*findQuadricForm("ellipsoid"), {1 + 0x1p-40, 0, 0}, {1, 1, 1});
  EXPECT_EQ(ball.coefficients[9], 0x1p-39 + 0x1p-80);
}

TEST(QuadricForms, ExtremeRadiiAreScaledByPowersOfTwo) {
  const Quadric tiny = makeQuadric(*findQuadricForm("ellipsoid"), {0, 0, 0}, {0x1p-80, 0x1p-80, 0x1p-80});
  EXPECT_EQ(tiny.coefficients[0] / tiny.coefficients[9], -0x1p160);
  EXPECT_LE(tiny.coefficients[0], 0x1p100);
  EXPECT_EQ(tiny.coefficients[0], tiny.coefficients[2]);
}

}  // namespace
}  // namespace solidcast
