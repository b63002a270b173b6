// A caster that is moved from scene to scene makes what a fresh one makes, whatever the plan, and keeps its pipeline
// where only numbers changed.
#include "host/scene/camera_path.h"
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

class Moving : public OnDevice, public testing::WithParamInterface<Method> {};
INSTANTIATE_TEST_SUITE_P(, Moving, testing::ValuesIn(kMethods),
                         [](const auto& info) { return std::string(nameOf(info.param)); });

Band whole(ImageCaster& caster) {
  Band all;
  caster.render([&](Band& band) { all = std::move(band); });
  return all;
}

RenderJob smallJob() {
  RenderJob job;
  job.width = 101, job.height = 75;
  job.channels = {.rgb8 = true, .distance = true, .solid = true};
  return job;
}

TEST_P(Moving, PicturesAreThoseOfAFreshCaster) {
  for (const std::string name : {"a_solids.json", "solids/sphere.json", "environment.json", "orthographic.json"}) {
    const Scene scene = loaded(name);
    const RenderJob job = smallJob();
    for (const Plan plan : {Plan::automatic, Plan::baked, Plan::tiles, Plan::lists}) {
      if (plan == Plan::baked && scene.world.solids.size() > 1) continue;  // compiled six times: one solid says as much
      if (plan == Plan::lists && (GetParam() == Method::naive || name == "orthographic.json")) continue;  // no one eye
      const CastOptions options{.method = GetParam(), .plan = plan};
      ImageCaster moved(device(), scene, job, options);
      whole(moved);
      Scene turned = scene;
      for (const double angle : {20.0, 140.0}) {
        turned.camera = orbited(scene.camera, pointLookedAt(scene), angle);
        moved.setScene(turned);
        ImageCaster fresh(device(), turned, job, options);
        expectSame(whole(moved), whole(fresh), name);
      }
    }
  }
}

TEST_P(Moving, OtherSolidsAskForAnotherPipelineAndGetIt) {
  const Scene scene = loaded("a_solids.json");
  Scene fewer = scene, none = scene;
  fewer.world = loaded("solids/sphere.json").world;
  none.world = World{};
  const RenderJob job = smallJob();
  ImageCaster moved(device(), scene, job, {.method = GetParam()});
  whole(moved);
  for (const Scene* next : std::initializer_list<const Scene*>{&fewer, &none, &scene}) {
    moved.setScene(*next);
    ImageCaster fresh(device(), *next, job, {.method = GetParam()});
    expectSame(whole(moved), whole(fresh));
  }
}

TEST_P(Moving, ACameraThatMovesCompilesNothing) {
  const Scene scene = loaded("a_solids.json");
  const RenderJob job = smallJob();
  ImageCaster caster(device(), scene, job, {.method = GetParam(), .pictures = 100, .moving = true});
  EXPECT_EQ(caster.stats().planName, "uniform");
  whole(caster);
  const int pipelines = caster.stats().pipelines;
  EXPECT_EQ(pipelines, 1);
  Scene turned = scene;
  for (int i = 1; i < 100; ++i) {
    turned.camera = orbited(scene.camera, pointLookedAt(scene), 3.6 * i);
    caster.setScene(turned);
    whole(caster);
  }
  EXPECT_EQ(caster.stats().pipelines, pipelines);
}

}  // namespace
}  // namespace solidcast
