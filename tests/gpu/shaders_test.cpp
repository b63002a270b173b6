// GLSL to SPIR-V in process, what is carried, and what SPIRV-Tools makes of it.
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "host/carried/carried.h"
#include "host/gpu/shader_interface.h"
#include "tests/gpu/fixture.h"

namespace solidcast::gpu {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, removed at the end.
class ShadersTest : public testing::Test {
 protected:
  ShadersTest() : folder_(fs::temp_directory_path() / ("solidcast shaders " + std::to_string(getpid()))) {
    fs::create_directories(folder_ / "parts");
  }
  ~ShadersTest() override { fs::remove_all(folder_); }
  fs::path write(const fs::path& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  fs::path folder_;
};

const std::string head = "#version 460\n#extension GL_GOOGLE_include_directive : require\n";

std::string withoutEnd(const std::string& main) {
  return "#version 460\nlayout(std430, binding = 0) buffer B { float b; };\n" + main;
}

TEST_F(ShadersTest, ErrorsReadAsPathLineError) {
  const std::string broken = withoutEnd("void main() {\n  b = wrong;\n  b = 1.0;\n  also = 2;\n}\n");
  const auto message = errorOf(
      Exit::shader, [&] { compileText(broken, "my shader.comp", {}); }, false);
  EXPECT_EQ(message,
            "my shader.comp:4: error: 'wrong': undeclared identifier\n"
            "my shader.comp:6: error: 'also': undeclared identifier");
  const auto syntax =
      errorOf(Exit::shader, [&] { compileText(withoutEnd("void main() { b = 1.0 }\n"), "s.comp", {}); });
  EXPECT_TRUE(syntax.starts_with("s.comp:3: error: syntax error")) << syntax;
  const auto empty = errorOf(Exit::shader, [&] { compileText(withoutEnd(""), "empty.comp", {}); });
  EXPECT_TRUE(empty.starts_with("empty.comp: error: ") && contains(empty, "Missing entry point")) << empty;
}

TEST_F(ShadersTest, IncludesComeFromBesideTheFileThenFromTheFolders) {
  const fs::path main = write("main.comp", head +
                                               "#include \"parts/a.glsl\"\n#include \"shared.glsl\"\n"
                                               "layout(std430, binding = 0) buffer B { float b; };\n"
                                               "void main() { b = a() + shared_(); }\n");
  const fs::path a = write("parts/a.glsl", "#include \"b.glsl\"\nfloat a() { return inner(); }\n");
  const fs::path b = write("parts/b.glsl", "#include \"shared.glsl\"\nfloat inner() { return 1.0; }\n");
  fs::create_directories(folder_ / "library");
  const fs::path shared =
      write("library/shared.glsl", "#ifndef SHARED\n#define SHARED\nfloat shared_() { return 2.0; }\n#endif\n");
  const CompiledModule module = compile(main, {}, {folder_ / "library"});
  EXPECT_EQ(validationError(module.spirv), "");
  EXPECT_EQ(module.files, (std::vector<fs::path>{main, a, b, shared}));

  write("parts/b.glsl", "float inner() { return nothing; }\n");
  EXPECT_EQ(errorOf(Exit::shader, [&] { compile(main, {}, {folder_ / "library"}); }),
            b.string() + ":1: error: 'nothing': undeclared identifier");
}

TEST_F(ShadersTest, MissingIncludesSayWhereTheyWereLookedFor) {
  const fs::path main = write("main.comp", head + "#include \"parts/none.glsl\"\nvoid main() {}\n");
  const auto message = errorOf(Exit::shader, [&] { compile(main, {}, {folder_ / "library"}); });
  EXPECT_TRUE(message.starts_with(main.string() + ":3: error: '#include': no such file in " + folder_.string() + ", " +
                                  (folder_ / "library").string()))
      << message;
  EXPECT_TRUE(contains(message, "parts/none.glsl")) << message;

  write("loop.glsl", "#include \"loop.glsl\"\n");
  const fs::path loop = write("loop.comp", head + "#include \"loop.glsl\"\nvoid main() {}\n");
  const auto endless = errorOf(Exit::shader, [&] { compile(loop, {}); });
  EXPECT_TRUE(contains(endless, "loop.glsl:1: error: ") && contains(endless, "deeper than 64")) << endless;

  EXPECT_EQ(errorOf(Exit::shader, [&] { compile(folder_ / "none.comp", {}); }),
            (folder_ / "none.comp").string() + ": error: the shader file cannot be read");
  EXPECT_EQ(errorOf(Exit::shader, [&] { compile(folder_, {}); }),
            folder_.string() + ": error: the shader file cannot be read");
}

TEST_F(ShadersTest, DefinesReachTheShader) {
  const std::string text = withoutEnd("#ifdef ON\nvoid main() { b = VALUE; }\n#endif\n");
  EXPECT_TRUE(contains(disassemble(compileText(text, "d.comp", {{"ON", ""}, {"VALUE", "42.5"}}).spirv), "42.5"));
  errorOf(Exit::shader, [&] { compileText(text, "d.comp", {}); });
}

TEST(CarriedTest, BuildTimeGivesWhatRunTimeDoesWithFunctionsInlined) {
  const fs::path shaders = SOLIDCAST_SOURCE_DIR "/shaders";
  const auto module =
      compile(shaders / "pixels.comp",
              {{"METHOD", "2"}, {"ARITHMETIC", "1"}, {"CAMERA", "0"}, {"STORAGE", "0"}, {"HITS", "0"}}, {shaders});
  const auto carried = carriedModule("pixels_exact64_perspective");
  const std::string later = disassemble(module.spirv), built = disassemble(carried);
  EXPECT_TRUE(contains(later, "OpFunctionCall"));
  EXPECT_FALSE(contains(built, "OpFunctionCall"));
  EXPECT_LT(carried.size(), module.spirv.size());
  const ShaderInterface a = readInterface(module.spirv, {}), b = readInterface(carried, {});
  EXPECT_EQ(a.capabilities, b.capabilities);
  EXPECT_EQ(a.workGroupSize, b.workGroupSize);
  EXPECT_EQ(a.pushConstantBytes, b.pushConstantBytes);
  EXPECT_GT(b.specialisationDefaults.size(), 15u);  // unused ones are gone
  for (const auto& [number, value] : b.specialisationDefaults) {
    ASSERT_TRUE(a.specialisationDefaults.contains(number)) << number;
    EXPECT_EQ(a.specialisationDefaults.at(number), value) << number;
  }
  ASSERT_EQ(a.bindings.size(), b.bindings.size());
  for (std::size_t i = 0; i < a.bindings.size(); ++i) {
    EXPECT_EQ(a.bindings[i].number, b.bindings[i].number);
    EXPECT_EQ(a.bindings[i].kind, b.bindings[i].kind);
  }
}

TEST(CarriedTest, AllAreValidAndUnknownOnesAreRefused) {
  EXPECT_GE(carriedModules().size(), 3u);
  for (std::string_view name : carriedModules()) EXPECT_EQ(validationError(carriedModule(name)), "") << name;
  const auto message = errorOf(Exit::shader, [] { carriedModule("nonsense"); });
  EXPECT_TRUE(contains(message, "\"nonsense\"") && contains(message, "probe_f32")) << message;
}

TEST(SpirvToolsTest, InvalidModulesAreFound) {
  std::vector<std::uint32_t> module(carriedModule("probe_f32").begin(), carriedModule("probe_f32").end());
  EXPECT_EQ(validationError(module), "");
  module.resize(module.size() - 1);  // without OpFunctionEnd
  EXPECT_NE(validationError(module), "");
  EXPECT_NE(validationError({}), "");
  errorOf(Exit::shader, [] { disassemble(std::vector<std::uint32_t>{1, 2, 3}); });
}

/// Two kinds of solids with a buffer each, as the real shaders have them, in three ways to leave one out.
const char* const twoKinds = R"(#version 460
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint sphereCount = 1;
layout(constant_id = 1) const uint boxCount = 1;
layout(constant_id = 2) const bool wantsNormal = false;
layout(std430, binding = 0) readonly buffer Spheres { vec4 spheres[]; };
layout(std430, binding = 1) readonly buffer Boxes { vec4 boxes[]; };
layout(std430, binding = 2) writeonly buffer Distances { float distances[]; };
layout(std430, binding = 3) writeonly buffer Normals { vec4 normals[]; };
struct Hit { float t; vec3 normal; };
void intersectSphere(vec4 s, float x, inout Hit hit) {
  float root = sqrt(s.w - x * x);
  if (root < hit.t) { hit.t = root; hit.normal = s.xyz; }
}
float intersectBox(vec4 b, float x) {
  if (x > b.w) return exp(b.x);
  return b.y;
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  float x = float(i);
  Hit hit = Hit(1e30, vec3(0));
  if (sphereCount > 0) {
    for (uint k = 0; k < sphereCount; ++k) intersectSphere(spheres[k], x, hit);
  }
  if (boxCount > 0) {
    for (uint k = 0; k < boxCount; ++k) {
      float t = intersectBox(boxes[k], x);
      if (t < hit.t) { hit.t = t; hit.normal = boxes[k].zzz; }
    }
  }
  distances[i] = hit.t;
  if (wantsNormal) normals[i] = vec4(normalize(hit.normal), 0);
}
)";

TEST(SpecialisedTest, WhatASceneDoesNotNeedIsGone) {
  const std::vector<std::uint32_t> whole = compileText(twoKinds, "two.comp", {}).spirv;
  const auto left = [&](std::vector<std::pair<std::uint32_t, std::uint32_t>> constants) {
    const std::vector<std::uint32_t> module = specialised(whole, constants);
    EXPECT_EQ(validationError(module), "");
    EXPECT_LT(module.size(), whole.size());
    return disassemble(module);
  };
  struct Expectation {
    std::uint32_t spheres, boxes, normal;
  };
  for (const auto [spheres, boxes, normal] :
       {Expectation{3, 2, 1}, Expectation{3, 0, 0}, Expectation{0, 2, 0}, Expectation{0, 2, 1}, Expectation{0, 0, 0}}) {
    const std::string text = left({{0, spheres}, {1, boxes}, {2, normal}});
    SCOPED_TRACE(text);
    EXPECT_FALSE(contains(text, "SpecId"));
    EXPECT_EQ(contains(text, "Sqrt"), spheres > 0);
    EXPECT_EQ(contains(text, "%spheres") || contains(text, "Spheres"), spheres > 0);
    EXPECT_EQ(contains(text, "Exp "), boxes > 0);
    EXPECT_EQ(contains(text, "Boxes"), boxes > 0);
    EXPECT_EQ(contains(text, "Normalize"), normal == 1);
    EXPECT_EQ(contains(text, "Normals"), normal == 1);
    EXPECT_TRUE(contains(text, "Distances"));
  }
  EXPECT_TRUE(contains(disassemble(whole), "Boxes"));
}

class SpecialisedOnDevice : public OnLavapipe {};

TEST_F(SpecialisedOnDevice, ComputesTheSame) {
  const std::vector<std::uint32_t> whole = compileText(twoKinds, "two.comp", {}).spirv;
  const Buffer spheres = filled<float>({0, 0, 1, 900, 0, 1, 0, 400});
  const Buffer boxes = filled<float>({3, 25, 1, 30});
  const Buffer normals = device().makeBuffer(64 * 16, BufferUse::storage);
  const Buffer asDriver = device().makeBuffer(64 * 4, BufferUse::readback);
  const Buffer asTools = device().makeBuffer(64 * 4, BufferUse::readback);
  const Pipeline driver = device().makePipeline(whole, {{0, 2}, {1, 1}});
  const Pipeline tools = device().makePipeline(specialised(whole, {{0, 2}, {1, 1}}));
  run({&driver, {&spheres, &boxes, &asDriver, &normals}, {}, {1, 1, 1}});
  run({&tools, {&spheres, &boxes, &asTools}, {}, {1, 1, 1}});  // no fourth buffer: it is left out
  EXPECT_EQ(read<float>(asTools), read<float>(asDriver));
  EXPECT_EQ(read<float>(asTools)[0], 20.0f);
}

}  // namespace
}  // namespace solidcast::gpu
