// The course's scene, pixel by pixel: what its reference images prove.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <string>

#include "tests/reference/scenes.h"

namespace solidcast::reference {
namespace {

using Rgb = std::array<int, 3>;

Rgb rgbAt(const Band& band, int x, int y) {
  const std::size_t pixel = std::size_t(y) * band.width + x;
  return {band.rgb8[3 * pixel], band.rgb8[3 * pixel + 1], band.rgb8[3 * pixel + 2]};
}

std::map<int, int> pixelsPerSolid(const Band& band) {
  std::map<int, int> counts;
  for (int index : band.solid) ++counts[index];
  return counts;
}

struct KnownPixel {
  int x, y, solid;
  double t, cosine;
  int grey;
  Rgb byDistance;
};

const KnownPixel knownPixels[] = {
    {320, 240, 1, 7.307164, 0.770270, 196, {131, 104, 0}}, {320, 479, 3, 2.617784, 0.382002, 97, {97, 19, 0}},
    {205, 135, 0, 8.341606, 0.998237, 254, {144, 161, 0}}, {500, 180, 2, 10.599986, 0.879254, 224, {76, 192, 0}},
    {100, 290, 7, 9.181351, 0.712394, 181, {87, 130, 0}},  {300, 320, 6, 6.282646, -0.186790, 0, {0, 0, 0}},
    {400, 90, 4, 11.556976, 0.170321, 43, {10, 41, 0}},    {500, 60, 8, 8.222784, 0.912100, 232, {134, 144, 0}},
    {450, 140, 8, 9.098197, 0.164868, 42, {20, 29, 0}},    {440, 80, -1, 0, 0, 0, {0, 0, 0}},
};

class CoursePixels : public testing::TestWithParam<Precision> {};

TEST_P(CoursePixels, GreyDistanceAndSolid) {
  const Scene scene = courseScene();
  const Band band = renderWhole(scene, jobOf(scene, allChannels()), GetParam());
  for (const KnownPixel& known : knownPixels) {
    SCOPED_TRACE(testing::Message() << "pixel " << known.x << "," << known.y);
    const std::size_t pixel = std::size_t(known.y) * 640 + known.x;
    EXPECT_EQ(band.solid[pixel], known.solid);
    EXPECT_EQ(rgbAt(band, known.x, known.y), (Rgb{known.grey, known.grey, known.grey}));
    if (known.solid < 0) {
      EXPECT_EQ(band.distance[pixel], std::numeric_limits<float>::infinity());
    } else {
      EXPECT_NEAR(band.distance[pixel], known.t, GetParam() == Precision::f32 ? 1e-5 : 2e-6);
      EXPECT_NEAR(band.radiance[3 * pixel], std::max(0.0, known.cosine), 2e-6);
    }
  }
}

TEST_P(CoursePixels, ColourByDistance) {
  Scene scene = courseScene();
  scene.integrator = courseDistance();
  const Band band = renderWhole(scene, jobOf(scene, {.rgb8 = true}), GetParam());
  for (const KnownPixel& known : knownPixels)
    EXPECT_EQ(rgbAt(band, known.x, known.y), known.byDistance) << "pixel " << known.x << "," << known.y;
}

TEST_P(CoursePixels, PixelsPerSolid) {
  const Scene scene = courseScene();
  const std::map<int, int> expected{{-1, 71429}, {0, 42121}, {1, 33875}, {2, 10200}, {3, 114720},
                                    {4, 2964},   {5, 4013},  {6, 5026},  {7, 12958}, {8, 9894}};
  EXPECT_EQ(pixelsPerSolid(renderWhole(scene, jobOf(scene, {.solid = true}), GetParam())), expected);
}

INSTANTIATE_TEST_SUITE_P(, CoursePixels, testing::Values(Precision::f32, Precision::f64, Precision::f128),
                         [](const auto& info) {
                           return std::string(std::array{"f32", "f64", "f128"}[int(info.param)]);
                         });

TEST(CourseScene, TwoSidedChangesOpenSurfacesOnly) {
  // Triangle 6 and the quad are seen from behind: 4013 + 5026 pixels turn from black to grey.
  const Scene scene = courseScene();
  RenderJob job = jobOf(scene, {.radiance = true, .solid = true});
  const Band oneSided = renderWhole(scene, job, Precision::f64);
  job.twoSided = true;
  const Band twoSided = renderWhole(scene, job, Precision::f64);
  Scene twoSidedScene = scene;
  twoSidedScene.twoSided = true;
  job.twoSided = false;
  EXPECT_EQ(renderWhole(twoSidedScene, job, Precision::f64).radiance, twoSided.radiance);
  int changed = 0;
  for (std::size_t pixel = 0; pixel < oneSided.solid.size(); ++pixel) {
    if (oneSided.radiance[3 * pixel] == twoSided.radiance[3 * pixel]) continue;
    ++changed;
    EXPECT_TRUE(oneSided.solid[pixel] == 5 || oneSided.solid[pixel] == 6) << oneSided.solid[pixel];
    EXPECT_EQ(oneSided.radiance[3 * pixel], 0);
    EXPECT_GT(twoSided.radiance[3 * pixel], 0);
  }
  EXPECT_EQ(changed, 9039);
}

TEST(QuadricScene, SphereAsAQuadricAndTheOthersAgreeWithTheirEquations) {
  // Solid 2 is the sphere around (-2, 2, 2) of radius 2: the same picture comes from a Sphere.
  const Scene scene = quadricScene();
  Scene withSphere = scene;
  std::vector<solidcast::SolidEntry> solids(scene.world.solids.begin(), scene.world.solids.end());
  solids[2].shape = solidcast::Sphere{{-2, 2, 2}, 2};
  withSphere.world.solids = solidcast::Solids(solids);
  const RenderJob job = jobOf(scene, {.rgb8 = true, .distance = true, .solid = true, .position = true});
  const Band quadrics = renderWhole(scene, job, Precision::f64);
  const Band mixed = renderWhole(withSphere, job, Precision::f64);
  EXPECT_EQ(quadrics.solid, mixed.solid);
  std::map<int, int> counts = pixelsPerSolid(quadrics);
  EXPECT_EQ(counts.size(), 5u);  // all four are seen, and misses
  int differing = 0;
  for (std::size_t i = 0; i < quadrics.rgb8.size(); ++i) differing += quadrics.rgb8[i] != mixed.rgb8[i];
  EXPECT_LE(differing, 30);
  for (std::size_t pixel = 0; pixel < quadrics.solid.size(); ++pixel) {
    if (quadrics.solid[pixel] < 0) continue;
    const auto q = std::get<solidcast::Quadric>(scene.world.solids[quadrics.solid[pixel]].shape).coefficients;
    const double x = quadrics.position[3 * pixel], y = quadrics.position[3 * pixel + 1],
                 z = quadrics.position[3 * pixel + 2];
    const double value = q[0] * x * x + q[1] * y * y + q[2] * z * z + q[6] * x + q[7] * y + q[8] * z + q[9];
    ASSERT_NEAR(value, 0, 2e-4 * (1 + x * x)) << "pixel " << pixel;  // positions are rounded to float
  }
}

TEST(QuadricScene, NearColourBeyondFarColour) {
  Scene scene = quadricScene();
  scene.integrator = solidcast::RayCastingDistIntegrator{{0.6, 0, 0.4}, 12, {0.6, 1, 0.5}, 2};
  const Band band =
      renderWhole(scene, jobOf(scene, {.radiance = true, .distance = true, .normal = true}), Precision::f64);
  int between = 0;
  for (std::size_t pixel = 0; pixel < band.distance.size(); ++pixel) {
    const float red = band.radiance[3 * pixel], green = band.radiance[3 * pixel + 1];
    const float t = band.distance[pixel];
    if (red == 0) continue;
    // Red is 0.6 everywhere, so green / red is the factor (t - 12) / (2 - 12) over 0.6.
    const double factor = std::clamp((12 - t) / 10.0, 0.0, 1.0);
    between += factor > 0 && factor < 1;
    ASSERT_NEAR(green / red, factor / 0.6, 1e-5) << "pixel " << pixel;
  }
  EXPECT_GT(between, 50000);
}

}  // namespace
}  // namespace solidcast::reference
