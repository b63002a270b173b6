// `solidcast query`: rays in, JSON lines out, on both backends; streams; and every kind of unreadable ray.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace solidcast::cli_test {
namespace {

using Json = nlohmann::json;

class Query : public ::testing::TestWithParam<const char*> {
 protected:
  Query() { writeFile(scene_, smallScene()); }

  Result query(const std::string& rays, std::vector<std::string> arguments = {}) {
    arguments.insert(arguments.begin(), {"query", scene_, "--rays", "-", "--backend", GetParam()});
    return run(arguments, rays);
  }

  Folder folder_;
  std::string scene_ = folder_ / "small.json";
};

INSTANTIATE_TEST_SUITE_P(Backends, Query, ::testing::Values("cpu", "gpu"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(Query, LinesAreExactlyAsDocumented) {
  const Result result = query("0 0 5 0 0 -1\n0 5 5 0 0 -1\n");
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out,
            "{\"ray\":0,\"hit\":true,\"t\":4,\"solid\":\"ball\",\"index\":0,\"normal\":[0,0,1],\"local\":[0,0,1],"
            "\"position\":[0,0,1]}\n"
            "{\"ray\":1,\"hit\":false}\n");
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
}

TEST_P(Query, CommentsBlanksAndTabsAreNoRays) {
  const Result result = query("# rays\n\n  \t\r\n0\t0 5\t 0 0 -1 # head on\r\n#\n 0 5 5 0 0 -1");
  EXPECT_EQ(result.code, 0) << result.err;
  const auto said = lines(result.out);
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(Json::parse(said[0]).at("ray"), 0);
  EXPECT_EQ(Json::parse(said[1]), Json::parse(R"({"ray":1,"hit":false})"));
}

TEST_P(Query, NoRaysGiveNoLines) {
  for (const char* rays : {"", "# nothing\n"}) {
    const Result result = query(rays);
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.out, "");
  }
}

TEST_P(Query, DirectionOfLengthTwoHalvesT) { EXPECT_EQ(Json::parse(query("0 0 5 0 0 -2").out).at("t"), 2); }

TEST_P(Query, TmaxIsStrictAndOfTheRayBeforeTheOption) {
  EXPECT_EQ(Json::parse(query("0 0 5 0 0 -1 4").out).at("hit"), false);
  EXPECT_EQ(Json::parse(query("0 0 5 0 0 -1 0x1.000002p2").out).at("hit"), true);
  EXPECT_EQ(Json::parse(query("0 0 5 0 0 -1", {"--tmax", "3.9"}).out).at("hit"), false);
  EXPECT_EQ(Json::parse(query("0 0 5 0 0 -1 inf", {"--tmax", "3.9"}).out).at("hit"), true);
  EXPECT_EQ(Json::parse(query("0 0 5 0 0 -1 0").out).at("hit"), false);
}

TEST_P(Query, WhatFp32CannotHoldIsBeyondTheFarLimit) {
  EXPECT_EQ(query("0 0 5 0 0 -1e-37").out.substr(0, 20), "{\"ray\":0,\"hit\":true,");  // t = 4e37
  EXPECT_EQ(query("0 0 5 0 0 -1e-39").out, "{\"ray\":0,\"hit\":false}\n");             // t would be 4e39
}

TEST_P(Query, HexAndDecimalInputGiveTheSame) {
  const std::string decimal = query("0.1 -0.25 5 0 0 -1").out;
  EXPECT_EQ(query("0x1.99999ap-4 -0x1p-2 0x1.4p+2 -0x0p0 0X0 -0X1.0P0").out, decimal);
  EXPECT_EQ(query("+0.1 -.25 5. 0e9 1e-60 -10e-1").out, decimal);
}

TEST_P(Query, HexDenormalsAreRoundedCorrectly) {  // GCC 12's from_chars rounds this one up
  const std::vector<std::string> hex{"--hex"};
  const auto x = [&](const std::string& word) { return query(word + " 0 5 0 0 -1 # x", hex).out; };
  EXPECT_EQ(x("0x1.2a6289p-129"), x("0x1.2a628p-129"));
}

TEST_P(Query, HexOutputIsExact) {
  const Json hex = Json::parse(query("0.3 0.4 5 0 0 -1", {"--hex"}).out);
  const Json decimal = Json::parse(query("0.3 0.4 5 0 0 -1").out);
  const auto value = [](const Json& text) { return std::strtof(text.get<std::string>().c_str(), nullptr); };
  ASSERT_TRUE(hex.at("t").is_string());
  EXPECT_EQ(hex.at("t").get<std::string>().rfind("0x1.", 0), 0u);
  EXPECT_EQ(value(hex.at("t")), decimal.at("t").get<float>());
  for (const char* key : {"normal", "local", "position"})
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(value(hex.at(key).at(axis)), decimal.at(key).at(axis).get<float>()) << key << axis;
  EXPECT_EQ(hex.at("ray"), 0);
  EXPECT_EQ(hex.at("index"), 0);
}

TEST_P(Query, NamesAreEscaped) {
  writeFile(scene_, smallScene(R"(a \"b\" \\ \n ü)"));
  const Result result = query("0 0 5 0 0 -1");
  ASSERT_EQ(lines(result.out).size(), 1u) << result.err;
  EXPECT_EQ(Json::parse(result.out).at("solid"), "a \"b\" \\ \n ü");
}

TEST_P(Query, IndexCountsTheScenesSolids) {
  scene_ = bundled("a_solids");
  const Json hit = Json::parse(query("0 0 10 0 0 -1").out);
  EXPECT_EQ(hit.at("index"), 1);
  EXPECT_NEAR(hit.at("t").get<double>(), 7.31477, 1e-4);
}

TEST_P(Query, WritesToAFile) {
  const std::string file = folder_ / "hits.jsonl";
  const Result result = query("0 0 5 0 0 -1\n", {"-o", file});
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(readFile(file), query("0 0 5 0 0 -1\n").out);
}

/// `count` rays from (0,0,5), every second one past the sphere.
void writeRays(const std::string& path, int count) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  ASSERT_NE(file, nullptr);
  for (int i = 0; i < count; ++i) std::fprintf(file, "0 0 5 %s %.9g -1\n", i % 2 == 0 ? "0" : "3", i * 1e-7);
  ASSERT_EQ(std::fclose(file), 0);
}

TEST_P(Query, AMillionRaysStreamInOrder) {
  const int count = 1000000;
  const std::string rays = folder_ / "rays.txt", few = folder_ / "few.txt", hits = folder_ / "hits.jsonl";
  writeRays(rays, count);
  writeRays(few, 65536);
  const Result small = run({"query", scene_, "--rays", few, "--backend", GetParam(), "-o", hits});
  const Result result = run({"query", scene_, "--rays", rays, "--backend", GetParam(), "-o", hits});
  EXPECT_EQ(small.code, 0) << small.err;
  EXPECT_EQ(result.code, 0) << result.err;
#ifndef __SANITIZE_ADDRESS__  // which keeps records of its own of every thread that ever was
  // One block and fifteen blocks take the same memory, up to what an allocator leaves lying.
  EXPECT_LT(result.peakKilobytes, small.peakKilobytes + 24 * 1024);
#endif

  std::FILE* file = std::fopen(hits.c_str(), "r");
  ASSERT_NE(file, nullptr);
  char line[512];
  int ray = 0;
  for (; std::fgets(line, sizeof line, file) != nullptr; ++ray) {
    char expected[64];
    std::snprintf(expected, sizeof expected, "{\"ray\":%d,\"hit\":%s", ray, ray % 2 == 0 ? "true" : "false");
    ASSERT_EQ(std::string(line).rfind(expected, 0), 0u) << line;
  }
  std::fclose(file);
  EXPECT_EQ(ray, count);
}

TEST_P(Query, AReaderThatGoesAwayIsNoError) {
  const std::string rays = folder_ / "rays.txt";
  writeRays(rays, 300000);
  Call what;
  what.arguments = {"query", scene_, "--rays", rays, "--backend", GetParam()};
  what.closeOutputAfter = 1000;
  const Result result = run(what);
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_EQ(lines(result.err).size(), 1u) << result.err;
}

TEST_P(Query, FullDisk) {
  Call what;
  what.arguments = {"query", scene_, "--rays", "-", "--backend", GetParam()};
  what.input = "0 0 5 0 0 -1\n";
  what.outputFile = "/dev/full";
  expectError(run(what), 5, {"standard output", "No space left"}, false);
}

// --- bad rays: file:line, what, expected what; exit 2 before any device is opened -----------------

struct BadRay {
  const char* line;
  std::vector<std::string> said;
};

TEST(QueryRefuses, EveryKindOfBadRay) {
  const BadRay cases[] = {
      {"1 2 3 4 5", {"5 numbers instead of 6 or 7", "expected ox oy oz dx dy dz [tmax]"}},
      {"1", {"1 number instead"}},
      {"1 2 3 4 5 6 7 8", {"more than 7 numbers", "expected ox oy oz"}},
      {"1 2 x 4 5 6", {"oz \"x\" is no number", "expected a decimal or a hex float"}},
      {"1 2 3 4 5 6,", {"dz \"6,\""}},
      {"1,2,3,4,5,6", {"ox \"1,2,3,4,5,6\""}},
      {"1 2 3 4 5 0x", {"dz \"0x\""}},
      {"1 2 3 4 5 0x-1", {"dz \"0x-1\""}},
      {"1 2 3 4 5 --6", {"dz \"--6\""}},
      {"1 2 3 4 5 +-6", {"dz \"+-6\""}},
      {"1 2 3 4 5 6e", {"dz \"6e\""}},
      {"nan 2 3 4 5 6", {"ox is \"nan\"", "expected a finite number"}},
      {"1 2 3 -inf 5 6", {"dx is \"-inf\"", "expected a finite number"}},
      {"1 2 3 4 5 6 nan", {"tmax is \"nan\""}},
      {"1 2 3 4 5 6 -1", {"tmax is negative", "expected 0 or more"}},
      {"1 2 3 4 5 6 -inf", {"tmax is negative"}},
      {"1e39 2 3 4 5 6", {"ox \"1e39\" is beyond fp32", "3.40282347e+38"}},
      {"1 2 3 4 5 -1e400", {"dz \"-1e400\" is beyond fp32"}},
      {"1 2 3 4 5 0x1p128", {"dz \"0x1p128\" is beyond fp32"}},
      {"1 2 3 0 0 0", {"direction is zero", "expected a direction"}},
      {"1 2 3 0 -0 1e-60", {"direction is zero in fp32"}},
      {"\x01\xff 2 3 4 5 6", {"ox \"??\""}},
  };
  Folder folder;
  writeFile(folder / "small.json", smallScene());
  for (const BadRay& bad : cases) {
    writeFile(folder / "rays.txt", std::string("# first\n0 0 5 0 0 -1\n\n") + bad.line + "\n0 0 5 0 0 -1\n");
    const Result result = run({"query", folder / "small.json", "--rays", folder / "rays.txt", "-o", folder / "hits"});
    std::vector<std::string> parts = bad.said;
    parts.push_back("rays.txt:4: ");
    expectError(result, 2, parts);
    EXPECT_EQ(folder.names(), (std::vector<std::string>{"rays.txt", "small.json"}));
  }
}

TEST(QueryRefuses, EndlessLine) {
  const Result result = run({"query", bundled("a_solids"), "--rays", "-"}, "0 0 5\n" + std::string(3 << 20, '1'));
  expectError(result, 2, {"standard input:1: "});
  const Result longer = run({"query", bundled("a_solids"), "--rays", "-"}, std::string(3 << 20, ' '));
  expectError(longer, 2, {"standard input:1: ", "longer than 1048576 bytes"});
}

TEST(QueryRefuses, FilesThatAreNone) {
  Folder folder;
  expectError(run({"query", bundled("a_solids"), "--rays", folder / "none"}), 2, {"none", "No such file", "expected"});
  expectError(run({"query", bundled("a_solids"), "--rays", folder.path()}), 2, {"Is a directory", "expected"});
}

TEST(QueryRefuses, SceneAndRaysBothFromStandardInput) {
  expectError(run({"query", "-", "--rays", "-"}, "0 0 5 0 0 -1"), 2, {"--rays", "standard input"});
}

TEST(QueryRefuses, Tmax) {
  for (const char* tmax : {"nan", "tea", "1e39", ""})
    expectError(run({"query", bundled("a_solids"), "--rays", "-", "--tmax", tmax}), 2, {"--tmax", "expected"});
}

TEST(QueryRefuses, ABadRayInALaterBlockKeepsNoFile) {
  Folder folder;
  writeRays(folder / "rays.txt", 70000);
  writeFile(folder / "rays.txt", readFile(folder / "rays.txt") + "garbage\n");
  const Result result = run(
      {"query", bundled("a_solids"), "--rays", folder / "rays.txt", "--backend", "cpu", "-o", folder / "hits.jsonl"});
  expectError(result, 2, {"rays.txt:70001: "}, false);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"rays.txt"});
}

}  // namespace
}  // namespace solidcast::cli_test
