// GLSL that builds on solidcast's own: rays at a ball, whose distance has a closed form.
#include <solidcast/glsl_test/compare.h>
#include <solidcast/glsl_test/device.h>

namespace glsl = solidcast::glsl_test;

class BallTest : public glsl::Test {};

using Float3 = std::array<float, 3>;
using Float4 = std::array<float, 4>;

// Newton's method doubles the right digits with each step: 53 bits, 106, then all 113 of binary128.
static __float128 root(__float128 square) {
  if (square == 0) return 0;
  __float128 r = __builtin_sqrt(static_cast<double>(square));
  for (int step = 0; step < 2; ++step) r = (r + square / r) / 2;
  return r;
}

TEST_F(BallTest, IsMetAtTheDistanceOfGeometry) {
  // `rows` is an array that the test fills; solidcast's GLSL asks for its rows by two functions.
  glsl::Function distance(glsl::device(), R"(
#include "ball.glsl"
real4 record(uint row) { return rows(row); }
real4 worldRecord(uint row) { return rows(row); }
)",
                          "float ballDistance(vec3 origin, vec3 direction)", {.arrays = {"vec4 rows"}});
  distance.set("rows", std::vector<Float4>{{0, 0, 0, 2}, {0, 0, 0, 0}});  // radius 2 around the origin

  // Rays along -z through (x, 0, 5) meet it at 5 - sqrt(4 - x^2), for |x| <= 2.
  std::vector<Float3> origins;
  for (int i = -2100; i <= 2100; ++i) origins.push_back({static_cast<float>(i) / 1000, 0, 5});
  const glsl::Call call = distance(origins, Float3{0, 0, -1});

  const auto truth = glsl::truths(
      [](const Float3& origin) -> __float128 {
        const __float128 x = origin[0], square = 4 - x * x;
        return square >= 0 ? 5 - root(square) : 0;
      },
      origins);
  // Steepest beside the rim, x = 1.999: x^2 is rounded by up to 4 u, half that over its root 0.063 is 32 u or 4 ulp of
  // the distance; the other roundings stay below 4 ulp together.
  EXPECT_ERROR_AT_MOST(8, glsl::Measure::ulp(), call.result(), truth);
}
