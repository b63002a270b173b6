// --pixel of render and compare.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace solidcast::cli_test {
namespace {

TEST(Pixel, IsExplainedForPeopleAndForPrograms) {
  const Folder folder;
  Call call;
  call.folder = folder.path();
  call.arguments = {"compare", bundled("a_solids"), "--pixel", "320,240", "--method", "naive"};
  const Result text = run(call);
  EXPECT_EQ(text.code, 0) << text.err;
  for (const char* part : {"pixel 320,240 of 640x480", "GPU, naive in fp32", "CPU, f64", "truth", "q = b^2 - a C"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part;
  call.arguments = {"render", bundled("a_solids"), "--pixel", "320,240", "--json", "--precision", "f32"};
  const Result json = run(call);
  EXPECT_EQ(json.code, 0) << json.err;
  const auto parsed = nlohmann::json::parse(json.out);
  EXPECT_EQ(parsed["x_px"], 320);
  EXPECT_EQ(parsed["gpu"]["solid"], "sphere 2");
  EXPECT_EQ(parsed["cpu"]["name"], "CPU, f32");
  EXPECT_TRUE(folder.names().empty());  // no picture
  EXPECT_EQ(run(call).out, json.out);
}

TEST(Pixel, BadOnesAreOneLine) {
  const std::string scene = bundled("a_solids");
  expectError(run({"render", scene, "--pixel", "640,0"}), 2, {"pixel 640,0", "expected 0,0 to 639,479"});
  expectError(run({"compare", scene, "--pixel", "0,12", "--size", "16x12"}), 2, {"pixel 0,12", "0,0 to 15,11"});
  for (const char* text : {"1", "1,2,3", "-1,0", "a,b", "1;2", "1.5,2", "99999999999,0"})
    expectError(run({"render", scene, std::string("--pixel=") + text}), 2, {"--pixel", text, "expected X,Y"});
  expectError(run({"render", scene, "--pixel", "1,2", "-o", "x.png"}), 2, {"--output", "beside --pixel"});
  expectError(run({"compare", scene, "--pixel", "1,2", "--max-level", "1"}), 2, {"--max-level", "beside --pixel"});
  expectError(run({"compare", "a.png", "b.png", "--pixel", "1,2"}), 2, {"--pixel", "expected one scene"});
}

}  // namespace
}  // namespace solidcast::cli_test
