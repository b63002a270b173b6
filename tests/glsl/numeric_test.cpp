// shaders/numeric.glsl against binary128: float and double are correctly rounded, and each double-float operation keeps
// the bound that its comment states.
#include <quadmath.h>

#include <cmath>

#include "host/glsl_test/compare.h"
#include "host/glsl_test/device.h"
#include "tests/glsl/numbers.h"

namespace solidcast::glsl_test {
namespace {

using f128 = __float128;
constexpr std::size_t cases = 300'000;
constexpr int range = 38;  // exponents: products stay above 2^-79, where their errors are no denormals

class NumericTest : public Test {
 protected:
  /// A function over `real`s as C++ sees them: float, double, or vec2(hi, lo).
  static Function of(int arithmetic, const std::string& body, const std::string& signature) {
    return Function(device(), "#include \"solidcast/numeric.glsl\"\n" + body, signature,
                    {.defines = {{"ARITHMETIC", std::to_string(arithmetic)}}, .runs = 1});
  }
  static Function binary(const std::string& operation) {
    return of(2,
              "vec2 f(vec2 a, vec2 b) { real r = " + operation +
                  "(real(a.x, a.y), real(b.x, b.y)); return vec2(r.hi, r.lo); }",
              "vec2 f(vec2 a, vec2 b)");
  }
  static Measure units() { return Measure::relative(0x1p-48, "2^-48"); }
};

f128 plus(f128 a, f128 b) { return a + b; }
f128 minus(f128 a, f128 b) { return a - b; }
f128 times(f128 a, f128 b) { return a * b; }
f128 over(f128 a, f128 b) { return a / b; }

// --- float and double -----------------------------------------------------------------------------

template <class Real>
void correctlyRounded(const std::string& type, int arithmetic) {
  const auto function = [&](const std::string& operation, const std::string& parameters, const std::string& arguments) {
    const std::string signature = type + " f(" + parameters + ")";
    return Function(
        device(),
        "#include \"solidcast/numeric.glsl\"\n" + signature + " { return " + operation + "(" + arguments + "); }",
        signature, {.defines = {{"ARITHMETIC", std::to_string(arithmetic)}}, .runs = 1});
  };
  Operands operands(1);
  std::vector<Real> a, b, positive;
  for (std::size_t i = 0; i < cases; ++i) {
    a.push_back(operands.real<Real>(range));
    b.push_back(operands.chance(0.3) ? static_cast<Real>(-a.back() * (1 + Real(0x1p-20))) : operands.real<Real>(range));
    positive.push_back(std::fabs(a.back()));
  }
  const std::string two = type + " a, " + type + " b";
  for (const auto& [operation, exact] :
       {std::pair{"add", &plus}, std::pair{"sub", &minus}, std::pair{"mul", &times}, std::pair{"quotient", &over}}) {
    SCOPED_TRACE(operation);
    EXPECT_ERROR_AT_MOST(0.5, Measure::ulp(), function(operation, two, "a, b")(a, b).result(), truths(exact, a, b));
  }
  EXPECT_ERROR_AT_MOST(0.5, Measure::ulp(), function("root", type + " a", "a")(positive).result(),
                       truths([](Real x) { return sqrtq(x); }, positive));
}

TEST_F(NumericTest, FloatIsCorrectlyRounded) { correctlyRounded<float>("float", 0); }
TEST_F(NumericTest, DoubleIsCorrectlyRounded) { correctlyRounded<double>("double", 1); }

// --- double-float ---------------------------------------------------------------------------------

TEST_F(NumericTest, ErrorFreeTransformationsAreErrorFree) {
  Operands operands(2);
  std::vector<float> a, b;
  for (std::size_t i = 0; i < cases; ++i) {
    a.push_back(operands.real<float>(range));
    b.push_back(operands.real<float>(range));
  }
  for (const auto& [operation, exact] : {std::pair{"twoSum", &plus}, std::pair{"twoProduct", &times}}) {
    SCOPED_TRACE(operation);
    Function f =
        of(2, std::string("vec2 f(float a, float b) { real r = ") + operation + "(a, b); return vec2(r.hi, r.lo); }",
           "vec2 f(float a, float b)");
    const Output result = f(a, b).result();
    EXPECT_ERROR_AT_MOST(0, Measure::ulp(), sum(result), truths(exact, a, b));
    const std::vector<Pair> pairs = result.as<Pair>();
    for (std::size_t i = 0; i < cases; ++i) ASSERT_EQ(pairs[i][0], static_cast<float>(exact(a[i], b[i]))) << i;
  }
}

/// Worst relative error in units of 2^-48, and that results are normalised.
double worstOf(const std::string& what, const Output& result, const std::vector<f128>& truth, double stated) {
  SCOPED_TRACE(what);
  EXPECT_ERROR_AT_MOST(stated, Measure::relative(0x1p-48, "2^-48"), sum(result), truth);
  for (const Pair& p : result.as<Pair>()) EXPECT_EQ(p[0] + p[1], p[0]) << what << " is not normalised";
  const double worst = census(Measure::relative(0x1p-48, ""), sum(result), truth).worst;
  testing::Test::RecordProperty(what, std::to_string(worst));
  std::printf("    %-9s at most %.3f x 2^-48, stated %g\n", what.c_str(), worst, stated);
  return worst;
}

// The stated bounds are those of the comment in numeric.glsl. A bound far above what is ever seen would be an empty
// promise, so the worst seen must reach a third of it.
TEST_F(NumericTest, DoubleFloatOperationsKeepTheirBounds) {
  Operands operands(3);
  std::vector<Pair> a, b;
  for (std::size_t i = 0; i < cases; ++i) {
    a.push_back(operands.pair(range));
    b.push_back(operands.chance(0.5) ? operands.near(a.back()) : operands.pair(range));
  }
  const auto each = [&](auto exact) {
    return truths([&](const Pair& x, const Pair& y) { return exact(valueOf(x), valueOf(y)); }, a, b);
  };
  EXPECT_GT(worstOf("add", binary("add")(a, b).result(), each(plus), 3), 1);
  EXPECT_GT(worstOf("sub", binary("sub")(a, b).result(), each(minus), 3), 1);
  EXPECT_GT(worstOf("mul", binary("mul")(a, b).result(), each(times), 5), 2);
  EXPECT_GT(worstOf("quotient", binary("quotient")(a, b).result(), each(over), 6), 2);

  std::vector<Pair> positive;
  for (const Pair& x : a) positive.push_back(x[0] < 0 ? Pair{-x[0], -x[1]} : x);
  Function root = of(2, "vec2 f(vec2 a) { real r = root(real(a.x, a.y)); return vec2(r.hi, r.lo); }", "vec2 f(vec2 a)");
  EXPECT_GT(worstOf("root", root(positive).result(), truths([](const Pair& x) { return sqrtq(valueOf(x)); }, positive),
                    3.125),
            1.05);
}

/// linear() as the solids' files count it: 7u of the sum of its terms' sizes, with the stated u = 2^-44.
TEST_F(NumericTest, LinearFormsKeepSevenU) {
  Operands operands(4);
  std::vector<Pair> g[3], d[3];
  std::vector<f128> truth, size;
  for (std::size_t i = 0; i < cases; ++i) {
    f128 sum = 0, terms = 0;
    for (int k = 0; k < 3; ++k) {
      g[k].push_back(operands.pair(10));
      d[k].push_back(k > 0 && operands.chance(0.5) ? operands.near(d[0].back()) : operands.pair(10));
      const f128 term = valueOf(g[k].back()) * valueOf(d[k].back());
      sum += term, terms += fabsq(term);
    }
    truth.push_back(sum), size.push_back(terms);
  }
  Function f = of(2, R"(
real r(vec2 v) { return real(v.x, v.y); }
vec2 f(vec2 gx, vec2 gy, vec2 gz, vec2 dx, vec2 dy, vec2 dz) {
  real s = linear(real3(r(gx), r(gy), r(gz)), real3(r(dx), r(dy), r(dz)));
  return vec2(s.hi, s.lo);
})",
                  "vec2 f(vec2 gx, vec2 gy, vec2 gz, vec2 dx, vec2 dy, vec2 dz)");
  const std::vector<Pair> got = f(g[0], g[1], g[2], d[0], d[1], d[2]).result().as<Pair>();
  double worst = 0;
  for (std::size_t i = 0; i < cases; ++i) {
    worst = std::fmax(worst, static_cast<double>(fabsq(valueOf(got[i]) - truth[i]) / (size[i] * 0x1p-44)));
  }
  std::printf("    linear at most %.3f u of its terms, u = 2^-44\n", worst);
  EXPECT_LE(worst, 7);
  EXPECT_GT(worst, 0.1);
}

TEST_F(NumericTest, DoubleFloatOrderIsThatOfTheValues) {
  Operands operands(5);
  std::vector<Pair> a, b;
  std::vector<std::array<bool, 2>> truth;
  for (std::size_t i = 0; i < cases; ++i) {
    a.push_back(operands.pair(2));
    b.push_back(operands.chance(0.7) ? Pair{a.back()[0], operands.chance(0.5) ? a.back()[1] : a.back()[1] / 2}
                                     : operands.pair(2));
    truth.push_back({valueOf(a.back()) < valueOf(b.back()), valueOf(a.back()) >= valueOf(b.back())});
  }
  Function f = of(2,
                  "bvec2 f(vec2 a, vec2 b) { return bvec2(less(real(a.x, a.y), real(b.x, b.y)), atLeast(real(a.x, "
                  "a.y), real(b.x, b.y))); }",
                  "bvec2 f(vec2 a, vec2 b)");
  EXPECT_ERROR_AT_MOST(0, Measure::ulp(), f(a, b).result(), truth);
}

// --- NaN, zero, infinity --------------------------------------------------------------------------

/// What the search relies on: a miss is NaN and loses every comparison, whatever stands on the other side.
class NumericNanTest : public NumericTest, public testing::WithParamInterface<int> {};

TEST_P(NumericNanTest, NanLosesEveryComparison) {
  const std::string signature = "bvec2 f(float x, float minusOne)";  // a constant's root would be known beforehand
  const std::vector<float> x{0, -0.f, 1, -1, 1e30f, -1e30f};
  const auto both = [&](const std::string& first, const std::string& second) {
    const std::string body = "{\n  real nan = root(number(minusOne)), y = number(x);\n  return bvec2(";
    Function f = of(GetParam(), signature + body + first + ", " + second + ");\n}", signature);
    return f(x, -1.f).result().as<std::array<bool, 2>>();
  };
  for (const auto& r : both("less(nan, y)", "less(y, nan)")) EXPECT_EQ(r, (std::array<bool, 2>{false, false}));
  for (const auto& r : both("atLeast(nan, y)", "atLeast(y, nan)")) EXPECT_EQ(r, (std::array<bool, 2>{false, false}));
  for (const auto& r : both("less(nan, nan)", "isZero(nan)")) EXPECT_EQ(r, (std::array<bool, 2>{false, false}));
}

TEST_P(NumericNanTest, RootSelectAndTheOrderOfSmallerAndLarger) {
  const std::string signature = "void f(float x, out vec4 roots, out vec4 chosen, out vec4 extremes, out vec3 sizes)";
  Function f = of(GetParam(), signature + R"( {
  real nan = root(number(-x)), y = number(x);
  roots = vec4(toFloat(root(number(-x))), toFloat(root(number(x - x))), toFloat(root(y)), toFloat(root(mul(y, y))));
  chosen = vec4(toFloat(select(nan, y, true)), toFloat(select(nan, y, false)), toFloat(select(y, nan, true)),
                toFloat(select(y, nan, false)));
  extremes = vec4(toFloat(smaller(nan, y)), toFloat(smaller(y, nan)), toFloat(larger(nan, y)), toFloat(larger(y, nan)));
  sizes = vec3(toFloat(magnitude(negate(y))), toFloat(magnitude(y)), toFloat(settled()) > 1e37 ? 1.0 : 0.0);
})",
                  signature);
  const float nan = std::nanf("");
  const Call call = f(std::vector<float>{4, 9});
  using Four = std::vector<std::array<float, 4>>;
  EXPECT_ERROR_AT_MOST(0, Measure::ulp(), call["roots"], (Four{{nan, 0, 2, 4}, {nan, 0, 3, 9}}));
  EXPECT_ERROR_AT_MOST(0, Measure::ulp(), call["chosen"], (Four{{4, nan, nan, 4}, {9, nan, nan, 9}}));
  // The second operand is what stays where a comparison fails.
  EXPECT_ERROR_AT_MOST(0, Measure::ulp(), call["extremes"], (Four{{4, nan, 4, nan}, {9, nan, 9, nan}}));
  EXPECT_ERROR_AT_MOST(0, Measure::ulp(), call["sizes"], (std::vector<std::array<float, 3>>{{4, 4, 1}, {9, 9, 1}}));
}

INSTANTIATE_TEST_SUITE_P(Arithmetic, NumericNanTest, testing::Range(0, 3), [](const auto& info) {
  return std::string(std::array{"Float", "Double", "DoubleFloat"}[static_cast<std::size_t>(info.param)]);
});

}  // namespace
}  // namespace solidcast::glsl_test
