// Loops written out before the driver sees them: the same results as by the driver's own loops, and nothing left of them.
#include <spirv-tools/optimizer.hpp>

#include "host/carried/carried.h"
#include "tests/gpu/fixture.h"

namespace solidcast::gpu {
namespace {

/// With all state in phis, as modules are carried that are unrolled.
std::vector<std::uint32_t> inPhis(const std::vector<std::uint32_t>& spirv) {
  spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_1);
  optimizer.RegisterPass(spvtools::CreateInlineExhaustivePass())
      .RegisterPass(spvtools::CreateSSARewritePass())
      .RegisterPass(spvtools::CreateBlockMergePass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass());
  std::vector<std::uint32_t> out;
  EXPECT_TRUE(optimizer.Run(spirv.data(), spirv.size(), &out));
  return out;
}

struct Case {
  const char* name;
  const char* body;
  int loops;  // that stay
};
const Case cases[] = {
    {"Plain", "for (uint i = 0u; i < COUNT; ++i) sum = sum * 3u + x + i;", 0},
    {"FromElsewhereInSteps", "for (uint i = 2u; i < COUNT; i += 3u) sum = sum * 3u + x * i;", 0},
    {"WithBranches", "for (uint i = 0u; i < COUNT; ++i) { if (x > i) sum += 5u; else { sum ^= i; last = sum; } }", 0},
    {"Nested", "for (uint i = 0u; i < COUNT; ++i) { for (uint j = 0u; j < 2u; ++j) sum = sum * 5u + j; sum += i; }", 0},
    {"OneAfterTheOther",
     "uint at = 1u; for (uint i = 0u; i < COUNT; ++i) { sum += at * x; at += 2u; }"
     "for (uint i = 0u; i < COUNT + 1u; ++i) { sum = sum * 7u + at; at += 3u; } last = at;",
     0},
    {"CounterUsedBehind", "uint i = 0u; for (; i < COUNT; ++i) last = i * x; sum = i;", 0},
    {"NothingKnownOfTheInner",
     "for (uint i = 0u; i < COUNT; ++i) { for (uint j = 0u; j < x; ++j) sum = sum * 3u + j; last += sum; }", -1},
    {"InALoopThatStays",
     "[[dont_unroll]] for (uint k = 0u; k < 3u; ++k) { for (uint i = 0u; i < COUNT; ++i) sum = sum * 3u + last;"
     " last = sum + k; }",
     1},
    {"Precise",
     "for (uint i = 0u; i < COUNT; ++i) { precise float f = 0.1 * float(x) + float(sum); sum = uint(f * 3.0); }", 0},
    {"ThatBreaks", "for (uint i = 0u; i < COUNT; ++i) { sum += i; if (sum > x) break; }", 1},
    {"ThatContinues",
     "for (uint i = 0u; i < COUNT; ++i) { if ((x & 1u) == 1u) { last += i; continue; } sum = sum * 3u + i; }", 1},
    {"ThatBreaksAtOnce",
     "for (uint i = 0u; i < x; ++i) { last += i; if (COUNT != 9u) break; sum = sum * 3u + i; last = sum; }", 1},
    {"ThatBreaksBeforeALongStep",
     "for (uint i = 0u; i < x; i += (sum > 9u ? 1u + last % 3u : last % 2u + 1u)) { last += i; if (COUNT != 9u) break;"
     " sum += last; if (sum > 99u) { last ^= 1u; } }",
     1},
    {"OfUnknownLength", "for (uint i = 0u; i < x; ++i) sum = sum * 3u + i;", 1},
    {"MarkedSo", "[[dont_unroll]] for (uint i = 0u; i < COUNT; ++i) sum = sum * 3u + i;", 1},
    {"Signed", "for (int i = -1; i < 2; ++i) sum = sum * 3u + uint(i) * COUNT;", 0},
};

int count(const std::string& text, const std::string& word) {
  int n = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++n;
  return n;
}

class UnrollTest : public OnLavapipe, public testing::WithParamInterface<Case> {
 protected:
  static std::vector<std::uint32_t> whole() {
    return compileText(std::string("#version 450\n"
                                   "#extension GL_EXT_control_flow_attributes : require\n"
                                   "layout(local_size_x = 8) in;\n"
                                   "layout(constant_id = 0) const uint COUNT = 1u;\n"
                                   "layout(set = 0, binding = 0, std430) buffer Out { uint sums[]; };\n"
                                   "void main() {\n"
                                   "  uint x = gl_LocalInvocationID.x + 1u, sum = 1u, last = 7u;\n") +
                           GetParam().body +
                           "\n"
                           "  sums[gl_LocalInvocationID.x * 2u] = sum;\n"
                           "  sums[gl_LocalInvocationID.x * 2u + 1u] = last;\n"
                           "}\n",
                       "loop.comp", {})
        .spirv;
  }
  static std::vector<std::uint32_t> results(const std::vector<std::uint32_t>& module, std::uint32_t count) {
    const Pipeline pipeline = device().makePipeline(module, {{0, count}});
    const Buffer out = device().makeBuffer(64, BufferUse::readback);
    run({&pipeline, {&out}, {}, {1, 1, 1}});
    return read<std::uint32_t>(out);
  }
};
INSTANTIATE_TEST_SUITE_P(, UnrollTest, testing::ValuesIn(cases), [](const auto& info) { return info.param.name; });

TEST_P(UnrollTest, ComputesTheSame) {
  const std::vector<std::uint32_t> asWritten = whole(), prepared = inPhis(asWritten);
  EXPECT_EQ(count(disassemble(specialised(asWritten, {{0, 2}})), "OpLoopMerge"),
            count(disassemble(asWritten), "OpLoopMerge"));  // state in variables: left alone
  for (std::uint32_t rounds : {0u, 1u, 2u, 3u, 9u, 300u}) {
    const std::vector<std::uint32_t> module = specialised(prepared, {{0, rounds}});
    const std::string text = disassemble(module);
    SCOPED_TRACE(std::to_string(rounds) + " rounds\n" + (text.size() < 20000 ? text : std::string()));
    EXPECT_EQ(validationError(module), "");
    if (const int loops = GetParam().loops; loops >= 0 && rounds < 300) {
      EXPECT_EQ(count(text, "OpLoopMerge"), loops);
    }
    if (rounds == 300 && GetParam().name == std::string("Plain")) {
      EXPECT_EQ(count(text, "OpLoopMerge"), 1);  // too long
    }
    if (GetParam().name == std::string("Precise") && rounds < 300) {
      EXPECT_EQ(count(text, " NoContraction"), 1 + 3 * static_cast<int>(rounds));  // x, and each round's
    }
    EXPECT_EQ(results(prepared, rounds), results(asWritten, rounds));
  }
}

// Else the driver has them, seven in a row, and nothing but its time tells.
TEST(CarriedLoops, AreWrittenOutWhereRaysTakeTurns) {
  for (const char* method : {"fast", "exact64"})
    for (const char* camera : {"perspective", "environment", "orthographic"})
      for (const std::string turn : {"1", "4"}) {
        const auto whole = carriedModule(std::string("pixels_") + method + "_" + camera + "_turn" + turn);
        for (std::uint32_t solids : {0u, 1u, 2u}) {
          std::vector<std::pair<std::uint32_t, std::uint32_t>> constants = {{20, 60}, {21, 60}, {22, 6}};  // rows
          for (std::uint32_t kind = 0; kind < 7; ++kind) constants.push_back({kind, solids});
          const std::vector<std::uint32_t> module = specialised(whole, constants);
          EXPECT_EQ(validationError(module), "");
          const std::string text = disassemble(module);
          EXPECT_EQ(count(text, "OpLoopMerge"), turn == "1" ? 2 : 1) << method << camera << turn << solids;
        }
      }
}

}  // namespace
}  // namespace solidcast::gpu
