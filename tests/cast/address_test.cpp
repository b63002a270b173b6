// Uniform plan with records read by their addresses, one ray, four or all of an invocation's at a time: no bit of any channel
// may show it.
#include "host/cast/plan.h"
#include "host/scene/camera_path.h"
#include "host/scene/random.h"
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

constexpr int kManyPictures = 1'000'000;  // of even the smallest size
constexpr std::pair<int, const char*> kWays[] = {
    {1, "_turn1"}, {1000, "_turn4"}, {kManyPictures, "_address"}};  // pictures, module

class AddressTest : public OnDevice, public testing::WithParamInterface<Method> {
 protected:
  CastOptions options(int pictures, Plan plan = Plan::uniform) const {
    return {.method = GetParam(), .plan = plan, .pictures = pictures, .moving = true};
  }
  static Band whole(ImageCaster& caster) {
    Band all;
    caster.render([&](Band& band) { all = std::move(band); });
    return all;
  }
  static bool uses(const ImageCaster& caster, const char* module) {
    const std::vector<std::string>& modules = caster.stats().modules;
    return std::any_of(modules.begin(), modules.end(), [&](const std::string& name) { return name.ends_with(module); });
  }
  static bool readsByAddress(const ImageCaster& caster) {
    return std::any_of(std::begin(kWays), std::end(kWays), [&](const auto& way) { return uses(caster, way.second); });
  }
  static RenderJob job() {
    RenderJob job;
    job.width = 101, job.height = 75;
    job.channels = allChannels();
    job.channels.normal = job.channels.local = job.channels.position = false;
    return job;
  }
  void expectSamePicture(const Scene& scene, const RenderJob& job, const std::string& what) {
    ImageCaster plain(device(), scene, job, options(1, Plan::storage));
    const Band expected = whole(plain);
    for (const auto& [pictures, module] : kWays) {
      ImageCaster addressed(device(), scene, job, options(pictures));
      EXPECT_TRUE(uses(addressed, module)) << what;
      expectSame(whole(addressed), expected, what + module);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(, AddressTest, testing::Values(Method::fast, Method::exact),
                         [](const auto& info) { return std::string(nameOf(info.param)); });

TEST_P(AddressTest, DoesNotShow) {
  for (const std::string& name : bundledScenes()) {
    const Scene scene = loaded(name);
    if (scene.world.solids.size() > mostWide || name.starts_with("custom")) continue;
    expectSamePicture(scene, job(), name);
  }
}

TEST_P(AddressTest, DoesNotShowOfAnyKindFromAnyCamera) {
  const Camera cameras[] = {OrthographicCamera{{0, 0, 10}, {0, 0, -1}, {0, 1, 0}, 8, 6},
                            EnvironmentCamera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90, 180}};
  Scene scene = randomScene("mixed", mostWide, 4);
  expectSamePicture(scene, job(), "perspective");
  for (const Camera& camera : cameras) {
    scene.camera = camera;
    expectSamePicture(scene, job(), std::to_string(camera.index()));
  }
}

TEST_P(AddressTest, NorWithSamplesPartsAndTies) {
  Scene scene = loaded("a_solids.json");
  RenderJob part = job();
  part.samples = 2;
  part.crop = {13, 9, 50, 37};
  expectSamePicture(scene, part, "2x2 samples, a part of the picture");
  scene.integrator = RayCastingDistIntegrator{{1, 0.2, 0}, 4, {0.2, 1, 0}, 12};  // with colours in the view's rows
  expectSamePicture(scene, job(), "castingdist");
  scene.world.solids = {};
  scene.world.solids.push_back({"", InfinitePlane{{0, 0, 0}, {0, 0, 1}}});
  scene.world.solids.push_back({"", Quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}}});
  scene.world.solids.push_back({"", AABox{{0, 0, -1}, {2, 1, 0}}});
  expectSamePicture(scene, job(), "solids that share a plane");
}

TEST_P(AddressTest, WhileTheCameraMovesAndSolidsComeAndGo) {
  const Scene few = randomScene("mixed", mostWide, 1), many = randomScene("mixed", mostWide + 1, 1);
  const RenderJob small = job();
  for (const auto& [pictures, module] : kWays) {
    ImageCaster caster(device(), few, small, options(pictures));
    EXPECT_TRUE(uses(caster, module));
    Scene turned = few;
    for (const Scene* next : std::initializer_list<const Scene*>{&few, &turned, &many, &turned}) {
      turned.camera = orbited(turned.camera, pointLookedAt(few), 20);
      caster.setScene(*next);
      ImageCaster plain(device(), *next, small, options(1, Plan::storage));
      expectSame(whole(caster), whole(plain), module);
    }
  }
}

TEST_P(AddressTest, OnlyWhereThereIsAModuleForIt) {
  const Scene few = loaded("a_solids.json"), many = randomScene("sphere", mostWide + 1, 1);
  RenderJob normals = job();
  normals.channels.normal = true;  // exact's come from the second pass
  for (const auto& [pictures, module] : kWays) {
    EXPECT_EQ(readsByAddress(ImageCaster(device(), few, normals, options(pictures))), GetParam() == Method::exact);
    EXPECT_FALSE(readsByAddress(ImageCaster(device(), many, job(), options(pictures))));
    CastOptions pairs = options(pictures);
    pairs.arithmetic = Arithmetic::df32;
    if (GetParam() == Method::exact) { EXPECT_FALSE(readsByAddress(ImageCaster(device(), few, job(), pairs))); }
    CastOptions naive = options(pictures);
    naive.method = Method::naive;
    EXPECT_FALSE(readsByAddress(ImageCaster(device(), few, job(), naive)));
  }
}

}  // namespace
}  // namespace solidcast
