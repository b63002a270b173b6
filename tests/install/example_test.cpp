// examples/glsl-test, copied out of the tree, finds an installed solidcast, builds and passes; and each of its tests goes
// red when the function it tests is broken.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/install/shell.h"

namespace solidcast::install_test {
namespace {

namespace fs = std::filesystem;

const std::string softTest = "SoftTest.IsWithinFourUlp", ballTest = "BallTest.IsMetAtTheDistanceOfGeometry";

struct Broken {
  std::string file, right, wrong;
  std::vector<std::string> explanation;  // parts of what must be said
};
const Broken broken[] = {{"soft.glsl", "2.0 * t", "1.9999 * t", {"by more than 4 ulp", "x = 0x"}},
                         {"soft.glsl", "x - low", "x - lo", {"soft.glsl:3: error: "}},
                         {"soft.glsl", "float soft(", "float stiff(", {"no function `float soft(float low, "}},
                         {"ball.glsl", "1.0 / best.s", "1.000001 / best.s", {"by more than 8 ulp", "origin = (-0x"}}};

/// Expects `name` to be told as `verdict` in ctest's list: "Passed", "***Failed", "***Skipped".
void expectVerdict(const Result& result, const std::string& name, const std::string& verdict) {
  const std::size_t at = result.output.find(": " + name + " .");
  ASSERT_NE(at, std::string::npos) << name << " was not run:\n" << result.output;
  const std::string line = result.output.substr(at, result.output.find('\n', at) - at);
  EXPECT_NE(line.find(verdict), std::string::npos) << line << "\n" << result.output;
}

TEST(ExampleTest, PassesAgainstTheInstallAndGoesRedWhenBroken) {
  const Folder folder;
  Result result = shell(CMAKE_PROGRAM " --install " + quoted(SOLIDCAST_BINARY_DIR) +
                        " --component development --prefix " + quoted(folder / "installed"));
  ASSERT_EQ(result.code, 0) << result.output;
  fs::rename(folder / "installed", folder / "moved");  // an install can be moved
  fs::copy(fs::path(SOLIDCAST_SOURCE_DIR) / "examples/glsl-test", folder / "example", fs::copy_options::recursive);

  const std::string build = quoted(folder / "build");
  result = shell(CMAKE_PROGRAM " -S " + quoted(folder / "example") + " -B " + build +
                 " -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=" + quoted(CXX_PROGRAM) + " -DCMAKE_PREFIX_PATH=" +
                 quoted(folder / "moved") + " && " CMAKE_PROGRAM " --build " + build + " --parallel 2");
  ASSERT_EQ(result.code, 0) << result.output;

  const std::string test = CTEST_PROGRAM " --output-on-failure --no-tests=error --test-dir " + build;
  result = shell(test);
  EXPECT_EQ(result.code, 0) << result.output;
  expectVerdict(result, softTest, "Passed");
  expectVerdict(result, ballTest, "Passed");

  for (const Broken& now : broken) {  // GLSL is read when the test runs: nothing is built again
    const fs::path file = folder / ("example/glsl/" + now.file);
    const std::string good = readFile(file);
    const std::size_t at = good.find(now.right);
    ASSERT_NE(at, std::string::npos) << now.right;
    writeFile(file, std::string(good).replace(at, now.right.size(), now.wrong));
    result = shell(test);
    EXPECT_NE(result.code, 0) << now.wrong;
    expectVerdict(result, now.file == "soft.glsl" ? softTest : ballTest, "***Failed");
    expectVerdict(result, now.file == "soft.glsl" ? ballTest : softTest, "Passed");
    for (const std::string& part : now.explanation) {
      EXPECT_NE(result.output.find(part), std::string::npos) << part << " is not in\n" << result.output;
    }
    writeFile(file, good);
  }

  // Without a device: red, unless the user says otherwise.
  const std::string noDevice = "VK_DRIVER_FILES=/nowhere VK_ICD_FILENAMES=/nowhere ";
  result = shell(noDevice + test);
  EXPECT_NE(result.code, 0);
  expectVerdict(result, softTest, "***Failed");
  EXPECT_NE(result.output.find("SOLIDCAST_NO_DEVICE=skip"), std::string::npos) << result.output;
  result = shell("SOLIDCAST_NO_DEVICE=skip " + noDevice + test);
  EXPECT_EQ(result.code, 0) << result.output;
  expectVerdict(result, softTest, "***Skipped");
}

}  // namespace
}  // namespace solidcast::install_test
