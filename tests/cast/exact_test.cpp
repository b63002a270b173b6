// Method exact against the oracle: free rays of every family, pictures of every family, meshes without cracks.
// sweep (tests/cast/sweep) does the same at any length.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

std::string nameOfFamily(const testing::TestParamInfo<oracle::Kind>& info) { return oracle::nameOf(info.param); }

class ExactRays : public OnDevice, public testing::WithParamInterface<oracle::Kind> {};
INSTANTIATE_TEST_SUITE_P(, ExactRays, testing::ValuesIn(oracle::kKinds), nameOfFamily);

TEST_P(ExactRays, OneSolid) {
  for (const std::string& family : oracle::familiesOf(GetParam())) {
    const Tally tally = measureFamily(device(), GetParam(), family, {12000, 60, 1, 1}, {});
    EXPECT_TRUE(tally.exact()) << family << ": " << text(tally);
    EXPECT_EQ(tally.rays, 12000u);
    EXPECT_GT(tally.hits, 20u) << family;
  }
}

// The nearest of several that may lie in each other.
TEST_P(ExactRays, ManySolids) {
  for (const std::string& family : oracle::familiesOf(GetParam())) {
    const Tally tally = measureFamily(device(), GetParam(), family, {2000, 25, 8, 2}, {});
    EXPECT_TRUE(tally.exact()) << family << ": " << text(tally);
  }
}

// Decisions in fp32 (no fp64 in shaders): more doubt, the same answers.
TEST_P(ExactRays, WithoutFp64) {
  for (const std::string& family : oracle::familiesOf(GetParam())) {
    const Tally tally = measureFamily(device(), GetParam(), family, {2000, 40, 1, 3}, {.arithmetic = Arithmetic::df32});
    EXPECT_TRUE(tally.exact()) << family << ": " << text(tally);
  }
}

class ExactImages : public OnDevice, public testing::WithParamInterface<oracle::Kind> {};
INSTANTIATE_TEST_SUITE_P(, ExactImages, testing::ValuesIn(oracle::kKinds), nameOfFamily);

TEST_P(ExactImages, OfEveryFamily) {
  for (const Arithmetic arithmetic : {Arithmetic::fp64, Arithmetic::df32}) {
    for (const std::string& family : oracle::imageFamiliesOf(GetParam())) {
      Tally tally;
      for (const std::uint64_t seed : {1, 2, 3, 100})  // 100: the eye on a box's face
        tally.add(
            measureImage(device(), oracle::makeImage(GetParam(), family, 61, 47, seed), {.arithmetic = arithmetic}));
      EXPECT_TRUE(tally.exact()) << (arithmetic == Arithmetic::fp64 ? "fp64 " : "df32 ") << family << ": "
                                 << text(tally);
      EXPECT_EQ(tally.rays, 4u * 61 * 47);
    }
  }
}

class Meshes : public OnDevice, public testing::WithParamInterface<bool> {};
INSTANTIATE_TEST_SUITE_P(, Meshes, testing::Bool(),
                         [](const auto& info) { return std::string(info.param ? "vertices" : "edges"); });

TEST_P(Meshes, HaveNoCracks) {
  for (const Arithmetic arithmetic : {Arithmetic::fp64, Arithmetic::df32}) {
    Tally tally;
    for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
      const oracle::CrackBatch batch = oracle::makeCracks(GetParam(), 5000, seed);
      castAndCompare(device(), batch.world, batch.rays, {.arithmetic = arithmetic}, tally);
    }
    EXPECT_EQ(tally.misses, 0u) << "a ray inside a closed mesh got out";
    EXPECT_TRUE(tally.exact()) << text(tally);
    EXPECT_GT(tally.doubtful, 0u) << "edges are where the second pass is for";
  }
}

// A device without fp64. Its driver is fetched once by tools/swiftshader; the loader reads the variable at each start.
TEST(ExactOnSwiftShader, RaysAndImages) {
  const std::string command = "'" SOLIDCAST_SOURCE_DIR "/tools/swiftshader' '" SOLIDCAST_BINARY_DIR "/swiftshader'";
  std::string icd;
  FILE* pipe = popen(command.c_str(), "r");
  ASSERT_NE(pipe, nullptr);
  for (int c; (c = std::fgetc(pipe)) != EOF && c != '\n';) icd += static_cast<char>(c);
  ASSERT_EQ(pclose(pipe), 0);
  const auto environment = [](const char* value) {
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) value ? setenv(name, value, 1) : unsetenv(name);
  };
  environment(icd.c_str());
  {
    gpu::Device device({.select = "swiftshader"});
    EXPECT_FALSE(device.info().float64);
    for (const oracle::Kind kind : oracle::kKinds) {
      for (const char* family : {"generic", "axis", "lattice", "boundary"}) {
        const Tally tally = measureFamily(device, kind, family, {1000, 40, 1, 4}, {});
        EXPECT_TRUE(tally.exact()) << oracle::nameOf(kind) << " " << family << ": " << text(tally);
      }
      for (const char* family : {"perspective", "narrow", "orthographic", "environment"}) {
        const Tally tally = measureImage(device, oracle::makeImage(kind, family, 61, 47, 5), {});
        EXPECT_TRUE(tally.exact()) << oracle::nameOf(kind) << " " << family << ": " << text(tally);
      }
    }
  }
  environment(nullptr);
}

}  // namespace
}  // namespace solidcast
