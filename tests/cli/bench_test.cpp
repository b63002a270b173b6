// `bench` as a program: what its report and its JSON hold, and what it refuses.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace solidcast::cli_test {
namespace {

TEST(Bench, JsonHasARowForEverySceneAndMethod) {
  const Result result = run(
      {"bench", "a_solids", "random:sphere:50:7", "--size", "64x48", "--runs", "2", "--against", "simd,cpu", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto rows = nlohmann::json::parse(result.out);
  ASSERT_EQ(rows.size(), 10u);  // fast, exact, both hand-written ones and the reference
  const auto method = [&](std::size_t i) { return rows[i]["method"].get<std::string>(); };
  EXPECT_EQ(method(0), "fast");
  EXPECT_EQ(method(1), "exact");
  EXPECT_EQ(method(4), "cpu f64");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    EXPECT_EQ(row["scene"], i < 5 ? "a_solids" : "random:sphere:50:7");
    EXPECT_EQ(row["width"], 64);
    EXPECT_EQ(row["height"], 48);
    EXPECT_EQ(row["solids"], i < 5 ? 9 : 50);
    EXPECT_EQ(row["rounds"], 2);
    EXPECT_FALSE(row["plan"].get<std::string>().empty());
    const double median = row["dispatch_ms_median"];
    EXPECT_GT(row["dispatch_ms_min"], 0);
    EXPECT_LE(row["dispatch_ms_min"], median);
    EXPECT_GE(row["dispatch_ms_max"], median);
    EXPECT_NEAR(row["mrays_per_s"].get<double>(), 64 * 48 / median / 1e3, 0.01 * 64 * 48 / median / 1e3);
    EXPECT_GT(row["image_ms_median"], 0);
    EXPECT_EQ(row.contains("device"), i % 5 < 2);
    EXPECT_LE(row["pixels_off"], 10);
  }
  for (const char* phase : {"flatten_ms", "shader_ms", "first_dispatch_ms", "dispatch_ms", "readback_ms"})
    EXPECT_TRUE(rows[0]["first_image_phases"][phase].is_number()) << phase;
}

TEST(Bench, TheReportIsMarkdownOnStandardOutput) {
  const Result result = run({"bench", bundled("a_solids"), "--size", "64x48", "--runs", "1", "--method", "naive",
                             "--against", "cpu", "--precision", "f32"});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* part : {"Machine: ", "Device: ", "Driver: ", "9 solids, 64x48, 1 round\n", "| naive ", "| cpu f32 ",
                           "| naive : cpu f32 |", "| first image, ms |"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part << "\n" << result.out;
}

TEST(Bench, LeftOutIsATableOfItsOwn) {
  const Result result = run({"bench", "quadrics", "--left-out", "--size", "64x48", "--runs", "1"});
  ASSERT_EQ(result.code, 0) << result.err;
  for (const char* row : {"| nothing ", "| kinds that the scene lacks", "| the other integrator", "| channel: normal ",
                          "| records in a uniform buffer", "| decisions watched"})
    EXPECT_NE(result.out.find(row), std::string::npos) << row << "\n" << result.out;
  expectError(run({"bench", "quadrics", "--left-out", "--json"}), 2, {"--left-out", "--json"});
}

TEST(Bench, RefusesInOneLine) {
  expectError(run({"bench", "a_solids", "--against", "povvray"}), 2, {"--against", "\"povvray\"", "embree"});
  expectError(run({"bench", "random:sphere"}), 2, {"random:sphere", "expected random:KIND:COUNT[:SEED]"});
  expectError(run({"bench", "random:sphere:10:x"}), 2, {"random:KIND:COUNT[:SEED]"});
  expectError(run({"bench", "random:sphere:99999999"}), 2, {"10000000"});
  expectError(run({"bench", "random:cube:10"}), 2, {"cube", "sphere"});
  expectError(run({"bench", "no_such_scene"}), 2, {"no_such_scene"});
  expectError(run({"bench", "orthographic", "--against", "simd"}), 2, {"orthographic", "perspective"});
  expectError(run({"bench", "a_solids", "--size", "64"}), 2, {"--size", "\"64\"", "WIDTHxHEIGHT"});
}

}  // namespace
}  // namespace solidcast::cli_test
