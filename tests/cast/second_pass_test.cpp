// The guarantee's fallback is seen to run: worlds that force doubt, and the answers after it.
#include "host/cast/second_pass.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/cast/pixel_candidates.h"
#include "host/scene/random.h"
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

Scene sceneOf(const std::vector<Shape>& shapes, int width, int height) {
  Scene scene;
  scene.width = width;
  scene.height = height;
  scene.camera = PerspectiveCamera{{0, 0, 5}, {0, 0, -1}, {0, 1, 0}, 50, 60};
  scene.world = worldOf(shapes);
  return scene;
}

// The middle column of an odd image looks exactly along the edge that the triangles share; the middle row meets a
// sphere's silhouette nowhere, so that all doubt is the edge's.
TEST_F(OnDevice, AnEdgeThroughPixelCentres) {
  const Scene scene =
      sceneOf({Triangle{{0, -2, 0}, {2, 0, 0}, {0, 2, 0}}, Triangle{{0, -2, 0}, {0, 2, 0}, {-2, 0, -1}}}, 101, 75);
  for (const Arithmetic arithmetic : {Arithmetic::fp64, Arithmetic::df32}) {
    const Tally tally = measureImage(device(), scene, {.arithmetic = arithmetic});
    EXPECT_TRUE(tally.exact()) << text(tally);
    EXPECT_GE(tally.doubtful, 50u);
    if (arithmetic == Arithmetic::fp64) { EXPECT_LE(tally.doubtful, 150u) << "only the column"; }
  }
}

// The second pass of a few rays tries only what their pixels can see: nothing that a ray meets may be missing there.
TEST(PixelCandidates, HoldAllThatTheirRaysMeet) {
  for (const Camera& camera : {Camera{PerspectiveCamera{{0, 0, 30}, {0, 0, -1}, {0, 1, 0}, 45, 57}},
                               Camera{PerspectiveCamera{{0.3, -0.2, 0.1}, {1, 0.2, -1}, {0, 1, 0}, 70, 90}},
                               Camera{OrthographicCamera{{1, 2, 30}, {0.02, -0.05, -1}, {0, 1, 0}, 24, 18}},
                               Camera{EnvironmentCamera{{0.3, -0.2, 0.1}, {1, 0.2, -1}, {0, 1, 0}, 180, 360}}})
    for (const int samples : {1, 2}) {
      Scene scene = randomScene("mixed", 9000, 3);
      scene.camera = camera;
      const Crop region{20, 10, 97, 61};
      std::vector<std::uint32_t> pixels;
      for (std::uint32_t i = 0; i < 97 * 61; i += 11) pixels.push_back(i);
      const PixelCandidates among(scene, Silhouette(scene, 160, 120, samples), region, pixels);
      const SecondPass second(scene.world);
      const PixelRays rays(scene, 160, 120, samples);
      std::size_t hits = 0, tried = 0;
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const std::int64_t x = region.x + pixels[i] % 97, y = region.y + pixels[i] / 97;
        const RayQ ray = rays.ray(x * samples, y * samples);
        const ExactHit all = second.cast(ray), few = second.castAmong(ray, among.of(i));
        EXPECT_EQ(few.index, all.index) << "pixel " << x << "," << y;
        EXPECT_TRUE(few.t == all.t);
        hits += all.index > 0;  // not the plane
        tried += among.of(i).size();
      }
      EXPECT_GT(hits, pixels.size() / 10);
      EXPECT_LT(tried, pixels.size() * 3000) << "much less than all";
    }
}

// All hits are ties: more doubt than the list has room for, so the band runs once more.
TEST_F(OnDevice, CoincidentSolidsOverflowTheListOfDoubts) {
  const InfinitePlane wall{{0, 0, -1}, {0.125, 0.25, 1}};
  const Scene scene = sceneOf({wall, Sphere{{0, 0, 0}, 1}, wall, Sphere{{0, 0, 0}, 1}}, 121, 97);
  const Tally tally = measureImage(device(), scene, {});
  EXPECT_TRUE(tally.exact()) << text(tally);
  EXPECT_GE(tally.doubtful, 121u * 97 * 9 / 10);
}

// Radiance of doubtful pixels comes from the host: it must be what the shader says beside it.
// Copies of a solid tie wherever it is hit: the first of them counts, in whatever order the index comes to them.
TEST(SecondPass, OfCopiesTheFirstCounts) {
  std::vector<Shape> shapes;
  for (int i = 0; i < 900; ++i) {
    if (i % 3 == 0) shapes.push_back(Sphere{{0, 0, 0}, 1});
    if (i % 3 == 1) shapes.push_back(Sphere{{0, 0, 0}, 1.5});
    if (i % 3 == 2) shapes.push_back(Sphere{{0.1 * i, 7, 0}, 1});
  }
  std::reverse(shapes.begin(), shapes.end());  // the large ones begin at 1, the small ones at 2
  const World world = worldOf(shapes);
  const SecondPass second(world);
  std::vector<std::uint32_t> all(shapes.size());
  std::iota(all.begin(), all.end(), 0);
  for (int i = 0; i < 40; ++i) {  // the index is built after a few
    const RayQ ray{V3{0.01 * i, 0, 9}, V3{0, 0, -1}, i % 2 == 0};
    EXPECT_EQ(second.cast(ray).index, 1) << i;
    EXPECT_EQ(second.castAmong(ray, all).index, 1) << i;
  }
}

TEST_F(OnDevice, TheHostShadesAsTheShaderDoes) {
  const Shape floor = Quad{{-4, -1, 4}, {8, 0, 0}, {0, 0.5, -9}};
  const Shape ball = Sphere{{0.3, 0.2, 0}, 1};
  Scene once = sceneOf({floor, ball}, 90, 70), twice = sceneOf({floor, ball, floor, ball}, 90, 70);
  const RayCastingDistIntegrator dist{{1, 0.2, 0}, 3, {0.2, 1, 0}, 7};
  for (const Integrator& integrator : {Integrator{RayCastingIntegrator{}}, Integrator{dist}}) {
    once.integrator = twice.integrator = integrator;
    for (const int samples : {1, 2}) {
      RenderJob job = jobOf(once, {.rgb8 = true, .radiance = true, .distance = true, .solid = true});
      job.samples = samples;
      CastStats clear, doubtful;
      const Band a = renderWhole(device(), once, job, {}, &clear), b = renderWhole(device(), twice, job, {}, &doubtful);
      EXPECT_LT(clear.fallbackRays, 100u);
      EXPECT_GT(doubtful.fallbackRays, 3000u);
      EXPECT_EQ(a.solid, b.solid) << "the first of two equal solids wins";
      EXPECT_EQ(a.distance, b.distance);
      float worst = 0;
      for (std::size_t i = 0; i < a.radiance.size(); ++i)
        worst = std::fmax(worst, std::abs(a.radiance[i] - b.radiance[i]));
      EXPECT_LT(worst, 4e-7f);
    }
  }
}

}  // namespace
}  // namespace solidcast
