// Users' own GLSL by the command line, and what `shader` shows of what the driver gets.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace solidcast::cli_test {
namespace {

using Json = nlohmann::json;

class Custom : public testing::Test {
 protected:
  std::string scene(const std::string& members = "") {
    writeFile(folder_ / "s.json", R"({"image": {"width": 64, "height": 48}, "camera": {"type": "perspective",
      "center": [0, 0, 5], "forward": [0, 0, -1], "up": [0, 1, 0], "vertical_angle": 40, "horizontal_angle": 52}, )" +
                                      members + R"("solids": [{"type": "sphere", "center": [0, 0, 0], "radius": 1}]})");
    return folder_ / "s.json";
  }
  std::string file(const std::string& name, const std::string& text) {
    writeFile(folder_ / name, text);
    return folder_ / name;
  }
  Folder folder_;
};
const std::string kHead = "vec3 radiance(Hit hit, Ray ray, Parameters p) ";

TEST_F(Custom, AnyFileByOption) {
  const std::string red = file("red.glsl", kHead + "{ return vec3(1, p.green, 0); }");
  const std::string file = scene(
      R"("integrator": [{"type": "casting"}, {"type": "custom", "glsl": "none.glsl", "parameters": {"green": 0.5}}], )");
  const std::string out = folder_ / "a.pfm";
  const Result done = run({"render", file, "--integrator", red, "-o", out});
  ASSERT_EQ(done.code, 0) << done.err;
  const std::string image = readFile(out);
  const float centre[3] = {1, 0.5f, 0};
  EXPECT_NE(image.find(std::string(reinterpret_cast<const char*>(centre), 12)), std::string::npos);
  // From another folder the same file is found.
  Call there{.arguments = {"render", "s.json", "--integrator", "red.glsl", "-o", "b.pfm"}, .folder = folder_.path()};
  EXPECT_EQ(run(there).code, 0);
  EXPECT_EQ(readFile(folder_ / "b.pfm"), image);

  expectError(run({"render", file, "--integrator", "custom", "-o", out}), 4, {"none.glsl: error: cannot be read"},
              false);
  expectError(run({"render", file, "--integrator", "cast"}), 2,
              {"--integrator: \"cast\" is unknown, expected casting|castingdist|custom or a file *.glsl"});
  expectError(run({"render", scene(), "--integrator", "custom"}), 2, {"the scene names no GLSL", "expected"});
}

TEST_F(Custom, WhatFailsLeavesNoImage) {
  const std::string bad = file("bad.glsl", "\n" + kHead + "{ return vec3(x); }");
  expectError(run({"render", scene(), "--integrator", bad, "-o", folder_ / "a.png"}), 4, {"bad.glsl:2: error: 'x'"},
              false);
  const std::string endless = file("endless.glsl", kHead + "{\n  for (;;) ;\n  return vec3(1); }");
  expectError(run({"render", scene(), "--integrator", endless, "-o", folder_ / "a.png"}), 4,
              {"endless.glsl:2: error: a pixel's loops went on for more than 8191 rounds"}, false);
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"bad.glsl", "endless.glsl", "s.json"}));
}

TEST_F(Custom, NanIsWarnedOfAndCounted) {
  const std::string nan = file("nan.glsl", kHead + "{ return vec3(sqrt(-1.0 - hit.distance)); }");
  const Result done = run({"render", scene(), "--integrator", nan, "-o", folder_ / "a.png", "--json"});
  ASSERT_EQ(done.code, 0) << done.err;
  const auto count = Json::parse(done.out).at("nan_colours").get<int>();
  EXPECT_GT(count, 100);
  EXPECT_NE(
      done.err.find("solidcast: warning: " + std::to_string(count) + " colours are not a number, shown in magenta\n"),
      std::string::npos)
      << done.err;
}

TEST_F(Custom, TheReferenceSaysThatItRunsNone) {
  const std::string own = file("own.glsl", kHead + "{ return hit.normal; }");
  expectError(run({"render", scene(), "--integrator", own, "--backend", "cpu", "-o", folder_ / "a.png"}), 2,
              {"own.glsl: the CPU reference runs no GLSL"}, false);
  const Result compared = run({"compare", scene(), "--integrator", own});
  EXPECT_EQ(compared.code, 0) << compared.err;
  EXPECT_NE(compared.err.find("looked at is what was hit, with the integrator casting"), std::string::npos);
  const std::string torus = bundled("custom/torus");
  expectError(run({"render", torus, "--pixel", "9,9"}), 2, {"left ring is a custom solid", "expected none"}, false);
  expectError(run({"compare", torus}), 2, {"left ring is a custom solid", "expected none"}, false);
  expectError(run({"render", torus, "--backend", "cpu", "-o", folder_ / "a.png"}), 2, {"torus.glsl"}, false);
  expectError(run({"query", torus, "--rays", "-"}, "0 0 9 0 0 -1\n"), 2, {"torus.glsl", "without them"}, false);
}

TEST_F(Custom, ShaderShowsWhatTheDriverGets) {
  const std::string file = scene(), spirv = folder_ / "a.spv";
  ASSERT_EQ(run({"shader", file, "--emit", "spirv", "-o", spirv}).code, 0);
  const std::string words = readFile(spirv);
  ASSERT_EQ(words.substr(0, 4), "\x03\x02\x23\x07");
  const Result same = run({"shader", file, "--emit", "spirv"});
  EXPECT_EQ(same.out, words);

  const Result stats = run({"shader", file, "--emit", "stats"});
  const Json json = Json::parse(stats.out);
  ASSERT_EQ(json.at("modules").size(), 1u);
  const Json& module = json.at("modules")[0];
  EXPECT_EQ(module.at("given_bytes"), words.size());
  EXPECT_LT(module.at("given_instructions"), module.at("whole_instructions"));
  std::uint64_t given = 0;
  for (const auto& [name, counts] : module.at("instructions_by_class").items()) given += counts.at("given").get<int>();
  EXPECT_EQ(given, module.at("given_instructions"));
  EXPECT_NE(json.at("left_out").dump().find("quadric"), std::string::npos);
  // Those of the render, exactly.
  const Json rendered = Json::parse(run({"render", file, "-o", folder_ / "a.png", "--json"}).out);
  EXPECT_EQ(rendered.at("specialised_spirv_bytes"), words.size());

  const Result text = run({"shader", file, "--emit", "disassembly"});
  EXPECT_NE(text.out.find("OpEntryPoint GLCompute"), std::string::npos);
  EXPECT_EQ(text.out.find("OpSpecConstant "), std::string::npos);
  const Result glsl = run({"shader", file, "--emit", "glsl", "--method", "fast"});
  EXPECT_TRUE(glsl.out.starts_with(
      "// pixels_fast_perspective_turn1, from the specialised SPIR-V by spirv-cross\n#version 450"))
      << glsl.out.substr(0, 100) << glsl.err;
  EXPECT_NE(glsl.out.find("void main()"), std::string::npos);
  // Baked: the ball's numbers are in the code.
  EXPECT_NE(run({"shader", file, "--emit", "spirv", "--plan=baked"}).out, words);
}

TEST_F(Custom, ShaderOfUsersCodeHasAModuleForEachStage) {
  const std::string torus = bundled("custom/torus");
  const Json json = Json::parse(run({"shader", torus, "--emit", "stats"}).out);
  ASSERT_EQ(json.at("modules").size(), 4u);
  expectError(run({"shader", torus, "--emit", "spirv"}), 2, {"4 modules", "expected -o FILE"}, false);
  ASSERT_EQ(run({"shader", torus, "--emit", "spirv", "-o", folder_ / "t.spv"}).code, 0);
  EXPECT_EQ(folder_.names().size(), 4u);
  EXPECT_EQ(readFile(folder_ / "t.shade.spv").substr(0, 4), "\x03\x02\x23\x07");
}

}  // namespace
}  // namespace solidcast::cli_test
