// Plan lists: a solid that is missing from a tile's list would leave the picture without a trace, so every picture is
// held against the plan that tries all solids on all pixels.
#include <cmath>

#include "host/cast/plan.h"
#include "host/error.h"
#include "host/scene/build.h"
#include "host/scene/random.h"
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

class Lists : public OnDevice {
 protected:
  static RenderJob small() {
    RenderJob job;
    job.width = 203, job.height = 151;
    job.crop = {10, 20, 151, 101};
    job.channels.rgb8 = job.channels.radiance = job.channels.distance = job.channels.solid = true;
    return job;
  }
  static Band picture(const Scene& scene, const RenderJob& job, const CastOptions& options,
                      CastStats* stats = nullptr) {
    CastStats own;
    Band all;
    renderGpu(
        device(), scene, job, options,
        [&](Band& band) {
          const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
          append(all.rgb8, band.rgb8), append(all.radiance, band.radiance);
          append(all.distance, band.distance), append(all.solid, band.solid);
        },
        stats ? *stats : own);
    return all;
  }
  static std::size_t hits(const Band& band) {
    return static_cast<std::size_t>(std::count_if(band.solid.begin(), band.solid.end(), [](auto s) { return s >= 0; }));
  }
  static void expectAsStorage(const Scene& scene, const RenderJob& job, const std::string& what) {
    for (const Method method : {Method::fast, Method::exact}) {
      const Band all = picture(scene, job, {.method = method, .plan = Plan::storage});
      expectSame(picture(scene, job, {.method = method, .plan = Plan::lists}), all, what + " " + nameOf(method));
      EXPECT_GT(hits(all), 100u) << what;
    }
  }
};

/// Between the bars of one scene's kinds: the camera stands in the middle of what randomScene() makes.
Scene fromWithin(Scene scene) {
  std::get<PerspectiveCamera>(scene.camera).center = {0.3, -0.2, 0.1};
  return scene;
}
Scene allAround(const Scene& scene) {
  Scene around = scene;
  around.camera = EnvironmentCamera{{0.3, -0.2, 0.1}, {1, 0.2, -1}, {0, 1, 0}, 180, 360};
  return around;
}

TEST_F(Lists, HaveTheBytesOfTheOtherPlans) {
  for (const std::string& name : bundledScenes()) {
    const Scene scene = loaded(name);
    if (!std::holds_alternative<OrthographicCamera>(scene.camera)) expectAsStorage(scene, small(), name);
  }
}

TEST_F(Lists, OfEveryKindFromOutsideFromWithinAndAllAround) {
  for (const std::string& kind : randomKinds()) {
    const Scene scene = randomScene(kind, kind == "plane" ? 20 : 300, 5);
    expectAsStorage(scene, small(), kind);
    expectAsStorage(fromWithin(scene), small(), kind + " from within");
    expectAsStorage(allAround(scene), small(), kind + " all around");
  }
}

/// Solids that the lists hold, as the plan tells.
int listed(const CastStats& stats) {
  for (const std::string& line : stats.plan)
    if (line.starts_with("lists of ")) return std::stoi(line.substr(9));
  return -1;
}

/// In a crowd most solids are hidden and not listed (depth_bounds.h); their absence must not show, a wrong one's would.
TEST_F(Lists, WhatIsHiddenIsLeftOutAndNotMissed) {
  const RenderJob job = small();
  for (const char* kind : {"sphere", "triangle", "quad", "mixed"}) {
    const Scene scene = randomScene(kind, 6000, 8);
    expectAsStorage(scene, job, kind);
    expectAsStorage(fromWithin(scene), job, std::string(kind) + " from within");
    CastStats stats;
    picture(scene, job, {.method = Method::fast, .plan = Plan::lists}, &stats);
    EXPECT_GT(listed(stats), 100) << kind;
    EXPECT_LT(listed(stats), kind == std::string("sphere") ? 2600 : 5700) << kind;
  }
}

/// More than are sifted at a time: what the first ones hide is dropped of the later at once.
TEST_F(Lists, OfMoreSolidsThanARoundTakes) {
  Scene scene = randomScene("sphere", 180000, 12);
  std::get<PerspectiveCamera>(scene.camera).center = {0, 0, 45};
  const Band all = picture(scene, small(), {.method = Method::fast, .plan = Plan::storage});
  expectSame(picture(scene, small(), {.method = Method::fast, .plan = Plan::lists}), all, "180000 spheres");
  EXPECT_GT(hits(all), 100u);
}

/// Solids of some hundred tiles each, some in wide ones: what is seen does not depend on where they are listed.
TEST_F(Lists, OfLargePicturesWithSolidsOfEverySize) {
  RenderJob job = small();
  job.width = 1200, job.height = 900, job.crop = {0, 0, 1200, 900};
  for (const char* kind : {"sphere", "disc", "mixed"}) {
    Scene scene = randomScene(kind, 200, 21);
    addSolid(scene.world, Sphere{{0, 0, 21}, 1.5});
    addSolid(scene.world, Disc{{2, 1, 24}, {0.1, 0.2, 1}, 2});
    const Band all = picture(scene, job, {.method = Method::fast, .plan = Plan::storage});
    expectSame(picture(scene, job, {.method = Method::fast, .plan = Plan::lists}), all, kind);
    EXPECT_GT(hits(all), 100000u) << kind;
  }
  // A crowd of larger ones, whose wide tiles are larger; some of it in front of what fills the picture and some behind.
  job.width = 2048, job.height = 1536, job.crop = {0, 0, 2048, 1536};
  Scene scene = randomScene("sphere", 3000, 22);
  addSolid(scene.world, Sphere{{0, 0, -40}, 42});
  for (int i = 0; i < 30; ++i) addSolid(scene.world, Sphere{{0.1 * i, 0, -70.0 - 2 * i}, 60});
  const Band all = picture(scene, job, {.method = Method::fast, .plan = Plan::tiles});
  CastStats stats;
  expectSame(picture(scene, job, {.method = Method::fast, .plan = Plan::lists}, &stats), all, "crowd");
  EXPECT_LT(listed(stats), 2500);
}

/// Walls that fill the picture, one behind the other and slanted: they are in wide tiles, and hide each other there.
TEST_F(Lists, WallsHideWallsAndWhatIsBehindThem) {
  Scene scene = randomScene("sphere", 3000, 9);
  for (int i = 0; i < 40; ++i) {
    const double z = 20 - i * 0.4, slant = 0.02 * (i % 5 - 2);
    addSolid(scene.world, Quad{{-9, -9, z}, {18, 0, 18 * slant}, {0, 18, -18 * slant}});
    addSolid(scene.world, Triangle{{-30, -9, z - 0.2}, {30, -9, z - 0.2 + slant}, {0, 40, z - 0.2}});
  }
  const RenderJob job = small();
  expectAsStorage(scene, job, "walls");
  CastStats stats;
  picture(scene, job, {.method = Method::fast, .plan = Plan::lists}, &stats);
  EXPECT_GT(listed(stats), 1);
  EXPECT_LT(listed(stats), 100);
}

TEST_F(Lists, SamplesTwoSidedAndBands) {
  const Scene scene = fromWithin(randomScene("mixed", 400, 6));
  RenderJob job = small();
  job.samples = 3, job.twoSided = true;
  expectAsStorage(scene, job, "samples");
  // Rays beside the centres of pixels meet small polygons that hold none.
  for (const char* kind : {"triangle", "quad"}) expectAsStorage(randomScene(kind, 2000, 3), job, kind);
  job.samples = 1;
  const Band whole = picture(scene, job, {.plan = Plan::lists});
  CastStats stats;
  expectSame(picture(scene, job, {.plan = Plan::lists, .memoryBudget = std::size_t{600} << 10}, &stats), whole,
             "bands");
  EXPECT_TRUE(std::any_of(stats.plan.begin(), stats.plan.end(),
                          [](const std::string& line) { return line.rfind("in bands of ", 0) == 0; }));
}

/// One caster, several scenes: what the first left in buffers and pipelines must not show in the next.
TEST_F(Lists, ACasterGoesFromSceneToScene) {
  const RenderJob job = small();
  std::vector<Scene> scenes;
  for (const std::uint32_t count : {300u, 5u, 1000u}) scenes.push_back(randomScene("mixed", count, count));
  scenes.push_back(randomScene("sphere", 6000, 8));  // which hide each other, but not what comes then
  scenes.push_back(scenes[2]);
  scenes.push_back(fromWithin(scenes[0]));
  Scene empty = scenes[0];
  empty.world.solids = {};
  empty.world.groups = {GroupEntry{}};
  scenes.push_back(empty);
  scenes.push_back(scenes[1]);
  for (const Method method : {Method::fast, Method::exact}) {
    ImageCaster caster(device(), scenes[0], job, {.method = method, .plan = Plan::lists});
    for (const Scene& scene : scenes) {
      caster.setScene(scene);
      Band now;
      caster.render([&](Band& band) { now = std::move(band); });
      const Band fresh = picture(scene, job, {.method = method, .plan = Plan::lists});
      EXPECT_EQ(now.solid, fresh.solid);
      EXPECT_EQ(now.rgb8, fresh.rgb8);
    }
  }
}

/// Discs one behind the other, far ones first: all are in every list, the last is in front.
Scene stack(std::uint32_t count) {
  Scene scene;
  scene.width = scene.height = 8;
  scene.camera = PerspectiveCamera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 40, 40};
  for (std::uint32_t i = 0; i < count; ++i)
    scene.world.solids.push_back({"", Disc{{0, 0, -2 - 1e-5 * (count - 1 - i)}, {0, 0, 1}, 50}, 0});
  return scene;
}

/// llvmpipe stops the loops of an invocation after 65535 rounds without a word.
TEST_F(Lists, LongerThanTheDriverWalks) {
  for (const std::uint32_t count : {66000u, 140000u})
    for (const Method method : {Method::fast, Method::exact}) {
      const Scene scene = stack(count);
      RenderJob job;
      job.width = job.height = 8;
      job.channels.solid = job.channels.distance = true;
      const Band band = picture(scene, job, {.method = method, .plan = Plan::lists});
      ASSERT_EQ(band.solid.size(), 64u);
      EXPECT_EQ(hits(band), 64u);
      for (std::size_t i = 0; i < band.solid.size(); ++i)
        EXPECT_EQ(band.solid[i], static_cast<std::int32_t>(count - 1))
            << count << " " << nameOf(method) << " pixel " << i;
    }
}

/// Colours of 8 bits alone are stored by the shader, a byte a pixel where the integrator is grey; beside radiance they are
/// made of it on the host.
TEST_F(Lists, EightBitsAloneAreTheLevelsOfTheRadianceInEveryPlan) {
  Scene scene = loaded("a_solids.json");
  RenderJob job = small();
  const RayCastingDistIntegrator dist{{1, 0.2, 0}, 4, {0.2, 1, 0}, 12};
  for (const Integrator& integrator : {Integrator{RayCastingIntegrator{}}, Integrator{dist}}) {
    scene.integrator = integrator;
    for (const Method method : {Method::naive, Method::fast, Method::exact})
      for (const Plan plan : {Plan::baked, Plan::uniform, Plan::storage, Plan::tiles, Plan::lists}) {
        if (method == Method::naive && plan == Plan::lists) continue;  // refused, see below
        job.channels = {.rgb8 = true};
        const Band alone = picture(scene, job, {.method = method, .plan = plan});
        job.channels = {.rgb8 = true, .radiance = true};
        const Band beside = picture(scene, job, {.method = method, .plan = plan});
        ASSERT_EQ(alone.rgb8.size(), 3u * 151 * 101);
        EXPECT_TRUE(alone.rgb8 == beside.rgb8) << nameOf(method) << " " << planName(plan) << " " << integrator.index();
      }
  }
}

/// Rays without a common origin: the lists hold the solids themselves.
TEST_F(Lists, OfOrthographicCameras) {
  RenderJob job = small();
  expectAsStorage(loaded("orthographic.json"), job, "orthographic");
  for (const std::string& kind : randomKinds()) {
    Scene scene = randomScene(kind, kind == "plane" ? 20 : 300, 5);
    scene.camera = OrthographicCamera{{1, 2, 30}, {0.02, -0.05, -1}, {0, 1, 0}, 24, 18};
    expectAsStorage(scene, job, kind);
    scene.camera = OrthographicCamera{{0.3, -0.2, 0.1}, {1, 0.2, -1}, {0, 1, 0}, 3, 2};
    job.samples = kind == "mixed" ? 2 : 1;
    expectAsStorage(scene, job, kind + " from within");
  }
}

TEST_F(Lists, AreNotForTheYardstick) {
  try {
    picture(loaded("a_solids.json"), small(), {.method = Method::naive, .plan = Plan::lists});
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), Exit::usage);
    EXPECT_STREQ(error.what(), "--plan lists: not possible here: naive tries all solids");
  }
}

}  // namespace
}  // namespace solidcast
