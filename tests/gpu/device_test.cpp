// Buffers, pipelines and dispatches through Device, and what it refuses.
#include <chrono>
#include <numeric>

#include "tests/gpu/fixture.h"

namespace solidcast::gpu {
namespace {

class DeviceTest : public OnLavapipe {};

const char* const doubling = R"(#version 460
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 0) buffer Values { uint values[]; };
void main() { values[gl_GlobalInvocationID.x] *= 2u; }
)";

TEST_F(DeviceTest, RunsATrivialShader) {
  const Pipeline twice = pipeline(doubling);
  const Buffer values = filled<std::uint32_t>({1, 2, 3, 4, 5, 6, 7, 8});
  const double ms = run({&twice, {&values}, {}, {1, 1, 1}});
  EXPECT_EQ(read<std::uint32_t>(values), (std::vector<std::uint32_t>{2, 4, 6, 8, 10, 12, 14, 16}));
  EXPECT_GT(ms, 0);
  EXPECT_LT(ms, 60'000);
}

TEST_F(DeviceTest, UniformStorageAndPushConstantsReachTheShader) {
  const Pipeline mixed = pipeline(R"(#version 460
layout(local_size_x = 4) in;
layout(std140, set = 0, binding = 1) uniform Factors { vec4 factors[2]; };
layout(std430, set = 0, binding = 3) readonly buffer In { float values[]; };
layout(std430, set = 0, binding = 4) writeonly buffer Out { float results[]; };
layout(push_constant) uniform Constants { vec3 offset; uint which; uint first; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  results[i] = values[first + i] * factors[which].y + offset.z;
}
)");
  const Buffer factors = filled<float>({0, 2, 0, 0, 0, 10, 0, 0}, BufferUse::uniform);
  const Buffer values = filled<float>({0, 1, 2, 3, 4, 5});
  const Buffer results = device().makeBuffer(4 * sizeof(float), BufferUse::readback);
  struct alignas(16) {  // its padding may be longer than the shader's block, which ends after 20 bytes
    float offset[3] = {0, 0, 0.5f};
    std::uint32_t which = 1, first = 2;
  } constants;
  const auto bytes = std::as_bytes(std::span(&constants, 1));
  run({&mixed, {nullptr, &factors, nullptr, &values, &results}, bytes, {1, 1, 1}});
  EXPECT_EQ(read<float>(results), (std::vector<float>{20.5, 30.5, 40.5, 50.5}));

  const auto tooFew = errorOf(Exit::shader, [&] {
    run({&mixed, {nullptr, &factors, nullptr, &values, &results}, bytes.first(16), {1, 1, 1}});
  });
  EXPECT_TRUE(contains(tooFew, "20 bytes") && contains(tooFew, "given 16")) << tooFew;
}

TEST_F(DeviceTest, UniformBuffersAreReadByTheirAddresses) {
  const Pipeline byAddress = pipeline(R"(#version 460
#extension GL_EXT_buffer_reference : require
layout(local_size_x = 4) in;
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Rows { vec4 rows[]; };
layout(std430, set = 0, binding = 0) writeonly buffer Out { float results[]; };
layout(push_constant) uniform Constants { uint first; Rows factors, offsets; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  results[i] = float(i) * factors.rows[first].y + offsets.rows[0].x;
}
)");
  const Buffer factors = filled<float>({0, 2, 0, 0, 0, 10, 0, 0}, BufferUse::uniform);
  const Buffer offsets = filled<float>({0.5f, 0, 0, 0}, BufferUse::uniform);
  const Buffer results = device().makeBuffer(4 * sizeof(float), BufferUse::readback);
  struct {
    std::uint32_t first = 1, unused = 0;
    std::uint64_t factors, offsets;
  } constants{.factors = factors.address(), .offsets = offsets.address()};
  const auto bytes = std::as_bytes(std::span(&constants, 1));
  run({&byAddress, {&results}, bytes, {1, 1, 1}});
  EXPECT_EQ(read<float>(results), (std::vector<float>{0.5, 10.5, 20.5, 30.5}));
  const auto tooFew = errorOf(Exit::shader, [&] { run({&byAddress, {&results}, bytes.first(16), {1, 1, 1}}); });
  EXPECT_TRUE(contains(tooFew, "24 bytes") && contains(tooFew, "given 16")) << tooFew;
}

TEST_F(DeviceTest, SpecialisationSetsConstantsAndWorkgroupSize) {
  const char* const text = R"(#version 460
layout(local_size_x_id = 7) in;
layout(constant_id = 0) const int whole = 5;
layout(constant_id = 1) const float fraction = 0.5;
layout(constant_id = 2) const bool negative = false;
layout(std430, set = 0, binding = 0) writeonly buffer Out { float results[]; };
void main() { results[gl_GlobalInvocationID.x] = (negative ? -1.0 : 1.0) * (float(whole) + fraction) * float(gl_WorkGroupSize.x); }
)";
  const Buffer results = filled<float>({0, 0, 0});
  const Pipeline asWritten = pipeline(text);
  run({&asWritten, {&results}, {}, {1, 1, 1}});
  EXPECT_EQ(read<float>(results), (std::vector<float>{5.5, 0, 0}));

  // A value for an id that the module does not have is nobody's business.
  const Pipeline special =
      pipeline(text, {{0, 8u}, {1, std::bit_cast<std::uint32_t>(0.25f)}, {2, 1u}, {7, 3u}, {99, 1u}});
  run({&special, {&results}, {}, {1, 1, 1}});
  EXPECT_EQ(read<float>(results), (std::vector<float>{-24.75, -24.75, -24.75}));

  const auto wide = errorOf(Exit::noDevice, [&] { pipeline(text, {{7, 5000u}}); });
  EXPECT_TRUE(contains(wide, "5000") && contains(wide, "1024")) << wide;
}

TEST_F(DeviceTest, DispatchesSeeTheWritesOfTheOneBefore) {
  const Pipeline twice = pipeline(doubling);
  const Pipeline plusOne = pipeline(R"(#version 460
layout(local_size_x = 8) in;
layout(std430, set = 0, binding = 2) buffer Values { uint values[]; };
void main() { values[gl_GlobalInvocationID.x] += 1u; }
)");
  std::vector<std::uint32_t> start(1024, 1);
  const Buffer a = filled(start), b = filled(start);
  std::vector<Dispatch> dispatches;
  for (int i = 0; i < 10; ++i) {
    dispatches.push_back({&twice, {&a}, {}, {128, 1, 1}});
    dispatches.push_back({&plusOne, {nullptr, nullptr, &a}, {}, {128, 1, 1}});
    dispatches.push_back({&plusOne, {nullptr, nullptr, &b}, {}, {128, 1, 1}});
    dispatches.push_back({&plusOne, {nullptr, nullptr, &b}, {}, {128, 1, 1}});
  }
  device().run(dispatches);
  EXPECT_EQ(read<std::uint32_t>(a), std::vector<std::uint32_t>(1024, (1u << 11) - 1));  // x -> 2x + 1 ten times
  EXPECT_EQ(read<std::uint32_t>(b), std::vector<std::uint32_t>(1024, 21));
}

TEST_F(DeviceTest, OneBufferMayBeSeenAsSeveralTypes) {
  const Pipeline bits = pipeline(R"(#version 460
layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 0) buffer Floats { float numbers[]; };
layout(std430, set = 0, binding = 0) buffer Words { uint words[]; };
void main() { words[1] = floatBitsToUint(numbers[0]); }
)");
  const Buffer buffer = filled<float>({1, 2});
  run({&bits, {&buffer}, {}, {1, 1, 1}});
  EXPECT_EQ(read<float>(buffer), (std::vector<float>{1, 1}));
}

TEST_F(DeviceTest, NoDispatchesAndEmptyBuffersAreFine) {
  EXPECT_GE(device().run({}), 0);
  EXPECT_EQ(device().makeBuffer(0, BufferUse::storage).bytes().size(), 0u);
  EXPECT_TRUE(Buffer().bytes().empty());
}

TEST_F(DeviceTest, CountsBytes) {
  const std::uint64_t before = device().bytesAllocated();
  {
    Buffer first = device().makeBuffer(1 << 20, BufferUse::storage);
    Buffer second = std::move(first);
    EXPECT_EQ(second.bytes().size(), std::size_t{1} << 20);
    EXPECT_GE(device().bytesAllocated(), before + (1 << 20));
    second = device().makeBuffer(64, BufferUse::storage);
    EXPECT_LT(device().bytesAllocated(), before + (1 << 20));
  }
  EXPECT_EQ(device().bytesAllocated(), before);
  EXPECT_GE(device().peakBytes(), before + (1 << 20));
}

TEST_F(DeviceTest, LimitsAreRefusedWithBothNumbers) {
  const DeviceLimits& limits = device().info().limits;
  const std::uint64_t before = device().bytesAllocated();
  const auto storage =
      errorOf(Exit::usage, [&] { device().makeBuffer(limits.maxStorageBufferRange + 1ull, BufferUse::storage); });
  EXPECT_TRUE(contains(storage, "134217729") && contains(storage, "134217728")) << storage;
  const auto uniform =
      errorOf(Exit::usage, [&] { device().makeBuffer(limits.maxUniformBufferRange + 1ull, BufferUse::uniform); });
  EXPECT_TRUE(contains(uniform, "65537") && contains(uniform, "65536")) << uniform;
  EXPECT_EQ(device().bytesAllocated(), before);
  EXPECT_EQ(device().makeBuffer(limits.maxUniformBufferRange, BufferUse::uniform).bytes().size(), 65536u);

  const Pipeline twice = pipeline(doubling);
  const Buffer values = filled<std::uint32_t>({1});
  const auto groups = errorOf(Exit::usage, [&] { run({&twice, {&values}, {}, {1, 70000, 1}}); });
  EXPECT_TRUE(contains(groups, "70000 workgroups in y") && contains(groups, "65535")) << groups;

  const auto invocations = errorOf(Exit::noDevice, [&] {
    pipeline("#version 460\nlayout(local_size_x = 64, local_size_y = 32) in;\nvoid main() {}\n");
  });
  EXPECT_TRUE(contains(invocations, "2048 invocations") && contains(invocations, "1024")) << invocations;

  const auto constants = errorOf(Exit::noDevice, [&] {
    pipeline(
        "#version 460\nlayout(push_constant) uniform C { mat4 m[9]; };\n"
        "layout(std430, binding = 0) buffer B { vec4 v; };\nvoid main() { v = m[8][3]; }\n");
  });
  EXPECT_TRUE(contains(constants, "576 bytes") && contains(constants, "allows ")) << constants;
}

TEST_F(DeviceTest, BuffersThatDoNotFitTheShaderAreNamed) {
  const Pipeline twice = pipeline(doubling);
  const Buffer uniform = filled<std::uint32_t>({1}, BufferUse::uniform);
  EXPECT_EQ(errorOf(Exit::shader,
                    [&] {
                      run({&twice, {}, {}, {1, 1, 1}});
                    }),
            "the shader's binding 0 (Values) was given no buffer");
  EXPECT_EQ(errorOf(Exit::shader,
                    [&] {
                      run({&twice, {nullptr}, {}, {1, 1, 1}});
                    }),
            "the shader's binding 0 (Values) was given no buffer");
  EXPECT_EQ(errorOf(Exit::shader,
                    [&] {
                      run({&twice, {&uniform}, {}, {1, 1, 1}});
                    }),
            "the shader's binding 0 (Values) is a storage buffer, but was given one of another kind");
  const std::uint32_t surplus = 0;
  const Buffer values = filled<std::uint32_t>({1, 1, 1, 1, 1, 1, 1, 1});
  const auto pushed = errorOf(Exit::shader, [&] {
    run({&twice, {&values}, std::as_bytes(std::span(&surplus, 1)), {1, 1, 1}});
  });
  EXPECT_TRUE(contains(pushed, "takes 0 bytes") && contains(pushed, "given 4")) << pushed;
}

TEST_F(DeviceTest, ModulesThatAreNotForUsAreRefused) {
  const std::vector<std::uint32_t> nonsense{1, 2, 3, 4, 5, 6};
  EXPECT_EQ(errorOf(Exit::shader, [&] { device().makePipeline(nonsense); }), "shader module: this is no SPIR-V");
  std::vector<std::uint32_t> cut = compileText(doubling, "test.comp", {}).spirv;
  cut.pop_back();
  cut.back() = 0;
  EXPECT_TRUE(contains(errorOf(Exit::shader, [&] { device().makePipeline(cut); }), "cut off"));
  const auto image = errorOf(Exit::shader, [&] {
    pipeline(
        "#version 460\nlayout(rgba8, binding = 2) uniform image2D picture;\n"
        "void main() { imageStore(picture, ivec2(0), vec4(0)); }\n");
  });
  EXPECT_EQ(image, "shader module: binding 2 (picture) is not a buffer");
  const auto set = errorOf(Exit::shader, [&] {
    pipeline("#version 460\nlayout(std430, set = 1, binding = 2) buffer B { int b; };\nvoid main() { b = 1; }\n");
  });
  EXPECT_TRUE(contains(set, "binding 2 (B) is in set 1")) << set;
  const auto capability = errorOf(Exit::noDevice, [&] {
    pipeline(
        "#version 460\n#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require\n"
        "layout(std430, binding = 0) buffer B { float b; };\nvoid main() { b = float(float16_t(b)); }\n");
  });
  EXPECT_TRUE(contains(capability, "the shader needs Float16, which llvmpipe")) << capability;
}

TEST_F(DeviceTest, ThousandsOfCallsAreCheap) {
  Device plain({.select = "llvmpipe", .validation = Validation::off});
  EXPECT_FALSE(plain.validationActive());
  const Pipeline twice = plain.makePipeline(compileText(doubling, "test.comp", {}).spirv);
  Buffer values = plain.makeBuffer(32, BufferUse::storage);
  std::memset(values.bytes().data(), 0, 32);
  const Dispatch dispatch{&twice, {&values}, {}, {1, 1, 1}};
  plain.run({&dispatch, 1});
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 2000; ++i) plain.run({&dispatch, 1});
  const double us = std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start).count() / 2000;
  RecordProperty("microseconds_per_run", std::to_string(us));
  EXPECT_LT(us, 1000);  // some 20 on an idle machine
}

TEST_F(DeviceTest, BuffersAndPipelinesMayOutliveTheirDevice) {
  std::optional<Buffer> buffer;
  std::optional<Pipeline> outliving;
  {
    Device other({.select = "llvmpipe", .validation = Validation::off});
    buffer = other.makeBuffer(64, BufferUse::storage);
    outliving = other.makePipeline(compileText(doubling, "test.comp", {}).spirv);
  }
  buffer->bytes()[0] = std::byte{1};
  EXPECT_EQ(buffer->bytes()[0], std::byte{1});
}

TEST_F(DeviceTest, DescribesItself) {
  const DeviceInfo& info = device().info();
  EXPECT_TRUE(contains(info.name, "llvmpipe")) << info.name;
  EXPECT_EQ(info.type, "cpu");
  EXPECT_EQ(info.driver, "llvmpipe");
  EXPECT_TRUE(info.float64 && info.int64 && info.bufferAddresses);
  EXPECT_EQ(info.limits.timestampPeriod, 1.0f);
  EXPECT_GT(device().instanceMilliseconds(), 0);
  EXPECT_GT(device().deviceMilliseconds(), 0);
}

// --- validation -----------------------------------------------------------------------------------

TEST(ValidationTest, MessagesAreCounted) {
  Device device({.select = "llvmpipe", .validation = Validation::on});
  // The driver refuses this module (see traps_test.cpp); before that, the layer has a word to say.
  const CompiledModule bad = compileText(
      "#version 460\nlayout(std430, binding = 0) buffer B { float b; };\n"
      "precise float p;\nvoid helper() { p = b * b + 1.0; }\nvoid main() { helper(); b = p; }\n",
      "bad.comp", {});
  testing::internal::CaptureStderr();
  try {
    device.makePipeline(bad.spirv);
  } catch (const Error& error) { EXPECT_EQ(int(error.code()), int(Exit::shader)); }
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_GT(device.validationMessages(), 0);
  EXPECT_TRUE(printed.starts_with("Vulkan validation: ")) << printed;
}

TEST(ValidationTest, AutomaticFollowsTheEnvironment) {
  const ScopedEnvironment wish{{"SOLIDCAST_VALIDATION", "1"}};
  EXPECT_TRUE(Device({.select = "llvmpipe"}).validationActive());
  const ScopedEnvironment noWish{{"SOLIDCAST_VALIDATION", nullptr}};
  EXPECT_FALSE(Device({.select = "llvmpipe"}).validationActive());
}

TEST(ValidationTest, AMissingLayerIsAnErrorOnlyWhenAskedFor) {
  const ScopedEnvironment nowhere{{"SOLIDCAST_VALIDATION", "1"}, {"VK_LAYER_PATH", "/nonexistent"}};
  EXPECT_FALSE(Device({.select = "llvmpipe"}).validationActive());
  const auto message = errorOf(Exit::usage, [] { Device({.select = "llvmpipe", .validation = Validation::on}); });
  EXPECT_TRUE(contains(message, "VK_LAYER_KHRONOS_validation is not installed")) << message;
}

}  // namespace
}  // namespace solidcast::gpu
