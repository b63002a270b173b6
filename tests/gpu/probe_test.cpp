// The arithmetic that exact methods rest on, as lavapipe is known to do it.
#include "host/carried/probe.h"

#include "tests/gpu/fixture.h"

namespace solidcast::gpu {
namespace {

class ProbeTest : public OnLavapipe, public testing::WithParamInterface<bool> {};

TEST_P(ProbeTest, LavapipeRoundsCorrectlyAndNeverFuses) {
  const ArithmeticReport report = probeArithmetic(device(), GetParam());
  EXPECT_GE(report.cases, 65536);
  EXPECT_EQ(report.fma, "not fused");
  EXPECT_EQ(report.divisionUlp, 0);
  EXPECT_EQ(report.rootUlp, 0);
  EXPECT_EQ(report.sumUlp, 0);
  EXPECT_EQ(report.productUlp, 0);
  EXPECT_TRUE(report.exactOperations());
  EXPECT_TRUE(report.denormalInputs);
  EXPECT_TRUE(report.denormalResults);
  EXPECT_TRUE(report.uncontracted);
  EXPECT_TRUE(report.precise);
  EXPECT_TRUE(report.twoSum);
  EXPECT_TRUE(report.twoProduct);
}
INSTANTIATE_TEST_SUITE_P(Types, ProbeTest, testing::Bool(),
                         [](const auto& info) { return info.param ? "float64" : "float32"; });

}  // namespace
}  // namespace solidcast::gpu
