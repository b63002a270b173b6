// The harness itself: values there and back, errors that say what is wrong, comparisons that find what is off.
#include <sys/wait.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numeric>

#include "host/glsl_test/compare.h"
#include "host/glsl_test/device.h"

namespace solidcast::glsl_test {
namespace {

class HarnessTest : public Test {};

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

template <class Action>
std::string errorOf(Exit code, Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(int(error.code()), int(code)) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error was thrown";
  return {};
}

TEST_F(HarnessTest, ReturnsOneResultAnElement) {
  Function twice(device(), "float twice(float x) { return 2.0 * x; }", "float twice(float x)");
  std::vector<float> x(1000);
  std::iota(x.begin(), x.end(), -3.5f);
  const Call call = twice(x);
  const std::vector<float> result = call.result().as<float>();
  ASSERT_EQ(result.size(), x.size());
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_EQ(result[i], 2 * x[i]) << i;
  EXPECT_GT(call.nanoseconds(), 0);
  EXPECT_LE(call.nanosecondsLeast(), call.nanoseconds());
  EXPECT_LE(call.nanoseconds(), call.nanosecondsMost());
}

TEST_F(HarnessTest, PassesEveryTypeAndDirection) {
  const std::string snippet = R"(
bool all_(float a, double b, int c, uint d, bool e, vec3 f, dvec2 g, ivec4 h, inout uvec2 i, out bvec3 j, out vec3 k,
          out dvec3 l) {
  i = uvec2(i.y, i.x + d);
  j = bvec3(e, a > 0.0, f.z > 0.0);
  k = f.zxy + vec3(a, b, c);
  l = dvec3(g.y, g.x, h.w);
  return !e;
})";
  Function all(device(), snippet,
               "bool all_(float a, double b, int c, uint d, bool e, vec3 f, dvec2 g, ivec4 h, inout uvec2 i, "
               "out bvec3 j, out vec3 k, out dvec3 l)");
  const Call call =
      all(std::vector<float>{1, -2}, 0.5, std::vector<std::int32_t>{-7, 7}, std::uint32_t{3},
          std::vector<bool>{true, false}, std::vector<std::array<float, 3>>{{1, 2, 3}, {4, 5, -6}},
          std::array<double, 2>{0.1, 0.2}, std::vector<std::array<std::int32_t, 4>>{{1, 2, 3, 4}, {5, 6, 7, 8}},
          std::vector<std::array<std::uint32_t, 2>>{{10, 20}, {30, 40}});
  EXPECT_EQ(call.result().as<bool>(), (std::vector<bool>{false, true}));
  EXPECT_EQ((call["i"].as<std::array<std::uint32_t, 2>>()),
            (std::vector<std::array<std::uint32_t, 2>>{{20, 13}, {40, 33}}));
  EXPECT_EQ((call["j"].as<std::array<bool, 3>>()),
            (std::vector<std::array<bool, 3>>{{true, true, true}, {false, false, false}}));
  EXPECT_EQ((call["k"].as<std::array<float, 3>>()), (std::vector<std::array<float, 3>>{{4, 1.5f, -5}, {-8, 4.5f, 12}}));
  EXPECT_EQ((call["l"].as<std::array<double, 3>>()),
            (std::vector<std::array<double, 3>>{{0.2, 0.1, 4}, {0.2, 0.1, 8}}));
}

TEST_F(HarnessTest, ManyElementsGoThroughOnce) {
  Function add(device(), "void add(inout uint x) { x += 7u; }", "void add(inout uint x)");
  std::vector<std::uint32_t> x(3'000'001);  // more groups than a row of them holds
  std::iota(x.begin(), x.end(), 0u);
  const std::vector<std::uint32_t> result = add(x)["x"].as<std::uint32_t>();
  for (std::uint32_t i = 0; i < x.size(); ++i) ASSERT_EQ(result[i], i + 7);
}

TEST_F(HarnessTest, ReadsArraysMacrosAndIncludes) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "solidcast_glsl_test";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "mine.glsl") << "float mine(float x) { return x + OFFSET; }\n";
  Function f(device(), "#include \"mine.glsl\"\nfloat f(uint row) { return mine(rows(row).z); }", "float f(uint row)",
             {.defines = {{"OFFSET", "100.0"}}, .folders = {folder}, .arrays = {"vec3 rows"}});
  EXPECT_TRUE(contains(errorOf(Exit::usage, [&] { f(std::vector<std::uint32_t>{0}); }), "array \"rows\" was not set"));
  f.set("rows", std::vector<std::array<float, 3>>{{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(f(std::vector<std::uint32_t>{1, 0, 1}).result().as<float>(), (std::vector<float>{106, 103, 106}));
  EXPECT_TRUE(
      contains(errorOf(Exit::usage, [&] { f.set("rows", std::vector<float>{1}); }), "is vec3, was given float"));
  EXPECT_TRUE(contains(errorOf(Exit::usage, [&] { f.set("lines", std::vector<float>{1}); }), "no array \"lines\""));
  Function sphere(device(), "#include \"solidcast/numeric.glsl\"\nfloat f(float x) { return root(x); }",
                  "float f(float x)");
  EXPECT_EQ(sphere(std::vector<float>{9}).result().as<float>(), std::vector<float>{3});
}

// --- errors ---------------------------------------------------------------------------------------

std::string compileError(const std::string& snippet, const std::string& signature) {
  return errorOf(Exit::shader, [&] { Function(device(), snippet, signature); });
}

TEST_F(HarnessTest, ErrorsCarryTheSnippetsLines) {
  const std::string message = compileError("float f(float x) {\n  return wrong;\n}\n", "float f(float x)");
  EXPECT_TRUE(message.starts_with("snippet:2: error: 'wrong': undeclared identifier")) << message;
  const std::string version = compileError("\n#version 450\nfloat f(float x) { return x; }\n", "float f(float x)");
  EXPECT_TRUE(version.starts_with("snippet:2: error: '#version'")) << version;
}

TEST_F(HarnessTest, MissingFunctionsAndOtherSignaturesAreNamed) {
  const std::string missing = compileError("float g(float x) { return x; }", "float f(float x)");
  EXPECT_TRUE(missing.starts_with("snippet: error: no function `float f(float x)`; the snippet defines none"))
      << missing;
  const std::string types = compileError("\nfloat f(vec2 x) { return x.y; }", "float f(float x)");
  EXPECT_EQ(types, "snippet: error: no function `float f(float x)`\nsnippet:2: there is `float f(vec2 x)`");
  const std::string returned = compileError("vec2 f(float x) { return vec2(x); }", "float f(float x)");
  EXPECT_TRUE(contains(returned, "there is `vec2 f(float x)`")) << returned;
  const std::string direction = compileError("void f(float x) {}", "void f(out float x)");
  EXPECT_TRUE(contains(direction, "there is `void f(float x)`")) << direction;
}

TEST_F(HarnessTest, SignaturesThatCannotBeAreRefused) {
  const auto refused = [](const std::string& signature) {
    return errorOf(Exit::usage, [&] { Function(device(), "", signature); });
  };
  EXPECT_TRUE(contains(refused("float f(mat3 m)"), "type \"mat3\" cannot be passed"));
  EXPECT_TRUE(contains(refused("float f(float a[3])"), "parameter \"a\" is an array"));
  EXPECT_TRUE(contains(refused("float f(float)"), "a parameter's name is missing"));
  EXPECT_TRUE(contains(refused("float f(float a"), "expected \",\""));
  EXPECT_TRUE(contains(refused("float f(float a, float a)"), "two parameters \"a\""));
  EXPECT_TRUE(contains(refused("float (float a)"), "the function's name is missing"));
  EXPECT_TRUE(contains(refused("void f(float a)"), "nothing to test"));
  std::string many = "float f(float p0";
  for (int i = 1; i < 16; ++i) many += ", float p" + std::to_string(i);
  EXPECT_TRUE(contains(refused(many + ")"), "at most 16"));
}

TEST_F(HarnessTest, ArgumentsThatDoNotFitAreRefused) {
  Function f(device(), "float f(float a, uint b) { return a; }", "float f(float a, uint b)");
  const std::vector<float> a(10);
  const std::vector<std::uint32_t> b(11);
  const auto refused = [&](auto&&... arguments) { return errorOf(Exit::usage, [&] { f(arguments...); }); };
  EXPECT_EQ(refused(a, b), "`float f(float a, uint b)`: array lengths differ: \"a\" has 10, \"b\" has 11");
  EXPECT_TRUE(contains(refused(a), "wants 2 inputs, was given 1"));
  EXPECT_TRUE(contains(refused(a, a), "parameter \"b\" is uint, was given float"));
  EXPECT_TRUE(contains(refused(1.f, std::uint32_t{1}), "callTimes()"));
  EXPECT_TRUE(contains(refused(std::vector<float>{}, std::uint32_t{1}), "no elements"));
  EXPECT_EQ(f.callTimes(3, {2.f, std::uint32_t{1}}).result().as<float>(), (std::vector<float>{2, 2, 2}));
  const Call call = f(a, std::uint32_t{0});
  EXPECT_TRUE(contains(errorOf(Exit::usage, [&] { call["b"]; }), "no output \"b\"; there is: return"));
  EXPECT_TRUE(contains(errorOf(Exit::usage, [&] { call.result().as<double>(); }), "is float, but was read as double"));
}

// --- comparisons ----------------------------------------------------------------------------------

TEST_F(HarnessTest, TheCensusCountsErrorsByTheirSize) {
  Function copy(device(), "float f(float x) { return x; }", "float f(float x)");
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> x{1, 1, 1, nan, nan, 2, infinity, infinity, 0x1p-149f, -0.f};
  const std::vector<__float128> truth{1, 1 + 0x1p-24, 1 - 0x3p-24, nan, 1, nan, 0x1p128, 1, 1.5 * 0x1p-149, 0};
  const Measured got = copy(x).result();
  const Census c = census(Measure::ulp(), got, truth);
  EXPECT_EQ(c.components, 10u);
  EXPECT_EQ(c.errors[0], 0);
  EXPECT_EQ(c.errors[1], 0.5);
  EXPECT_EQ(c.errors[2], 3);  // below 1 the unit is half as large
  EXPECT_EQ(c.errors[3], 0);
  EXPECT_TRUE(std::isinf(c.errors[4]));
  EXPECT_TRUE(std::isinf(c.errors[5]));
  EXPECT_EQ(c.errors[6], 0);
  EXPECT_TRUE(std::isinf(c.errors[7]));
  EXPECT_EQ(c.errors[8], 0.5);
  EXPECT_EQ(c.errors[9], 0);
  EXPECT_EQ(c.exact, 4u);
  EXPECT_EQ(c.nan, 1u);
  EXPECT_EQ(c.missingNan, 1u);
  EXPECT_EQ(c.infinite, 3u);
  EXPECT_EQ(c.classes, (std::map<int, std::size_t>{{-1, 2}, {2, 1}}));
  EXPECT_EQ(c.worstElement, 4u);
  EXPECT_EQ(c.above(0.4), 6u);
  EXPECT_THROW(census(Measure::ulp(), got, std::vector<float>(9)), Error);
}

TEST_F(HarnessTest, MeasuresAreWhatTheySay) {
  Function copy(device(), "dvec2 f(dvec2 x) { return x; }", "dvec2 f(dvec2 x)");
  const std::vector<std::array<double, 2>> x{{4, 0x1p-50}};
  const std::vector<std::array<double, 2>> off{{4 + 0x1p-50, 0}};
  const Call call = copy(x);
  EXPECT_EQ(census(Measure::ulp(), call.result(), off).errors[0], 1);
  EXPECT_EQ(census(Measure::absolute(0x1p-50, ""), call.result(), off).errors[1], 1);
  EXPECT_TRUE(std::isinf(census(Measure::relative(0x1p-48, ""), call.result(), off).errors[1]));
  const std::vector<__float128> total{4};
  EXPECT_EQ(census(Measure::relative(0x1p-52, ""), sum(call.result()), total).errors[0], 1);
}

TEST_F(HarnessTest, FailuresShowTheCensusTheWorstAndTheToleranceThatPasses) {
  Function third(device(), "float third(float x, uint k) { return x * 0.333; }", "float third(float x, uint k)");
  const std::vector<float> x{0, 3, 6};
  const auto truth = truths([](float v) { return __float128(v) / 3; }, x);
  const Measure measure = Measure::relative(0x1p-10, "/1024");
  const auto result = [&](double tolerance) {
    return errorAtMost("TOLERANCE", "", "got", "truth", tolerance, measure, third(x, std::uint32_t{5}).result(), truth);
  };
  EXPECT_TRUE(result(1.1));
  const testing::AssertionResult failed = result(1);
  ASSERT_FALSE(failed);
  const std::string message = failed.message();
  for (const char* part :
       {"got against truth: 2 of 3 differ by more than TOLERANCE /1024", "equal                           1",
        "<= 2 /1024                      2", "a tolerance of 1.0", "worst: element ", "x = 0x1.8p+1 (3)", "k = 5",
        "truth = 0x1p+0 (1)", "got   = 0x1.ff"}) {
    EXPECT_TRUE(contains(message, part)) << part << "\nin:\n" << message;
  }
}

// --- no device ------------------------------------------------------------------------------------

TEST(NoDeviceTest, FailsUnlessTheUserSaysOtherwise) {
  const auto run = [](const std::string& environment) {
    const std::string program = std::filesystem::read_symlink("/proc/self/exe");
    const std::string command = environment +
                                " VK_DRIVER_FILES=/nonexistent.json VK_ICD_FILENAMES=/nonexistent.json '" + program +
                                "' --gtest_filter=HarnessTest.ReturnsOneResultAnElement 2>&1";
    FILE* pipe = popen(command.c_str(), "r");
    std::string text;
    for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
    return std::pair{WEXITSTATUS(pclose(pipe)), text};
  };
  const auto [failed, why] = run("SOLIDCAST_NO_DEVICE=");
  EXPECT_EQ(failed, 1) << why;
  EXPECT_TRUE(contains(why, "SOLIDCAST_NO_DEVICE=skip")) << why;
  const auto [skipped, said] = run("SOLIDCAST_NO_DEVICE=skip");
  EXPECT_EQ(skipped, 0) << said;
  EXPECT_TRUE(contains(said, "SKIPPED")) << said;
}

}  // namespace
}  // namespace solidcast::glsl_test
