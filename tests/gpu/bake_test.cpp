// Uniform buffers baked into a module: the same numbers without the buffers, and loops marked for unrolling.
#include <numeric>

#include "tests/gpu/fixture.h"

namespace solidcast::gpu {
namespace {

// The blocks of shaders/records.glsl: one array each, read by a function and by component.
std::string twoBlocks(const std::string& type) {
  return "#version 450\n"
         "layout(constant_id = 0) const uint COUNT = 1u;\n"
         "layout(local_size_x = 4) in;\n"
         "layout(set = 0, binding = 0, std140) uniform Rows { " +
         type +
         " rows[COUNT]; };\n"
         "layout(set = 0, binding = 2, std140) uniform View { " +
         type +
         " view[1]; };\n"
         "layout(set = 0, binding = 1, std430) buffer Sums { float sums[]; };\n" +
         type +
         " row(uint i) { return rows[i]; }\n"
         "void main() {\n"
         "  float sum = float(view[0].w);\n"
         "  for (uint i = 0u; i < COUNT; ++i) sum += float(row(i).x) * float(gl_LocalInvocationID.x) + "
         "float(rows[i].y);\n"
         "  sums[gl_LocalInvocationID.x] = sum;\n"
         "}\n";
}

template <class Real>
std::vector<Real> counting(std::size_t n) {
  std::vector<Real> values(n);
  std::iota(values.begin(), values.end(), Real(1.1));
  return values;
}

class BakeTest : public OnLavapipe {
 protected:
  template <class Real>
  static void sameSums(const std::string& type) {
    const std::vector<std::uint32_t> whole = compileText(twoBlocks(type), "rows.comp", {}).spirv;
    const auto numbers = counting<Real>(12);
    const Buffer rows = filled(numbers, BufferUse::uniform);
    const Buffer view = filled<Real>({0, 0, 0, Real(0.3)}, BufferUse::uniform);
    const std::vector<std::uint32_t> module = baked(whole, {{0, rows.bytes()}, {2, view.bytes()}});
    EXPECT_EQ(validationError(module), "");
    const std::string text = disassemble(specialised(module, {{0, 3}}));
    EXPECT_FALSE(contains(text, "Uniform")) << text;
    EXPECT_TRUE(contains(text, " Unroll")) << text;
    EXPECT_FALSE(contains(disassemble(whole), " Unroll"));

    const Pipeline from = device().makePipeline(whole, {{0, 3}}), to = device().makePipeline(module, {{0, 3}});
    const Buffer fromSums = device().makeBuffer(16, BufferUse::readback);
    const Buffer toSums = device().makeBuffer(16, BufferUse::readback);
    run({&from, {&rows, &fromSums, &view}, {}, {1, 1, 1}});
    run({&to, {nullptr, &toSums, nullptr}, {}, {1, 1, 1}});
    EXPECT_EQ(read<float>(toSums), read<float>(fromSums));
    float expected = 0.3f;
    for (int i = 0; i < 3; ++i) expected += float(numbers[4 * i]) * 2 + float(numbers[4 * i + 1]);
    EXPECT_NEAR(read<float>(toSums)[2], expected, 1e-4);
  }
};

TEST_F(BakeTest, Vectors) { sameSums<float>("vec4"); }
TEST_F(BakeTest, VectorsOfDoubles) { sameSums<double>("dvec4"); }

TEST_F(BakeTest, BuffersThatAreNotNamedStay) {
  const std::vector<std::uint32_t> whole = compileText(twoBlocks("vec4"), "rows.comp", {}).spirv;
  const auto numbers = counting<float>(4);
  const auto module = baked(whole, {{0, std::as_bytes(std::span(numbers))}, {7, {}}});
  EXPECT_EQ(validationError(module), "");
  const std::string text = disassemble(specialised(module, {}));
  EXPECT_TRUE(contains(text, "View"));
  EXPECT_FALSE(contains(text, "Rows"));
}

TEST_F(BakeTest, BitsOfNumbersAreKept) {  // -0, a subnormal, infinity, NaN
  const std::vector<std::uint32_t> bits = {0x80000000u, 1u, 0x7f800000u, 0x7fc00001u};
  const std::string text =
      "#version 450\nlayout(set = 0, binding = 0, std140) uniform Rows { vec4 rows[1]; };\n"
      "layout(set = 0, binding = 1, std430) buffer Out { uvec4 bits; };\n"
      "void main() { bits = floatBitsToUint(rows[0]); }\n";
  const auto module = baked(compileText(text, "bits.comp", {}).spirv, {{0, std::as_bytes(std::span(bits))}});
  const Pipeline pipeline = device().makePipeline(module);
  const Buffer out = device().makeBuffer(16, BufferUse::readback);
  run({&pipeline, {nullptr, &out}, {}, {1, 1, 1}});
  EXPECT_EQ(read<std::uint32_t>(out), bits);
}

TEST_F(BakeTest, ABlockOfAnotherShapeIsRefused) {
  const std::string text =
      "#version 450\nlayout(set = 0, binding = 0, std140) uniform Two { vec4 a; vec4 b; };\n"
      "layout(set = 0, binding = 1, std430) buffer Out { vec4 c; };\nvoid main() { c = a + b; }\n";
  const std::vector<float> numbers(8);
  const auto module = compileText(text, "two.comp", {}).spirv;
  const std::string message = errorOf(Exit::shader, [&] { baked(module, {{0, std::as_bytes(std::span(numbers))}}); });
  EXPECT_TRUE(contains(message, "binding 0")) << message;
}

}  // namespace
}  // namespace solidcast::gpu
