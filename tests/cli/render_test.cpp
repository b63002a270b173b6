// `solidcast render` on both backends: what is written, what is said, and what is left after a failure.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "host/image/reader.h"
#include "tests/cli/program.h"

namespace solidcast::cli_test {
namespace {

/// Every test on each backend.
class Render : public ::testing::TestWithParam<const char*> {
 protected:
  Render() { writeFile(scene_, smallScene()); }

  Result render(std::vector<std::string> arguments) {
    Call what;
    what.arguments = {"render"};
    what.arguments.insert(what.arguments.end(), arguments.begin(), arguments.end());
    what.arguments.insert(what.arguments.end(), {"--backend", GetParam()});
    what.folder = folder_.path();
    return run(what);
  }

  /// Runs and expects success; gives the image's bytes.
  std::string rendered(std::vector<std::string> arguments, const std::string& name) {
    arguments.insert(arguments.end(), {"-o", folder_ / name});
    const Result result = render(arguments);
    EXPECT_EQ(result.code, 0) << result.err;
    return readFile(folder_ / name);
  }

  Folder folder_;
  std::string scene_ = folder_ / "small.json";
};

INSTANTIATE_TEST_SUITE_P(Backends, Render, ::testing::Values("cpu", "gpu"),
                         [](const auto& info) { return std::string(info.param); });

std::vector<std::uint8_t> bytes(const std::string& path) {
  const Image image = readImage(path);
  return std::get<0>(image.values);
}

TEST_P(Render, DefaultOutputIsTheScenesNameInTheCurrentFolder) {
  const Result result = render({scene_});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"small.json", "small.png"}));
  const Image image = readImage(folder_ / "small.png");
  EXPECT_EQ(image.width, 64);
  EXPECT_EQ(image.height, 48);
  // In the very middle the sphere is seen head on, in the corner is nothing.
  const auto& rgb = std::get<0>(image.values);
  EXPECT_GE(rgb[3 * (24 * 64 + 32)], 252);
  EXPECT_EQ(rgb[0], 0);
}

TEST_P(Render, NamesWhatItUsesInOneLine) {
  const Result result = render({scene_});
  EXPECT_EQ(result.out, "");
  ASSERT_EQ(lines(result.err).size(), 1u) << result.err;
  const std::string expected =
      GetParam() == std::string("cpu") ? "solidcast: CPU reference, f64, " : "solidcast: device ";
  EXPECT_EQ(result.err.rfind(expected, 0), 0u) << result.err;
}

TEST_P(Render, StandardOutputGetsThePngAlone) {
  const std::string file = rendered({scene_}, "a.png");
  const Result result = render({scene_, "-o", "-"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, file);
}

TEST_P(Render, SceneFromStandardInput) {
  const std::string file = rendered({scene_}, "a.png");
  const Result result = run({"render", "-", "-o", "-", "--backend", GetParam()}, smallScene());
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, file);
}

TEST_P(Render, AMeshFileIsAScene) {
  rendered({SOLIDCAST_SOURCE_DIR "/scenes/meshes/knot.obj", "--size", "40x30"}, "k.png");
  const std::vector<std::uint8_t> pixels = bytes(folder_ / "k.png");
  const auto lit = std::count_if(pixels.begin(), pixels.end(), [](std::uint8_t value) { return value > 0; });
  EXPECT_GT(lit, 3 * 40 * 30 / 10);  // the knot fills a good part of the picture,
  EXPECT_LT(lit, 3 * 40 * 30 / 2);   // and is seen whole
  expectError(render({folder_ / "none.ply", "-o", folder_ / "n.png"}), 2, {"none.ply", "no such file"});
}

TEST_P(Render, SizeReplacesTheScenes) {
  rendered({scene_, "--size", "21x11"}, "a.png");
  const Image image = readImage(folder_ / "a.png");
  EXPECT_EQ(image.width, 21);
  EXPECT_EQ(image.height, 11);
}

TEST_P(Render, CropHasThePixelsOfTheWhole) {
  const std::string scene = bundled("a_solids");
  const int width = 640, x = 203, y = 101, w = 77, h = 53;
  rendered({scene}, "whole.png");
  rendered({scene, "--crop", "203,101,77,53"}, "part.png");
  const auto whole = bytes(folder_ / "whole.png"), part = bytes(folder_ / "part.png");
  ASSERT_EQ(part.size(), std::size_t{3 * w * h});
  for (int row = 0; row < h; ++row)
    EXPECT_EQ(std::memcmp(&part[3 * row * w], &whole[3 * ((y + row) * width + x)], 3 * w), 0) << "row " << row;
}

TEST_P(Render, AovsStandBesideTheImage) {
  rendered({scene_, "--aov", "normal,distance", "--aov", "solid,local,position,normal"}, "out.pfm");
  EXPECT_EQ(folder_.names(), (std::vector<std::string>{"out.distance.pfm", "out.local.pfm", "out.normal.pfm", "out.pfm",
                                                       "out.position.pfm", "out.solid.pfm", "small.json"}));
  const Image distance = readImage(folder_ / "out.distance.pfm"), normal = readImage(folder_ / "out.normal.pfm");
  const Image solid = readImage(folder_ / "out.solid.pfm");
  EXPECT_EQ(distance.channels, 1);
  EXPECT_EQ(normal.channels, 3);
  const int middle = 24 * 64 + 32;
  EXPECT_NEAR(std::get<1>(distance.values)[middle], 4, 0.01);
  EXPECT_NEAR(std::get<1>(normal.values)[3 * middle + 2], 1, 0.01);
  EXPECT_EQ(std::get<1>(solid.values)[middle], 0);
  EXPECT_EQ(std::get<1>(solid.values)[0], -1);
  EXPECT_TRUE(std::isinf(std::get<1>(distance.values)[0]));
}

TEST_P(Render, AChannelNamedTwiceIsWrittenOnce) {
  const Result result = render({scene_, "-o", folder_ / "out.pfm", "--aov", "normal,normal", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(nlohmann::json::parse(result.out).at("outputs").size(), 2u);
}

TEST_P(Render, SecondIntegratorAndTwoSided) {
  const std::string scene = bundled("a_solids");
  rendered({scene}, "a.png");
  rendered({scene, "--integrator", "castingdist"}, "b.png");
  rendered({scene, "--two-sided"}, "c.png");
  const auto a = bytes(folder_ / "a.png"), b = bytes(folder_ / "b.png"), c = bytes(folder_ / "c.png");
  const auto pixel = [](const std::vector<std::uint8_t>& rgb, int x, int y) {
    const std::uint8_t* at = &rgb[3 * (y * 640 + x)];
    return std::vector<int>{at[0], at[1], at[2]};
  };
  EXPECT_EQ(pixel(a, 320, 240), (std::vector<int>{196, 196, 196}));
  EXPECT_EQ(pixel(b, 320, 240), (std::vector<int>{131, 104, 0}));
  EXPECT_EQ(pixel(a, 300, 320), (std::vector<int>{0, 0, 0}));  // the quad from behind
  EXPECT_EQ(pixel(c, 300, 320), (std::vector<int>{47, 47, 47}));
}

TEST_P(Render, SamplesSmoothTheEdge) {
  rendered({scene_}, "one.png");
  rendered({scene_, "--samples", "4"}, "many.png");
  const auto one = bytes(folder_ / "one.png"), many = bytes(folder_ / "many.png");
  EXPECT_NE(one, many);
}

TEST_P(Render, StatsAreATableOnStandardError) {
  const Result result = render({scene_, "--stats"});
  EXPECT_EQ(result.code, 0);
  EXPECT_EQ(result.out, "");
  for (const char* name : {"dispatch_ms", "whole_ms", "device_bytes"})
    EXPECT_NE(result.err.find(name), std::string::npos) << name;
}

TEST_P(Render, JsonHasEveryPhaseAndIsAloneOnStandardOutput) {
  const Result result = render({scene_, "--stats", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  double sum = 0;
  for (const char* phase : {"scene_ms", "instance_ms", "device_ms", "flatten_ms", "shader_ms", "first_dispatch_ms",
                            "fallback_ms", "readback_ms", "encode_ms", "write_ms"}) {
    ASSERT_TRUE(json.at(phase).is_number()) << phase;
    EXPECT_GE(json.at(phase).get<double>(), 0) << phase;
    sum += json.at(phase).get<double>();
  }
  EXPECT_GT(json.at("dispatch_ms").get<double>(), 0);
  EXPECT_GE(json.at("whole_ms").get<double>(), 0.9 * sum);
  EXPECT_EQ(json.at("width"), 64);
  EXPECT_EQ(json.at("height"), 48);
  EXPECT_EQ(json.at("rays"), 64 * 48);
  EXPECT_EQ(json.at("solids"), 1);
  EXPECT_TRUE(json.at("plan").is_array());
  EXPECT_TRUE(json.at("left_out").is_array());
  EXPECT_GT(json.at("host_bytes_peak").get<double>(), 1e6);
  if (GetParam() == std::string("gpu")) { EXPECT_GT(json.at("device_bytes_peak").get<double>(), 3 * 64 * 48); }
  EXPECT_EQ(json.at("outputs"), nlohmann::json{"small.png"});
}

TEST_P(Render, SameInputSameBytes) {
  EXPECT_EQ(rendered({bundled("a_solids"), "--size", "160x120"}, "a.png"),
            rendered({bundled("a_solids"), "--size", "160x120"}, "b.png"));
}

TEST_P(Render, FullDiskIsOneErrorAndExitFive) {
  Call what;
  what.arguments = {"render", scene_, "-o", "-", "--backend", GetParam()};
  what.outputFile = "/dev/full";
  expectError(run(what), 5, {"standard output", "No space left"}, false);
  expectError(render({scene_, "-o", "/dev/full"}), 2, {"/dev/full", "expected .png"});
}

// --- bad input: one line, exit code, no file ------------------------------------------------------

class Refused : public ::testing::Test {
 protected:
  Refused() { writeFile(scene_, smallScene()); }
  Result render(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", scene_});
    Call what;
    what.arguments = arguments;
    what.folder = folder_.path();
    return run(what);
  }
  ~Refused() override { EXPECT_EQ(folder_.names(), std::vector<std::string>{"small.json"}); }

  Folder folder_;
  std::string scene_ = folder_ / "small.json";
};

TEST_F(Refused, Sizes) {
  for (const char* size : {"0x10", "10x0", "-3x4", "10", "x", "10x", "10x10x10", "1000000000x2", "99999999999x2",
                           "1.5x2", "10X10", " 10x10", ""})
    expectError(render({"--size", size}), 2, {"--size", "expected WIDTHxHEIGHT", "100000"});
}

TEST_F(Refused, Crops) {
  for (const char* crop : {"1,2,3", "-1,0,4,4", "0,0,0,4", "a,b,c,d", "1,2,3,4,5", ""})
    expectError(render({"--crop", crop}), 2, {"--crop", "expected X,Y,WIDTH,HEIGHT"});
  for (const char* crop : {"60,0,5,1", "0,48,1,1", "2147483647,0,1,1", "0,0,2147483647,1"})
    expectError(render({"--crop", crop}), 2, {"--crop", "outside the image", "64x48"});
}

TEST_F(Refused, Samples) {
  for (const char* samples : {"0", "-1", "65", "2.5", "many", "99999999999"})
    expectError(render({"--samples", samples}), 2, {"--samples", "expected 1 to 64"});
}

TEST_F(Refused, Aovs) {
  expectError(render({"--aov", "normal,colour"}), 2, {"colour", "expected", "distance"});
  expectError(render({"-o", "-", "--aov", "normal"}), 2, {"standard output"});
}

TEST_F(Refused, UnknownEnding) { expectError(render({"-o", folder_ / "a.bmp"}), 2, {"a.bmp", ".png", ".pfm", ".hdr"}); }

TEST_F(Refused, JsonAndImageOnStandardOutput) {
  expectError(render({"-o", "-", "--json"}), 2, {"--json", "standard output"});
}

TEST_F(Refused, OptionsOfTheOtherBackend) {
  expectError(render({"--precision", "f64"}), 2, {"--precision", "--backend cpu"});
  for (const char* option : {"--device", "--shaders"})
    expectError(render({"--backend", "cpu", option, "x"}), 2, {option, "--backend gpu"});
}

TEST_F(Refused, MissingFolderBeforeAnythingIsCast) {
  expectError(render({"-o", folder_ / "nowhere/a.png"}), 5, {"nowhere", "does not exist"});
}

TEST_F(Refused, FileAsFolderAndFolderAsFile) {
  expectError(render({"-o", scene_ + "/a.png"}), 5, {"a.png"});
  expectError(render({"-o", folder_.path()}), 2, {"expected .png"});
}

TEST_F(Refused, UnknownDevice) {
  expectError(render({"--device", "no such device", "-o", folder_ / "a.png"}), 2, {"no such device"});
  expectError(render({"--device", "99", "-o", folder_ / "a.png"}), 2, {"99"});
}

TEST_F(Refused, NoDriverIsExitThreeAndSaysWhatWasLookedFor) {
  Call what;
  what.arguments = {"render", scene_, "-o", folder_ / "a.png"};
  what.environment = {"VK_DRIVER_FILES=/nonexistent/driver.json", "VK_ICD_FILENAMES=/nonexistent/driver.json"};
  expectError(run(what), 3, {"/nonexistent/driver.json", "mesa-vulkan-drivers"});
}

TEST_F(Refused, SceneWithoutDistancesForTheSecondIntegrator) {
  expectError(render({"--integrator", "castingdist"}), 2, {"small.json", "castingdist"});
}

TEST_F(Refused, Scenes) {
  expectError(run({"render", folder_ / "none.json"}), 2, {"none.json"});
  expectError(run({"render", folder_.path()}), 2, {folder_.path()});
  expectError(run({"render", "-"}, "{\"solids\": ]}"), 2, {"1:"});
}

TEST(RenderCpu, NeedsNoVulkan) {
  Folder folder;
  writeFile(folder / "small.json", smallScene());
  Call what;
  what.arguments = {"render", folder / "small.json", "-o", folder / "a.png", "--backend", "cpu"};
  what.environment = {"VK_DRIVER_FILES=/nonexistent/driver.json", "VK_ICD_FILENAMES=/nonexistent/driver.json"};
  EXPECT_EQ(run(what).code, 0);
}

TEST(RenderCpu, EveryPrecision) {
  Folder folder;
  writeFile(folder / "small.json", smallScene());
  for (const char* precision : {"f32", "f64", "f128"}) {
    const Result result =
        run({"render", folder / "small.json", "-o", folder / "a.png", "--backend", "cpu", "--precision", precision});
    EXPECT_EQ(result.code, 0);
    EXPECT_NE(result.err.find(std::string(", ") + precision + ","), std::string::npos) << result.err;
  }
}

// Coreutils' timeout sends the signal once the picture is under way.
TEST(RenderCpu, AnInterruptLeavesNoFile) {
  const Folder folder;
  const std::string command = "timeout -s INT 1 '" SOLIDCAST_BINARY_DIR "/solidcast' render '" + bundled("a_solids") +
                              "' --backend cpu --precision f128 --size 20000x20000 -o '" + folder / "big.png" +
                              "' 2>'" + folder / "messages" + "'";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 124);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"messages"});
}

TEST(RenderCpu, FailureLeavesAnExistingFileAsItWas) {
  Folder folder;
  writeFile(folder / "a.png", "precious");
  writeFile(folder / "bad.json", "{");
  expectError(run({"render", folder / "bad.json", "-o", folder / "a.png", "--backend", "cpu"}), 2, {"bad.json"});
  EXPECT_EQ(readFile(folder / "a.png"), "precious");
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"a.png", "bad.json"}));
}

}  // namespace
}  // namespace solidcast::cli_test
