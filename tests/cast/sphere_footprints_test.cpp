// Where spheres are seen, in fp32 (host/cast/footprint_spheres.cpp), against binary128: at the limits of what fp32 can tell.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "host/cast/footprints.h"
#include "host/cast/records.h"
#include "host/scene/random.h"

namespace solidcast {
namespace {

/// Far larger pictures, where a pixel is near to what fp32 can tell: the sphere's outermost point, to a side, above or below,
/// is in a pixel's centre.
TEST(SphereFootprints, HoldThePixelOnASpheresRim) {
  const Scene scene = randomScene("sphere", 1, 1);
  constexpr int across = 16000, down = 12000;
  const Silhouette silhouette(scene, across, down, 1);
  const EyeFrames eye(eyeFrame(scene, RealType::f32));
  Footprints footprints(silhouette, {0, 0, across, down}, eye.plain, RealType::f32, DepthScale(30));
  const PixelRays rays(scene, across, down, 1);
  std::mt19937_64 bits(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int plain = 0, outside = 0;
  for (int i = 0; i < 20000; ++i) {
    const int x = static_cast<int>((uniform(bits) + 1) / 2 * (across - 1));
    const int y = static_cast<int>((uniform(bits) + 1) / 2 * (down - 1));
    const RayQ ray = rays.ray(x, y);
    const f128 away = 20 + 15 * uniform(bits), radius = std::exp2(4 * uniform(bits) - 5);
    const V3 axis = i % 2 ? V3{0, 1, 0} : V3{1, 0, 0}, side = normalized(cross(ray.direction, axis));
    const V3 at = ray.origin + away * ray.direction + (i % 4 < 2 ? radius : -radius) * side;
    const Triple centre = {static_cast<double>(at.x), static_cast<double>(at.y), static_cast<double>(at.z)};
    for (const double more : {1e-8 * static_cast<double>(radius), -1e-3}) {  // a thousandth is a pixel, about
      const Sphere sphere{centre, static_cast<double>(radius) + more};
      const ShapeRef one = sphere;
      const bool hit = cut(sphere, ray).hit;
      EXPECT_EQ(hit, more > 0);
      footprints.findBatches(
          std::span(&one, 1), false,
          [&](const auto& batch) {
            const Footprint seen = footprints.of(batch, 0, std::span(&one, 1));
            const bool within = x >= seen.x0 && x <= seen.x1 && y >= seen.y0 && y <= seen.y1;
            EXPECT_TRUE(within || !hit) << i;
            plain += batch.plain[0] != 0, outside += !within;
          },
          [](std::size_t, const Footprint&) { FAIL(); });
    }
  }
  EXPECT_GT(plain, 39000);
  EXPECT_GT(outside, 10000);  // it is not taken much larger than it is
}

/// Spheres so near that fp32 does not serve hide as well, what lies beside them in the block too.
TEST(SphereFootprints, OfNearSpheresHide) {
  const Scene scene = randomScene("sphere", 1, 1);
  const Silhouette silhouette(scene, 72, 54, 1);
  const EyeFrames frames(eyeFrame(scene, RealType::f32));
  Footprints footprints(silhouette, {0, 0, 72, 54}, frames.plain, RealType::f32, DepthScale(30));
  const double eye = static_cast<double>(frames.exact.origin.z);
  for (const double away : {1.02, 1.5, 1.99, 2.01, 3.0}) {
    const Shape shapes[] = {Sphere{{0, 0, eye - 2 * away}, 2}, Sphere{{1, 0, eye - 20}, 0.5}};
    const ShapeRef refs[] = {shapes[0], shapes[1]};
    int found = 0;
    footprints.find(std::span(refs), [&](std::size_t i, const Footprint& f) {
      EXPECT_TRUE(f.seen()) << away << " " << i;
      EXPECT_NE(f.hides, DepthScale::none) << away << " " << i;
      ++found;
    });
    EXPECT_EQ(found, 2);
  }
}

}  // namespace
}  // namespace solidcast
