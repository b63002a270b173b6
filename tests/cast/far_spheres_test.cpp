// Small spheres far away: b^2 and |d|^2 C agree to all digits of fp32, so `fast` takes the discriminant by the vector from
// the centre to the ray (shaders/solids/sphere.glsl). Held against `exact`, whose truth other tests show.
#include <cmath>

#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

class FarSpheres : public OnDevice, public testing::WithParamInterface<double> {};
INSTANTIATE_TEST_SUITE_P(Radii, FarSpheres, testing::Values(20, 300, 3000));

TEST_P(FarSpheres, AreSeenByFastAsTheyAre) {
  Scene scene;
  const double away = GetParam();  // radii
  scene.width = 160, scene.height = 120;
  // Nine spheres fill the picture, off every axis.
  const double angle = std::atan(12 / away) * 180 / M_PI;
  scene.camera = PerspectiveCamera{{0.3, -0.2, 0.1}, {0.1, 0.2, -1}, {0, 1, 0}, angle * 0.75, angle};
  const double norm = std::sqrt(1.05);
  for (int i = 0; i < 9; ++i) {
    const double across = 1.2 * (i % 3 - 1), up = 1.2 * (i / 3 - 1);
    scene.world.groups[0].members.push_back({false, static_cast<std::uint32_t>(i)});
    scene.world.solids.push_back(
        {"", Sphere{{0.3 + 0.1 / norm * away + across, -0.2 + 0.2 / norm * away + up, 0.1 - away / norm}, 0.5}, 0});
  }
  for (const Plan plan : {Plan::uniform, Plan::lists}) {
    const RenderJob job = jobOf(scene, {.radiance = true, .distance = true, .solid = true});
    const Band exact = renderWhole(device(), scene, job, {.method = Method::exact});
    const Band fast = renderWhole(device(), scene, job, {.method = Method::fast, .plan = plan});
    int hits = 0, other = 0;
    double worst = 0;
    for (std::size_t i = 0; i < exact.solid.size(); ++i) {
      hits += exact.solid[i] >= 0;
      if (exact.solid[i] != fast.solid[i]) ++other;
      else if (exact.solid[i] >= 0)
        worst = std::max(worst, std::abs(double(fast.radiance[3 * i]) - exact.radiance[3 * i]));
    }
    EXPECT_GT(hits, 1000);
    // q is off by 2^-21 away of r^2, and the cosine is its root: near the rim that much of 1 under the root.
    EXPECT_LE(worst, std::sqrt(0x1p-20 * away)) << away;
    EXPECT_LE(other, 1 + hits * 0x1p-20 * away) << away;
  }
}

}  // namespace
}  // namespace solidcast
