// Records baked into the pipeline: no bit of any channel may show it, and the plan says when it happens.
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

class BakingTest : public OnDevice, public testing::WithParamInterface<Method> {
 protected:
  static bool isBaked(const CastStats& stats) { return stats.planName == "baked"; }
  static Band whole(ImageCaster& caster) {
    Band all;
    caster.render([&](Band& band) {
      EXPECT_EQ(band.firstRow, 0);
      all = std::move(band);
    });
    return all;
  }
};
INSTANTIATE_TEST_SUITE_P(, BakingTest, testing::ValuesIn(kMethods),
                         [](const auto& info) { return std::string(nameOf(info.param)); });

TEST_P(BakingTest, DoesNotShow) {
  for (const std::string name : {"a_solids.json", "quadrics.json", "environment.json", "solids/box.json"}) {
    const Scene scene = loaded(name);
    RenderJob job;
    job.width = 101, job.height = 75;
    for (const bool hits : {false, true}) {
      job.channels = allChannels();
      if (!hits) job.channels.normal = job.channels.local = job.channels.position = false;
      ImageCaster plain(device(), scene, job, {.method = GetParam(), .plan = Plan::uniform});
      ImageCaster baked(device(), scene, job, {.method = GetParam(), .plan = Plan::baked});
      expectSame(whole(baked), whole(plain), name);
      EXPECT_TRUE(isBaked(baked.stats()));
      plain.dispatchOnly();
      EXPECT_FALSE(isBaked(plain.stats()));
    }
  }
}

TEST_P(BakingTest, ComesOnceDispatchesHaveCostAsMuch) {
  const Scene scene = loaded("solids/sphere.json");
  RenderJob job;
  job.width = 640, job.height = 480;
  job.channels.rgb8 = job.channels.distance = true;
  ImageCaster caster(device(), scene, job, {.method = GetParam()});
  const Band first = whole(caster);
  EXPECT_FALSE(isBaked(caster.stats()));
  int renders = 1;
  for (; renders < 2000 && !isBaked(caster.stats()); ++renders) expectSame(whole(caster), first);
  EXPECT_TRUE(isBaked(caster.stats()));
  EXPECT_GT(renders, 2);
  expectSame(whole(caster), first);
}

TEST_P(BakingTest, BenchmarksAreBakedFromTheStart) {
  const Scene scene = loaded("solids/sphere.json");
  RenderJob job;
  job.width = 64, job.height = 48;
  job.channels.rgb8 = true;
  ImageCaster caster(device(), scene, job, {.method = GetParam()});
  const bool turns = GetParam() != Method::naive;
  EXPECT_FALSE(isBaked(caster.stats()));
  EXPECT_EQ(caster.stats().modules.at(0).ends_with("_turn1"), turns);
  const std::size_t bytes = caster.stats().specialisedSpirvBytes;
  EXPECT_GT(caster.dispatchOnly(), 0);
  EXPECT_TRUE(isBaked(caster.stats()));
  EXPECT_EQ(caster.stats().modules.size(), 1u);  // what is used now, and no more
  EXPECT_TRUE(caster.stats().modules[0].ends_with("_perspective")) << caster.stats().modules[0];
  EXPECT_LT(caster.stats().specialisedSpirvBytes, 2 * bytes);
}

}  // namespace
}  // namespace solidcast
