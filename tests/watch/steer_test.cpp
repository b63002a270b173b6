// Cameras moved by hand.
#include "host/watch/steer.h"

#include <gtest/gtest.h>

#include <cmath>

namespace solidcast::watch {
namespace {

constexpr Triple kPivot{1, 2, 3};
const PerspectiveCamera kCamera{{1, 2, 13}, {0, 0, -1}, {0, 1, 0}, 60, 90};

const PerspectiveCamera& perspective(const Camera& camera) { return std::get<PerspectiveCamera>(camera); }
double distance(const Triple& a, const Triple& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }
void expectNear(const Triple& a, const Triple& b) {
  EXPECT_LT(distance(a, b), 1e-12) << a[0] << " " << a[1] << " " << a[2];
}

TEST(Steer, OrbitGoesAroundThePivot) {
  const auto right = perspective(orbited(kCamera, kPivot, 90, 0));
  expectNear(right.center, {11, 2, 3});
  expectNear(right.forward, {-1, 0, 0});
  const auto up = perspective(orbited(kCamera, kPivot, 0, -30));
  expectNear(up.center, {1, 2 + 5, 3 + 10 * std::sqrt(0.75)});
  EXPECT_NEAR(distance(up.center, kPivot), 10, 1e-12);
  expectNear(perspective(orbited(orbited(kCamera, kPivot, 25, 10), kPivot, -25, -10)).center, kCamera.center);
}

TEST(Steer, OrbitStopsBeforeThePole) {
  Camera camera = kCamera;
  for (int i = 0; i < 50; ++i) camera = orbited(camera, kPivot, 7, -30);
  const auto& c = perspective(camera);
  EXPECT_NEAR(c.forward[1], -std::sin(89 * M_PI / 180), 1e-9);
  EXPECT_NEAR(distance(c.center, kPivot), 10, 1e-9);
  EXPECT_EQ(c.up, kCamera.up);
}

TEST(Steer, PanMovesThePictureByItsWidth) {
  // At 10 units a 90 degree picture is 20 wide.
  expectNear(perspective(panned(kCamera, kPivot, 1, 0)).center, {1 - 20, 2, 13});
  expectNear(perspective(panned(kCamera, kPivot, 0, 0.5)).center, {1, 2 - 10 * std::tan(M_PI / 6), 13});
  const Camera flat = OrthographicCamera{{1, 2, 13}, {0, 0, -1}, {0, 1, 0}, 8, 6};
  expectNear(std::get<OrthographicCamera>(panned(flat, kPivot, 0.25, 0)).center, {1 - 2, 2, 13});
}

TEST(Steer, Zoom) {
  expectNear(perspective(zoomed(kCamera, kPivot, 0.5)).center, {1, 2, 8});
  const Camera flat = OrthographicCamera{{1, 2, 13}, {0, 0, -1}, {0, 1, 0}, 8, 6};
  EXPECT_EQ(std::get<OrthographicCamera>(zoomed(flat, kPivot, 0.5)).scaleX, 4);
  const Camera all = EnvironmentCamera{{1, 2, 13}, {0, 0, -1}, {0, 1, 0}, 180, 360};
  EXPECT_EQ(zoomed(all, kPivot, 0.5), all);
  Camera camera = kCamera;
  for (int i = 0; i < 500; ++i) camera = zoomed(camera, kPivot, 0.5);
  EXPECT_GT(distance(perspective(camera).center, kPivot), 1e-7);
}

}  // namespace
}  // namespace solidcast::watch
