// Sequences of pictures, and the choice of a plan on the command line.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace solidcast::cli_test {
namespace {

class SequenceTest : public ::testing::TestWithParam<const char*> {
 protected:
  SequenceTest() { writeFile(scene_, smallScene()); }
  Result render(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"--backend", GetParam()});
    return run(arguments);
  }
  Folder folder_;
  std::string scene_ = folder_ / "small.json";
};
INSTANTIATE_TEST_SUITE_P(Backends, SequenceTest, ::testing::Values("cpu", "gpu"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(SequenceTest, FramesAreNumberedAndCounted) {
  const Result result = render({scene_, "--frames", "12", "-o", folder_ / "turn.pfm"});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(folder_.names().size(), 13u);
  EXPECT_NE(readFile(folder_ / "turn.01.pfm"), "");
  EXPECT_NE(readFile(folder_ / "turn.12.pfm"), "");
  EXPECT_NE(result.err.find("12 frames in "), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("frames per second"), std::string::npos) << result.err;
}

TEST_P(SequenceTest, AFrameIsThePictureFromThatPlace) {
  const std::string key = R"({"type": "perspective", "up": [0,1,0], "vertical_angle": 45, "horizontal_angle": 60, )";
  writeFile(folder_ / "path.json", "[" + key + R"("center": [0,0,5], "forward": [0,0,-1]},)" + key +
                                       R"("center": [0,1,4], "forward": [0,0.1,-1]}])");
  ASSERT_EQ(render({scene_, "--frames", "2", "--path", folder_ / "path.json", "-o", folder_ / "p.pfm"}).code, 0);
  ASSERT_EQ(render({scene_, "--frames", "1", "--path", folder_ / "path.json", "-o", folder_ / "first.pfm"}).code, 0);
  EXPECT_EQ(readFile(folder_ / "p.1.pfm"), readFile(folder_ / "first.pfm"));
  EXPECT_NE(readFile(folder_ / "p.2.pfm"), readFile(folder_ / "first.pfm"));
}

TEST_P(SequenceTest, BadOnesAreRefused) {
  expectError(render({scene_, "--frames", "0"}), 2, {"--frames", "\"0\"", "expected 1 to"});
  expectError(render({scene_, "--frames", "2", "-o", "-"}), 2, {"--frames", "standard output"});
  expectError(render({scene_, "--path", folder_ / "none.json"}), 2, {"none.json", "expected a camera path"});
  EXPECT_EQ(folder_.names().size(), 1u);
}

TEST(PlanOption, StandsAloneOrNamesAPlan) {
  Folder folder;
  const std::string scene = folder / "small.json", out = folder / "a.pfm";
  writeFile(scene, smallScene());
  std::string bytes;
  for (const std::string plan : {"auto", "baked", "uniform", "storage", "tiles"}) {
    const Result result = run({"render", "--plan", plan, scene, "-o", out});
    EXPECT_EQ(result.code, 0) << result.err;
    if (bytes.empty()) bytes = readFile(out);
    EXPECT_EQ(readFile(out), bytes) << plan;
  }
  const Result shown = run({"render", "--plan", scene, "-o", out});
  EXPECT_EQ(shown.code, 0);
  EXPECT_NE(shown.err.find("plan: chosen: uniform"), std::string::npos) << shown.err;
  expectError(run({"render", scene, "--plan=fastest"}), 2, {"\"fastest\" is no plan", "expected one of auto"}, false);
  expectError(run({"render", scene, "--plan", "tiles", "--backend", "cpu"}), 2, {"--plan", "no meaning"});
}

TEST(PlanOption, StatisticsNameIt) {
  Folder folder;
  writeFile(folder / "s.json", smallScene());
  const Result result = run({"render", folder / "s.json", "-o", folder / "a.png", "--plan", "baked", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["plan_name"], "baked");
  EXPECT_EQ(json["frames"], 1);
  EXPECT_GT(json["frames_per_second"], 0);
}

}  // namespace
}  // namespace solidcast::cli_test
