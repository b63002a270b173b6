// The parts of a study that need no device: counting errors, the front, sweeps, cells of the table.
#include <gtest/gtest.h>

#include <cmath>

#include "host/study/errors.h"
#include "host/study/page_parts.h"
#include "host/study/plot.h"
#include "host/study/sweeps.h"

namespace solidcast::study {
namespace {

TEST(ErrorSum, CountsEveryKindOfFailure) {
  ErrorSum sum;
  sum.add(0, 2, {0, 2, 100});                         // right
  sum.add(0, std::nextafter(2.f, 3.f), {0, 2, 100});  // 1 ulp
  sum.add(0, NAN, {0, 2, 100});                       // right solid, t no number
  sum.add(-1, 0, {0, 2, 0});
  sum.add(-1, 0, {0, 2, kNearUlps});         // missed, near an edge
  sum.add(0, 2, {-1, 0, kNearUlps * 1.01});  // false hit, beyond
  sum.add(1, 2, {0, 2, 1e6});                // another solid
  sum.add(-1, 0, {-1, 0, 1e6});              // rightly missed
  const Errors e = sum.result();
  EXPECT_EQ(e.rays, 8u);
  EXPECT_EQ(e.agreedHits, 3u);
  EXPECT_EQ(e.misses, 2u);
  EXPECT_EQ(e.falseHits, 1u);
  EXPECT_EQ(e.otherSolid, 1u);
  EXPECT_EQ(e.notFinite, 1u);
  EXPECT_EQ(e.wrongNear, 2u);
  EXPECT_EQ(e.wrongBeyond, 2u);
  EXPECT_EQ(e.worstMargin, 1e6);
  EXPECT_EQ(e.p50, 1);
  EXPECT_TRUE(std::isinf(e.max));
  EXPECT_TRUE(fails(e));
  EXPECT_TRUE(std::isinf(worst(e)));
}

TEST(ErrorSum, QuantilesAreOfTheHitsAlone) {
  ErrorSum sum;
  float t = 1;
  for (int i = 0; i <= 1000; ++i, t = std::nextafter(t, 2.f)) sum.add(0, t, {0, 1, 1e9});
  for (int i = 0; i < 5000; ++i) sum.add(-1, 0, {-1, 0, 1e9});
  const Errors e = sum.result();
  EXPECT_EQ(e.p50, 500);
  EXPECT_EQ(e.p99, 990);
  EXPECT_EQ(e.p999, 999);
  EXPECT_EQ(e.max, 1000);
  EXPECT_FALSE(fails(e));
  EXPECT_TRUE(std::isnan(ErrorSum().result().max));
}

Row rowOf(std::size_t way, double most, double ns, std::uint64_t wrongBeyond = 0) {
  Row row;
  row.way = way;
  row.errors.rays = 10;
  row.errors.agreedHits = 5;
  row.errors.p50 = row.errors.p99 = row.errors.p999 = row.errors.max = most;
  row.errors.wrongBeyond = row.errors.misses = wrongBeyond;
  row.timing.runs = 20;
  row.timing.median = row.timing.quarter = row.timing.threeQuarters = row.timing.least = ns;
  return row;
}

TEST(ParetoFront, HoldsWhatNothingBeats) {
  const Row naive = rowOf(0, 1000, 30), fast = rowOf(1, 100, 20), exact = rowOf(2, 0.5, 25), slow = rowOf(3, 0.5, 90);
  const auto front = paretoFront({&naive, &fast, &exact, &slow});
  EXPECT_EQ(front, (std::vector<const Row*>{&exact, &fast}));
}

TEST(ParetoFront, AWrongDecisionCountsAsUnbounded) {
  const Row wrong = rowOf(1, 0.5, 20, 1), exact = rowOf(2, 0.5, 25);
  EXPECT_EQ(paretoFront({&wrong, &exact}), (std::vector<const Row*>{&exact, &wrong}));
  const Row slower = rowOf(1, 0.5, 30, 1);
  EXPECT_EQ(paretoFront({&slower, &exact}), (std::vector<const Row*>{&exact}));
}

TEST(Plots, TheMarkTellsTheMisclassification) {
  Row row = rowOf(0, 10, 30);
  const auto draw = [&] { return workPrecision({&row}, "a <b>", {10, 100}); };
  EXPECT_NE(draw().find("class=\"mark\" cx"), std::string::npos);
  EXPECT_NE(draw().find("a &lt;b&gt;"), std::string::npos);
  row.errors.wrongNear = row.errors.misses = 1;
  EXPECT_NE(draw().find("class=\"mark\" d=\"M"), std::string::npos);
  row.errors.wrongBeyond = 1, row.errors.misses = 2;
  EXPECT_NE(draw().find("class=\"cross\""), std::string::npos);
}

TEST(Sweeps, GrowHarderForNaiveAlone) {
  for (const oracle::Kind kind : oracle::kKinds) {
    ASSERT_FALSE(sweepsOf(kind).empty()) << oracle::nameOf(kind);
    for (const Sweep& sweep : sweepsOf(kind)) {
      EXPECT_GE(sweep.values.size(), 6u) << sweep.id;
      EXPECT_EQ(sweep.values.front() > sweep.values.back(), sweep.smallerIsHarder) << sweep.id;
      const auto batches = makeSweep(sweep, sweep.values.back(), 30, 1, 10);
      ASSERT_EQ(batches.size(), 3u);
      std::size_t rays = 0;
      for (const oracle::Batch& batch : batches) {
        rays += batch.rays.size();
        EXPECT_EQ(batch.shape.index(), batches[0].shape.index());
      }
      EXPECT_EQ(rays, 30u);
      // The same for the same seed, another for another.
      EXPECT_EQ(makeSweep(sweep, sweep.values.back(), 30, 1, 10)[2].rays[9].direction, batches[2].rays[9].direction);
      EXPECT_NE(makeSweep(sweep, sweep.values.back(), 30, 2, 10)[2].rays[9].direction, batches[2].rays[9].direction);
      // Rays must be of use: some hit, at every difficulty.
      for (const double value : sweep.values) {
        std::size_t hits = 0;
        for (const oracle::Batch& batch : makeSweep(sweep, value, 200, 3, 20)) {
          World world;
          world.groups[0].members.push_back({false, 0});
          world.solids.push_back({"", batch.shape, 0});
          for (const Verdict& v : judge(world, batch.rays)) hits += v.index >= 0;
        }
        EXPECT_GT(hits, 20u) << sweep.id << " " << value;
      }
    }
  }
}

TEST(Cells, AreQuotedWhereTheyMustBe) {
  Study study;
  Row row = rowOf(0, INFINITY, 1);
  row.family = "a,\"b\"";
  study.rows.push_back(row);
  const std::string csv = toCsv(study);
  EXPECT_NE(csv.find("\"a,\"\"b\"\"\""), std::string::npos);
  EXPECT_NE(csv.find(",inf,"), std::string::npos);
  EXPECT_NE(toJson(study).find("\"t_ulp_max\": \"inf\""), std::string::npos);
}

TEST(Parts, Base64) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("M"), "TQ==");
  EXPECT_EQ(base64("Ma"), "TWE=");
  EXPECT_EQ(base64("Man"), "TWFu");
  EXPECT_EQ(base64("\xff\xfe\xfd\xfc"), "//79/A==");
  EXPECT_EQ(grouped(1234567), "1,234,567");
  EXPECT_EQ(grouped(12), "12");
}

TEST(Parts, EveryFamilyIsExplained) {
  for (const oracle::Kind kind : oracle::kKinds) {
    for (const std::string& family : oracle::familiesOf(kind))
      EXPECT_NE(familyNote(Section::rays, family), "") << family;
    for (const std::string& family : oracle::imageFamiliesOf(kind))
      EXPECT_NE(familyNote(Section::pixels, family), "") << family;
  }
}

}  // namespace
}  // namespace solidcast::study
