// The cost model: which plan for what, and that asking for an impossible one is refused with the numbers.
#include "host/cast/plan.h"

#include <gtest/gtest.h>

#include "host/error.h"

namespace solidcast {
namespace {

PlanFacts facts(std::uint32_t spheres, RealType real = RealType::f32) {
  PlanFacts f;
  f.program.method = real == RealType::f32 ? Method::fast : Method::exact;
  f.program.real = real;
  f.count[1] = spheres;
  f.pixels = 640 * 480;
  f.llvmpipe = true;
  f.uniformRange = 65536, f.storageRange = 1u << 27;
  return f;
}

TEST(Plan, FewSolidsAndOnePictureStayInAUniformBuffer) {
  const PlanChoice choice = choosePlan(facts(9), Plan::automatic);
  EXPECT_EQ(choice.plan, Plan::uniform);
  EXPECT_TRUE(choice.bakeLater);
}

TEST(Plan, ManyPicturesFromOnePlaceAreBakedFromTheStart) {
  PlanFacts f = facts(9);
  f.pictures = 1000;
  EXPECT_EQ(choosePlan(f, Plan::automatic).plan, Plan::baked);
  f.moving = true;  // each picture would be compiled
  const PlanChoice moving = choosePlan(f, Plan::automatic);
  EXPECT_EQ(moving.plan, Plan::uniform);
  EXPECT_FALSE(moving.bakeLater);
}

TEST(Plan, OnlyWhereItIsKnownToKeepEveryBit) {
  PlanFacts f = facts(9);
  f.pictures = 1000, f.llvmpipe = false;
  const PlanChoice choice = choosePlan(f, Plan::automatic);
  EXPECT_NE(choice.plan, Plan::baked);
  EXPECT_FALSE(choice.bakeLater);
  EXPECT_FALSE(choosePlan(facts(9, RealType::df32), Plan::automatic).bakeLater);
  EXPECT_FALSE(choosePlan(facts(65), Plan::automatic).bakeLater);
}

TEST(Plan, ManySolidsGoByListsOrTiles) {
  for (const RealType real : {RealType::f32, RealType::f64}) {
    PlanFacts f = facts(100000, real);
    EXPECT_EQ(choosePlan(f, Plan::automatic).plan, Plan::lists);
    f.program.camera = 2;  // no common eye
    EXPECT_EQ(choosePlan(f, Plan::automatic).plan, Plan::lists);
    f.program.method = Method::naive;
    EXPECT_EQ(choosePlan(f, Plan::automatic).plan, Plan::tiles);
  }
}

TEST(Plan, FewSolidsNeverGoByTiles) {
  PlanFacts f = facts(9, RealType::f64);
  for (const double pixels : {1e2, 1e6, 1e8, 1e10}) {
    f.pixels = pixels;
    EXPECT_NE(choosePlan(f, Plan::automatic).plan, Plan::tiles) << pixels;
  }
}

TEST(Plan, FreeRaysGetAnIndexWhereItPays) {
  PlanFacts f = facts(9);
  f.program.job = Job::rays;
  f.pixels = 65536;
  EXPECT_EQ(choosePlan(f, Plan::automatic).plan, Plan::uniform) << "no index for nine solids";
  for (const std::uint32_t n : {1000u, 100000u, 1000000u}) {
    f.count[1] = n;
    EXPECT_EQ(choosePlan(f, Plan::automatic).plan, Plan::index);
  }
  for (const Plan plan : {Plan::baked, Plan::tiles, Plan::lists}) EXPECT_THROW(choosePlan(f, plan), Error);
  EXPECT_THROW(choosePlan(facts(1000), Plan::index), Error) << "pictures have none";
}

TEST(Plan, WhatWasAskedForIsDoneOrRefusedWithTheNumbers) {
  for (const Plan plan : {Plan::baked, Plan::uniform, Plan::storage}) EXPECT_EQ(choosePlan(facts(9), plan).plan, plan);
  try {
    choosePlan(facts(100000), Plan::uniform);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Exit::usage);
    EXPECT_NE(std::string(error.what()).find("3200000 bytes of records, at most 65536 fit"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(choosePlan(facts(65), Plan::baked), Error);
}

TEST(Plan, NamesGoBothWays) {
  for (const std::string& name : planNames()) EXPECT_EQ(planName(planByName(name)), name);
  EXPECT_THROW(planByName("fastest"), Error);
}

TEST(Plan, LinesNameTheChoiceFirstAndEveryOther) {
  const PlanFacts f = facts(9);
  const auto lines = planLines(f, choosePlan(f, Plan::automatic), Plan::automatic);
  EXPECT_EQ(lines.front().rfind("chosen: uniform", 0), 0u) << lines.front();
  EXPECT_GE(lines.size(), planNames().size() - 1);
}

}  // namespace
}  // namespace solidcast
