// `solidcast watch` as people use it: saves of all kinds, mistakes, the end.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "tests/cli/program.h"
#include "tests/watch/child.h"
#include "tests/watch/saves.h"

namespace solidcast::watch_test {
namespace {

using namespace cli_test;

TEST(Watch, AHundredSaves) {
  gpu::Device device({.select = "llvmpipe"});
  Saves saves(device, 64, 48);
  const SaveReport report = saves.run(100);
  EXPECT_EQ(report.failures, std::vector<std::string>{});
  EXPECT_EQ(report.broken, 20);
  EXPECT_EQ(report.included, 20);
  EXPECT_EQ(report.good, 80);
  EXPECT_LT(report.kilobytesLate, report.kilobytesEarly + 8192);
  EXPECT_EQ(saves.end(), 0);
}

class AtASphere : public ::testing::Test {
 protected:
  AtASphere() { writeFile(folder / "ball.json", smallScene()); }
  void start(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"watch", "ball.json"};
    words.insert(words.end(), more.begin(), more.end());
    watch = std::make_unique<Child>(words, folder.path());
  }
  Folder folder;
  std::unique_ptr<Child> watch;
};

TEST_F(AtASphere, ANumberMakesNoPipeline) {
  start();
  EXPECT_NE(watch->waitFor("ball.png (1)").find("pipelines made: 1"), std::string::npos) << watch->said();
  std::string scene = smallScene();
  scene.replace(scene.find("[0, 0, 5]"), 9, "[0, 0, 6]");
  writeFile(folder / "ball.json", scene);
  EXPECT_NE(watch->waitFor("ball.png (2)").find("pipelines made: 0"), std::string::npos) << watch->said();
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"ball.json", "ball.png"}));
  watch->signal(SIGTERM);
  EXPECT_EQ(watch->end(), 0);
}

TEST_F(AtASphere, ErrorsStandWithTheirLine) {
  start();
  ASSERT_FALSE(watch->waitFor("ball.png (1)").empty());
  std::string scene = smallScene();
  scene.replace(scene.find("\"radius\": 1"), 11, "\"radius\": 0");
  writeFile(folder / "ball.json", scene);
  EXPECT_EQ(watch->waitFor("error"),
            "ball.json:4: error: /solids/0/radius: 0 is not positive, expected a number above 0");
  EXPECT_EQ(watch->waitFor("|").rfind("  4 |  \"solids\": [{\"type\"", 0), 0u) << watch->said();
}

TEST_F(AtASphere, BeginsWithABrokenSceneAndWaits) {
  writeFile(folder / "ball.json", "{");
  start({"-o", "out.pfm"});
  EXPECT_EQ(watch->waitFor("error").rfind("ball.json:1:", 0), 0u) << watch->said();
  writeFile(folder / "ball.json", smallScene());
  EXPECT_FALSE(watch->waitFor("out.pfm (1)").empty()) << watch->said();
  EXPECT_TRUE(std::filesystem::exists(folder / "out.pfm"));
}

TEST_F(AtASphere, AMeshOfTheSceneIsWatched) {
  std::string scene = smallScene();
  scene.replace(scene.rfind("]"), 1, R"(, {"type": "mesh", "file": "m.obj"}])");
  writeFile(folder / "ball.json", scene);
  start();
  EXPECT_NE(watch->waitFor("error").find("m.obj"), std::string::npos) << watch->said();
  writeFile(folder / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_FALSE(watch->waitFor("ball.png (1)").empty()) << watch->said();
  writeFile(folder / "m.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  EXPECT_FALSE(watch->waitFor("ball.png (2)").empty()) << watch->said();
}

TEST_F(AtASphere, LastGoodShadersShowTheScene) {
  std::filesystem::copy(SOLIDCAST_SOURCE_DIR "/shaders", folder / "s", std::filesystem::copy_options::recursive);
  start({"--shaders", "s"});
  ASSERT_FALSE(watch->waitFor("ball.png (1)").empty()) << watch->said();
  const std::string good = readFile(folder / "s/solids/sphere.glsl");
  writeFile(folder / "s/solids/sphere.glsl", good + "oops\n");
  EXPECT_EQ(watch->waitFor("error").rfind("s/solids/sphere.glsl:", 0), 0u) << watch->said();
  const std::string before = readFile(folder / "ball.png");
  std::string scene = smallScene();
  scene.replace(scene.find("\"radius\": 1"), 11, "\"radius\": 2");
  writeFile(folder / "ball.json", scene);
  EXPECT_FALSE(watch->waitFor("ball.png (2)").empty()) << watch->said();
  EXPECT_NE(readFile(folder / "ball.png"), before);
  EXPECT_FALSE(watch->waitFor("error").empty()) << watch->said();
  writeFile(folder / "s/solids/sphere.glsl", good);
  EXPECT_NE(watch->waitFor("ball.png (3)").find("pipelines made: 1"), std::string::npos) << watch->said();
}

TEST_F(AtASphere, WhatNoEditCanMendEndsItAtOnce) {
  const std::string scene = folder / "ball.json";
  expectError(run({"watch", folder / "none.json"}), 2, {"none.json", "no such file"});
  expectError(run({"watch", "-"}), 2, {"standard input"});
  expectError(run({"watch", scene, "--precision", "f32"}), 2, {"--precision", "--serve"});
  expectError(run({"watch", scene, "-o", "-"}), 2, {"standard output"});
  expectError(run({"watch", scene, "-o", "x.jpeg"}), 2, {"x.jpeg", ".png"});
  expectError(run({"watch", scene, "--shaders", folder / "none"}), 2, {"--shaders", "none"});
  expectError(run({"watch", scene, "-o", folder / "none/x.png"}), 5, {"none/x.png"}, false);
}

TEST(HttpModule, IsLoadedForAPageAlone) {
  Call asked;
  asked.arguments = {"--version"};
  asked.environment = {"LD_TRACE_LOADED_OBJECTS=1"};  // the dynamic linker tells what it would load
  const std::string loaded = run(asked).out;
  EXPECT_NE(loaded.find("libstdc++"), std::string::npos) << loaded;
  EXPECT_EQ(loaded.find("httplib"), std::string::npos) << loaded;
  EXPECT_EQ(loaded.find("libssl"), std::string::npos) << loaded;
}

TEST(HttpModule, ThatCannotBeLoadedIsAnError) {
  const Folder folder;
  writeFile(folder / "ball.json", smallScene());
  writeFile(folder / "solidcast_http.so", "no library");
  Call call;
  call.arguments = {"watch", folder / "ball.json", "--serve", "0"};
  call.environment = {"LD_LIBRARY_PATH=" + folder.path()};
  expectError(run(call), 2, {"--serve", "solidcast_http.so", "expected"}, false);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"ball.json", "solidcast_http.so"}));
}

}  // namespace
}  // namespace solidcast::watch_test
