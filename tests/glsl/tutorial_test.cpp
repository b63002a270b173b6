// The example of docs/glsl-tests.md, and that its mistyped form fails.
#include "host/glsl_test/compare.h"
#include "host/glsl_test/device.h"

namespace solidcast::glsl_test {
namespace {

class TutorialTest : public Test {};

std::string soft(const std::string& two) {
  return R"(
float soft(float low, float high, float x) {
  precise float t = (x - low) / (high - low);
  t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
  precise float r = t * t * (3.0 - )" +
         two + R"( * t);
  return r;
})";
}

testing::AssertionResult compared(const std::string& two) {
  Function f(device(), soft(two), "float soft(float low, float high, float x)");
  std::vector<float> x;
  for (int i = 0; i < 100'000; ++i) x.push_back(static_cast<float>(i) / 100'000);
  const Call call = f(0.25f, 0.75f, x);
  const auto truth = truths(
      [](float v) -> __float128 {
        const __float128 t = v < 0.25f ? 0 : v > 0.75f ? 1 : (__float128(v) - 0.25) / 0.5;
        return t * t * (3 - 2 * t);
      },
      x);
  return errorAtMost("4", "", "call.result()", "truth", 4, Measure::ulp(), call.result(), truth);
}

TEST_F(TutorialTest, SoftIsWithinFourUlp) { EXPECT_TRUE(compared("2.0")); }
TEST_F(TutorialTest, TheMistypedOneIsFound) {
  const testing::AssertionResult result = compared("1.9999");
  EXPECT_FALSE(result);
  RecordProperty("message", result.message());
  EXPECT_NE(std::string(result.message()).find("x = 0x"), std::string::npos) << result.message();
}

}  // namespace
}  // namespace solidcast::glsl_test
