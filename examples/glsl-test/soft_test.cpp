// A function of one's own against the same in binary128. docs/glsl-tests.md goes through it.
#include <solidcast/glsl_test/compare.h>
#include <solidcast/glsl_test/device.h>

namespace glsl = solidcast::glsl_test;

class SoftTest : public glsl::Test {};  // fails where there is no device

TEST_F(SoftTest, IsWithinFourUlp) {
  glsl::Function soft(glsl::device(), "#include \"soft.glsl\"", "float soft(float low, float high, float x)");

  std::vector<float> x;
  for (int i = 0; i < 100'000; ++i) x.push_back(static_cast<float>(i) / 100'000);
  const glsl::Call call = soft(0.25f, 0.75f, x);  // single values serve every element

  const auto truth = glsl::truths(
      [](float x) -> __float128 {
        const __float128 t = x < 0.25f ? 0 : x > 0.75f ? 1 : (__float128(x) - 0.25) / 0.5;
        return t * t * (3 - 2 * t);
      },
      x);
  EXPECT_ERROR_AT_MOST(4, glsl::Measure::ulp(), call.result(), truth);
  RecordProperty("ns", std::to_string(call.nanoseconds()));  // GPU time of an element, median of 5 runs
}
