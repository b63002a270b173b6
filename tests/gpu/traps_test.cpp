// Known traps of llvmpipe and of glslang 12. Each test shows that the trap is there; when one goes red after an update,
// the trap is gone and what works around it may go too.
#include <cmath>

#include "host/carried/probe.h"
#include "tests/gpu/fixture.h"

namespace solidcast::gpu {
namespace {

class TrapsTest : public OnLavapipe {};

TEST_F(TrapsTest, LoopsAreCutAfter65535Iterations) {
  EXPECT_EQ(loopIterations(device(), 65'535), 65'535u);
  EXPECT_EQ(loopIterations(device(), 65'536), 65'535u);
  EXPECT_EQ(loopIterations(device(), 1'000'000), 65'535u);
}

TEST_F(TrapsTest, TheCutCountsAllLoopsOfAnInvocation) {
  const Pipeline nested = pipeline(R"(#version 460
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Count { uint count; uint outer; uint inner; };
void main() {
  uint done = 0;
  for (uint i = 0; i < outer; ++i)
    for (uint j = 0; j < inner; ++j) done += 1;
  count = done;
}
)");
  const Buffer buffer = filled<std::uint32_t>({0, 100, 100});
  run({&nested, {&buffer}, {}, {1, 1, 1}});
  EXPECT_EQ(buffer.as<std::uint32_t>()[0], 10'000u);
  const Buffer longer = filled<std::uint32_t>({0, 1'000, 1'000});
  run({&nested, {&longer}, {}, {1, 1, 1}});
  EXPECT_LT(longer.as<std::uint32_t>()[0], 66'000u);
}

TEST_F(TrapsTest, ReadsOutOfBoundsGiveZeroInsteadOfCrashing) {
  const Pipeline beyond = pipeline(R"(#version 460
layout(local_size_x = 1) in;
layout(std430, binding = 0) readonly buffer In { uint values[]; };
layout(std430, binding = 1) buffer Out { uint at; uint result; };
void main() { result = values[at]; }
)");
  const Buffer values = filled<std::uint32_t>({7, 7, 7, 7});
  for (const auto& [at, expected] : {std::pair{3u, 7u}, std::pair{4u, 0u}, std::pair{1u << 28, 0u}}) {
    const Buffer out = filled<std::uint32_t>({at, 99});
    run({&beyond, {&values, &out}, {}, {1, 1, 1}});
    EXPECT_EQ(out.as<std::uint32_t>()[1], expected) << at;
  }
}

TEST_F(TrapsTest, WithoutPreciseSumsAreSimplified) {
  const std::string body = R"(
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer B { float a; float b; float r; float zero; };
void main() {
  QUALIFIER float sum = a + b;
  QUALIFIER float difference = sum - a;
  QUALIFIER float zero_ = a - a;
  r = difference;
  zero = zero_;
}
)";
  const auto result = [&](const std::string& qualifier, float a, float b) {
    const Pipeline sums = pipeline("#version 460\n#define QUALIFIER " + qualifier + body);
    const Buffer values = filled<float>({a, b, 0, 0});
    run({&sums, {&values}, {}, {1, 1, 1}});
    return read<float>(values);
  };
  const float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(result("precise", 1e8f, 1)[2], 0);
  EXPECT_EQ(result("", 1e8f, 1)[2], 1);
  EXPECT_TRUE(std::isnan(result("precise", infinity, 1)[3]));
  EXPECT_EQ(result("", infinity, 1)[3], 0);
}

TEST_F(TrapsTest, PreciseGlobalsWrittenInHelpersAreInvalid) {
  const auto text = [](const char* global, const char* local) {
    return std::string("#version 460\nlayout(std430, binding = 0) buffer B { float b; };\n") + global +
           "void helper() { " + local + "; }\nvoid main() { helper(); b = p; }\n";
  };
  const auto invalid = compileText(text("precise float p;\n", "p = b * b + 1.0"), "global.comp", {}).spirv;
  EXPECT_NE(validationError(invalid), "");
  const auto valid =
      compileText(text("float p;\n", "precise float local = b * b + 1.0; p = local"), "local.comp", {}).spirv;
  EXPECT_EQ(validationError(valid), "");
}

}  // namespace
}  // namespace solidcast::gpu
