// The catalogue's file is what its generator makes, reads back to the same cases, and keeps its own promises.
#include <gtest/gtest.h>
#include <quadmath.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "host/catalogue/catalogue.h"
#include "host/error.h"
#include "host/oracle/families.h"
#include "host/oracle/oracle.h"
#include "host/scene/load.h"
#include "tests/catalogue/cases.h"

namespace solidcast::catalogue {
namespace {

const Catalogue& fromFile() {
  static const Catalogue catalogue = readCatalogue(SOLIDCAST_CATALOGUE);
  return catalogue;
}

const RayCase& rayCase(const std::string& id) {
  for (const RayCase& c : fromFile().rays) {
    if (c.id == id) return c;
  }
  throw std::runtime_error("no case " + id);
}

TEST(Catalogue, FileIsWhatTheGeneratorMakes) {
  Catalogue catalogue = allCases();
  fillTruth(catalogue);
  const std::string expected = writeCatalogue(catalogue);
  std::ifstream in(SOLIDCAST_CATALOGUE);
  std::stringstream text;
  text << in.rdbuf();
  std::istringstream wanted(expected), found(text.str());
  std::string a, b;
  for (int line = 1; std::getline(wanted, a); ++line) {
    ASSERT_TRUE(std::getline(found, b)) << "ends at line " << line;
    ASSERT_EQ(b, a) << "line " << line << ": run generate_catalogue";
  }
  EXPECT_FALSE(std::getline(found, b));
}

TEST(Catalogue, ReadsBackWhatWasWritten) {
  EXPECT_EQ(writeCatalogue(fromFile()), [] {
    std::ifstream in(SOLIDCAST_CATALOGUE);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }());
  EXPECT_THROW(readCatalogue("there/is/no/such.json"), std::runtime_error);
}

TEST(Catalogue, HasEveryCaseOnce) {
  const Catalogue& all = fromFile();
  std::set<std::string> ids;
  const auto see = [&ids](const auto& cases) {
    for (const auto& c : cases) EXPECT_TRUE(ids.insert(c.id).second) << c.id << " twice";
  };
  see(all.rays), see(all.images), see(all.rejects), see(all.families);
  EXPECT_GE(ids.size(), 146u);
  const std::map<char, int> counts{{'S', 27}, {'P', 12}, {'B', 21}, {'D', 9}, {'Q', 12},
                                   {'T', 22}, {'K', 33}, {'R', 4},  {'C', 6}};
  for (const auto& [letter, count] : counts) {
    for (int i = 1; i <= count; ++i) EXPECT_EQ(ids.count(letter + std::to_string(i)), 1u) << letter << i;
  }
}

TEST(Catalogue, TruthsThatWereKnownBefore) {
  const std::map<std::string, double> known{{"S1", 999999},
                                            {"S2", 9999.56402913},
                                            {"S4", .999999133974},
                                            {"S5", 1},
                                            {"S7", 5857.86458659},
                                            {"S10", 4.99965473},
                                            {"S13", 3.97364e-8},
                                            {"S17", 2e20},
                                            {"P1", 9999999.88},
                                            {"P6", 1.76291615849},
                                            {"P9", 1e30},
                                            {"B7", 3.4641017},
                                            {"B10", 5.03711238},
                                            {"B16", 500000014},
                                            {"K8", 5.31507298},
                                            {"K15", 8.6875},
                                            {"K16", 8.6874},
                                            {"K22", 4.999999},
                                            {"K29", 4},
                                            {"S25", 4},
                                            {"B1", 4},
                                            {"B3", 4},
                                            {"B14", 2},
                                            {"S12", 2},
                                            {"K12", 5}};
  for (const auto& [id, t] : known) {
    const RayCase& c = rayCase(id);
    EXPECT_TRUE(c.truth.hit) << id;
    EXPECT_NEAR(static_cast<double>(c.truth.t) / t, 1, 1e-5) << id;
  }
  for (const char* id : {"S3", "S6", "S9",  "S11", "S15", "P2", "P3", "P4",  "B6",  "B13", "B15", "B18", "D3", "D4",
                         "D9", "T5", "T14", "T16", "K2",  "K4", "K6", "K13", "K19", "K20", "K21", "K24", "R3", "R3d"}) {
    EXPECT_FALSE(rayCase(id).truth.hit) << id;
  }
}

TEST(Catalogue, TruthsWrittenToThirtyDigitsAreTheOraclesAgain) {
  for (const RayCase& c : fromFile().rays) {
    const oracle::WorldTruth truth = oracle::cast(worldOf(c.solids), oracle::exactRay(c.ray));
    ASSERT_EQ(truth.index, c.truth.index) << c.id;
    if (!c.truth.hit) continue;
    EXPECT_LE(static_cast<double>(fabsq(truth.truth.t / c.truth.t - 1)), 0x1p-47) << c.id;
    Real length = 0;
    for (const Real x : c.truth.normal) length += x * x;
    EXPECT_LE(static_cast<double>(fabsq(length - 1)), 1e-28) << c.id;
    EXPECT_EQ(c.exact.decision == Allowed::miss, oracle::beyondFloat(c.truth.t)) << c.id;
  }
}

TEST(Catalogue, WhatIsNotRefusedIsAValidScene) {
  std::vector<std::string> warnings;
  for (const RayCase& c : fromFile().rays) {
    Scene scene;
    scene.world = worldOf(c.solids);
    EXPECT_NO_THROW(checkScene(scene, warnings)) << c.id;
  }
  for (const ImageCase& c : fromFile().images) EXPECT_NO_THROW(checkScene(c.scene, warnings)) << c.id;
}

TEST(Catalogue, RefusedScenesAreRefusedInOneLine) {
  std::vector<std::string> warnings;
  int scenes = 0;
  for (const RejectCase& c : fromFile().rejects) {
    if (c.isRay) continue;
    ++scenes;
    try {
      checkScene(c.scene, warnings);
      ADD_FAILURE() << c.id << " was accepted: " << c.note;
    } catch (const Error& error) {
      const std::string line = error.what();
      EXPECT_EQ(error.code(), Exit::usage) << c.id;
      EXPECT_NE(line.find(c.about), std::string::npos) << c.id << ": " << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << c.id;
    }
  }
  EXPECT_GE(scenes, 14);
}

TEST(Catalogue, FamiliesExist) {
  for (const FamilyCase& c : fromFile().families) {
    if (c.kind == "mesh") {
      EXPECT_TRUE(c.family == "edges" || c.family == "vertices") << c.id;
      continue;
    }
    bool found = false;
    for (const oracle::Kind kind : oracle::kKinds) {
      if (c.kind != oracle::nameOf(kind)) continue;
      found = true;
      EXPECT_EQ(oracle::makeBatches(kind, c.family, 3, c.seed).size(), 3u) << c.id;
    }
    EXPECT_TRUE(found) << c.id;
  }
}

}  // namespace
}  // namespace solidcast::catalogue
