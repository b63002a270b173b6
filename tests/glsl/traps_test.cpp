// Traps of software drivers, seen through GLSL functions: what `precise` prevents, what fma and min/max really do, and
// where loops end. tests/gpu/traps_test.cpp has those that need a whole shader.
#include <cmath>

#include "host/glsl_test/compare.h"
#include "host/glsl_test/device.h"
#include "tests/glsl/numbers.h"

namespace solidcast::glsl_test {
namespace {

class GlslTrapsTest : public Test {};

constexpr std::size_t trapCases = 100'000;

template <class Real>
std::vector<Real> operands(std::uint64_t seed, int range) {
  Operands source(seed);
  std::vector<Real> values(trapCases);
  for (Real& v : values) v = source.real<Real>(range);
  return values;
}

TEST_F(GlslTrapsTest, PreciseKeepsSumsAsTheyAreWritten) {
  const auto a = operands<float>(1, 20), b = operands<float>(2, 20);
  const auto written = truths(
      [](float x, float y) {
        volatile float sum = x + y;
        return sum - x;
      },
      a, b);
  Function with(device(), "float f(float a, float b) { precise float r = (a + b) - a; return r; }",
                "float f(float a, float b)");
  EXPECT_ERROR_AT_MOST(0, Measure::ulp(), with(a, b).result(), written);
}

TEST_F(GlslTrapsTest, WithoutPreciseLlvmpipeDoesNotAdd) {
  if (device().info().name.find("llvmpipe") == std::string::npos) return;  // a trap of its compiler
  const auto a = operands<float>(1, 20), b = operands<float>(2, 20);
  Function without(device(), "float f(float a, float b) { return (a + b) - a; }", "float f(float a, float b)");
  EXPECT_ERROR_AT_MOST(0, Measure::ulp(), without(a, b).result(), b);
}

TEST_F(GlslTrapsTest, PreciseKeepsProductsApart) {
  const auto a = operands<double>(3, 20), b = operands<double>(4, 20), c = operands<double>(5, 20);
  const auto written = truths(
      [](double x, double y, double z) {
        volatile double first = x * y, second = x * z;
        return first + second;
      },
      a, b, c);
  Function f(device(), "double f(double a, double b, double c) { precise double r = a * b + a * c; return r; }",
             "double f(double a, double b, double c)");
  EXPECT_ERROR_AT_MOST(0, Measure::ulp(), f(a, b, c).result(), written);
}

TEST_F(GlslTrapsTest, FmaIsFusedOrTwoRoundingsAndTheReportSaysWhich) {
  const auto a = operands<float>(6, 5), b = operands<float>(7, 5), c = operands<float>(8, 5);
  Function f(device(), "float f(float a, float b, float c) { precise float r = fma(a, b, c); return r; }",
             "float f(float a, float b, float c)");
  const std::vector<float> got = f(a, b, c).result().as<float>();
  std::size_t fused = 0, apart = 0, neither = 0, telling = 0;
  for (std::size_t i = 0; i < trapCases; ++i) {
    volatile float product = a[i] * b[i];
    const float two = product + c[i], one = std::fmaf(a[i], b[i], c[i]);
    if (one == two) continue;
    ++telling;
    fused += got[i] == one, apart += got[i] == two, neither += got[i] != one && got[i] != two;
  }
  EXPECT_GT(telling, trapCases / 100);
  EXPECT_EQ(neither, 0u);
  RecordProperty("fma", apart == telling ? "two roundings" : fused == telling ? "fused" : "mixed");
  if (device().info().name.find("llvmpipe") != std::string::npos) { EXPECT_EQ(apart, telling); }
}

/// With a NaN among the operands min and max may give either: no formula here may rest on them. What the search uses
/// instead is fixed (numeric_test.cpp).
TEST_F(GlslTrapsTest, MinAndMaxWithNanGiveOneOfTheOperands) {
  const std::string signature = "void f(float x, float nan, out vec4 r)";
  Function f(device(), signature + " { r = vec4(min(nan, x), min(x, nan), max(nan, x), max(x, nan)); }", signature);
  const std::vector<float> x{1, -1, 0, 1e30f};
  const auto got = f(x, std::nanf(""))["r"].as<std::array<float, 4>>();
  std::string seen;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (const float r : got[i]) {
      EXPECT_TRUE(std::isnan(r) || r == x[i]) << r;
      if (i == 0) seen += std::isnan(r) ? "NaN " : "number ";
    }
  }
  RecordProperty("min(nan,x) min(x,nan) max(nan,x) max(x,nan)", seen);
}

TEST_F(GlslTrapsTest, LoopsOfEveryLaneAreCutAt65535OnLlvmpipe) {
  const std::string signature = "uint rounds(uint wanted)";
  Function f(device(), signature + R"( {
  uint done = 0u, state = 1u;
  while (done < wanted) {
    state = state * 1664525u + 1013904223u;
    done += 1u + (state & 0u);
  }
  return state == 0u ? 0u : done;
})",
             signature, {.runs = 1});
  const std::vector<std::uint32_t> wanted{0, 1, 1000, 65'535, 65'536, 200'000, 7};
  const bool cut = device().info().name.find("llvmpipe") != std::string::npos;
  std::vector<std::uint32_t> expected = wanted;
  if (cut) {
    for (std::uint32_t& n : expected) n = std::min(n, 65'535u);
  }
  EXPECT_EQ(f(wanted).result().as<std::uint32_t>(), expected);
}

/// A zero-trip loop and an untaken branch cost their body on llvmpipe; they must at least change nothing.
TEST_F(GlslTrapsTest, BranchesNotTakenLeaveNoTrace) {
  const std::string signature = "float f(float x, uint rounds, bool taken)";
  Function f(device(), signature + R"( {
  float r = x;
  for (uint i = 0u; i < rounds; ++i) r = sqrt(-1.0 - r * r);
  if (taken) r /= 0.0;
  return r;
})",
             signature);
  const auto x = operands<float>(9, 20);
  EXPECT_ERROR_AT_MOST(0, Measure::ulp(), f(x, std::uint32_t{0}, false).result(), x);
}

}  // namespace
}  // namespace solidcast::glsl_test
