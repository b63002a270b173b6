// The bundled scenes by every method against the oracle: exact is exact, and the others flip decisions only where a
// tilt of 1e-6 rad flips them, nearly.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

struct Census {
  int pixels = 0, flipped = 0, stuck = 0;  // stuck: flipped although no tilted ray is
  std::vector<double> ulps;                // of t where solid and truth agree
  double relative = 0;
  double atPercent(double percent) {
    if (ulps.empty()) return 0;
    std::sort(ulps.begin(), ulps.end());
    return ulps[std::min(ulps.size() - 1, static_cast<std::size_t>(percent / 100 * static_cast<double>(ulps.size())))];
  }
};

Census census(gpu::Device& device, const Scene& scene, Method method) {
  RenderJob job = jobOf(scene, {.distance = true, .solid = true});
  const Band band = renderWhole(device, scene, job, {.method = method});
  Census all;
  for (int y = 0; y < scene.height; ++y)
    for (int x = 0; x < scene.width; ++x) {
      const auto i = static_cast<std::size_t>(y * scene.width + x);
      const oracle::Ray128 ray = oracle::pixelRay(scene.camera, scene.width, scene.height, x + 0.5, y + 0.5);
      const oracle::WorldTruth truth = oracle::cast(scene.world, ray);
      ++all.pixels;
      if (band.solid[i] != truth.index) {
        ++all.flipped;
        all.stuck += !oracle::flipsWhenTilted(scene.world, ray, 1e-6);
      } else if (truth.index >= 0) {
        all.ulps.push_back(oracle::ulpError(band.distance[i], truth.truth.t));
        const double t = static_cast<double>(truth.truth.t);
        all.relative = std::fmax(all.relative, std::abs(band.distance[i] - t) / t);
      }
    }
  return all;
}

class Bundled : public OnDevice, public testing::WithParamInterface<std::string> {};
INSTANTIATE_TEST_SUITE_P(, Bundled, testing::ValuesIn(bundledScenes()), [](const auto& info) {
  std::string name = info.param.substr(0, info.param.size() - 5);
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
});

TEST_P(Bundled, FlipsOnlyWhereATiltFlips) {
  Scene scene = loaded(GetParam());
  scene.world.customSolids.clear();  // the oracle knows none; tests/custom has them
  const bool many = scene.world.solids.size() > 50;
  scene.width = many ? 64 : 128, scene.height = many ? 48 : 96;
  for (const Method method : kMethods) {
    Census c = census(device(), scene, method);
    SCOPED_TRACE(std::string(nameOf(method)) + ": " + std::to_string(c.flipped) + " flipped, " +
                 std::to_string(c.stuck) + " stuck, p99 " + std::to_string(c.atPercent(99)) + " ulp, max " +
                 std::to_string(c.atPercent(100)) + " ulp, relative " + std::to_string(c.relative));
    RecordProperty(std::string(nameOf(method)) + "_p99_ulps", std::to_string(c.atPercent(99)));
    RecordProperty(std::string(nameOf(method)) + "_flipped", c.flipped);
    if (method == Method::exact) {
      EXPECT_EQ(c.flipped, 0);
      EXPECT_LE(c.atPercent(100), 1);
      continue;
    }
    // fp32 at work: a far small sphere costs it digits, at worst a decision or two (as many as one pixel in 2000).
    EXPECT_LE(c.stuck * 2000, c.pixels);
    EXPECT_LE(c.relative, 1e-2);
  }
}

// Where nothing cancels, fast keeps four ulps.
TEST_F(OnDevice, FastKeepsFourUlpsOnFlatSolids) {
  for (const char* name : {"solids/infinite_plane.json", "solids/triangle.json", "solids/quad.json", "solids/disc.json",
                           "solids/box.json"}) {
    Scene scene = loaded(name);
    scene.width = 128, scene.height = 96;
    std::vector<SolidEntry> flat(scene.world.solids.begin(), scene.world.solids.end());
    std::erase_if(flat, [](const SolidEntry& solid) {
      return std::holds_alternative<Sphere>(solid.shape) || std::holds_alternative<Quadric>(solid.shape);
    });
    scene.world.solids = Solids(flat);
    Census c = census(device(), scene, Method::fast);
    EXPECT_EQ(c.stuck, 0) << name;
    EXPECT_LE(c.atPercent(99), 4) << name;
    EXPECT_LE(c.relative, 1e-4) << name;
    EXPECT_GT(c.ulps.size(), 500u) << name;
  }
}

}  // namespace
}  // namespace solidcast
