// Jobs: crop, samples, channels, cameras, threads and precisions; and queries.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "host/error.h"
#include "tests/reference/scenes.h"

namespace solidcast::reference {
namespace {

Scene smallCourseScene() {
  Scene scene = courseScene();
  scene.integrator = courseDistance();
  scene.width = 160;
  scene.height = 120;
  return scene;
}

/// Rows and columns of a channel with `perPixel` values, cut out of the whole image.
template <class Value>
std::vector<Value> cut(const std::vector<Value>& whole, int width, const Crop& crop, int perPixel) {
  std::vector<Value> part;
  for (int row = crop.y; row < crop.y + crop.height; ++row) {
    const auto begin = whole.begin() + (std::size_t(row) * width + crop.x) * perPixel;
    part.insert(part.end(), begin, begin + std::size_t(crop.width) * perPixel);
  }
  return part;
}

void expectSame(const Band& a, const Band& b) {
  EXPECT_EQ(a.rgb8, b.rgb8);
  EXPECT_EQ(a.radiance, b.radiance);
  EXPECT_EQ(a.distance, b.distance);
  EXPECT_EQ(a.solid, b.solid);
  EXPECT_EQ(a.normal, b.normal);
  EXPECT_EQ(a.local, b.local);
  EXPECT_EQ(a.position, b.position);
}

TEST(Render, ACropIsThePartOfTheWholeByteForByte) {
  const Scene scene = smallCourseScene();
  RenderJob job = jobOf(scene, allChannels());
  job.samples = 2;
  const Band whole = renderWhole(scene, job, Precision::f64);
  for (const Crop& crop : {Crop{0, 0, 160, 120}, Crop{37, 41, 50, 33}, Crop{159, 119, 1, 1}, Crop{0, 60, 160, 1}}) {
    job.crop = crop;
    const Band part = renderWhole(scene, job, Precision::f64);
    Band expected;
    expected.rgb8 = cut(whole.rgb8, 160, crop, 3);
    expected.radiance = cut(whole.radiance, 160, crop, 3);
    expected.distance = cut(whole.distance, 160, crop, 1);
    expected.solid = cut(whole.solid, 160, crop, 1);
    expected.normal = cut(whole.normal, 160, crop, 3);
    expected.local = cut(whole.local, 160, crop, 3);
    expected.position = cut(whole.position, 160, crop, 3);
    expectSame(part, expected);
    EXPECT_EQ(part.width, crop.width);
    EXPECT_EQ(part.rows, crop.height);
  }
}

TEST(Render, ThreadsDoNotChangeABit) {
  const Scene scene = smallCourseScene();
  const RenderJob job = jobOf(scene, allChannels());
  const Band one = renderWhole(scene, job, Precision::f64, 1);
  expectSame(one, renderWhole(scene, job, Precision::f64, 3));
  expectSame(one, renderWhole(scene, job, Precision::f64, 1000));
}

TEST(Render, SamplesAreTheMeanOfAFinerImage) {
  // 3 x 3 samples in a pixel are the centres of the pixels of an image three times as large.
  Scene scene = smallCourseScene();
  scene.width = 40, scene.height = 30;
  RenderJob job = jobOf(scene, allChannels());
  const Band plain = renderWhole(scene, job, Precision::f64);
  job.samples = 3;
  const Band coarse = renderWhole(scene, job, Precision::f64);
  job.samples = 1;
  job.width = 120, job.height = 90;
  const Band fine = renderWhole(scene, job, Precision::f64);
  int differing = 0;
  for (int j = 0; j < 30; ++j)
    for (int i = 0; i < 40; ++i)
      for (int k = 0; k < 3; ++k) {
        double sum = 0;
        for (int y = 0; y < 3; ++y)
          for (int x = 0; x < 3; ++x) sum += fine.radiance[3 * ((3 * j + y) * 120 + 3 * i + x) + k];
        const std::size_t place = 3 * (j * 40 + i) + k;
        EXPECT_NEAR(coarse.radiance[place], sum / 9, 1e-6);
        differing += coarse.radiance[place] != plain.radiance[place];
      }
  EXPECT_GT(differing, 1000);
  EXPECT_EQ(coarse.normal, plain.normal);  // everything else is of the pixel's centre
  EXPECT_EQ(coarse.distance, plain.distance);
  EXPECT_EQ(coarse.solid, plain.solid);
}

TEST(Render, OnlyWhatIsAskedForIsMade) {
  const Scene scene = smallCourseScene();
  const Band all = renderWhole(scene, jobOf(scene, allChannels()), Precision::f64);
  expectSame(renderWhole(scene, jobOf(scene, {}), Precision::f64), {});
  Band expected;
  expected.normal = all.normal;
  expectSame(renderWhole(scene, jobOf(scene, {.normal = true}), Precision::f64), expected);
  expected = {};
  expected.rgb8 = all.rgb8;
  expectSame(renderWhole(scene, jobOf(scene, {.rgb8 = true}), Precision::f64), expected);
}

TEST(Render, BytesAreClampedAndTruncated) {
  Scene scene = sceneOf(worldOf({solidcast::InfinitePlane{{0, 0, 0}, {0, 0, 1}}}));
  scene.width = scene.height = 1;  // straight on: the cosine is 1
  scene.integrator = solidcast::RayCastingDistIntegrator{{1.5, -0.5, 0.5}, 0, {1.5, -0.5, 0.5}, 1};
  const Band band = renderWhole(scene, jobOf(scene, {.rgb8 = true, .radiance = true}), Precision::f64);
  EXPECT_EQ(band.rgb8, (std::vector<std::uint8_t>{255, 0, 127}));
  EXPECT_EQ(band.radiance, (std::vector<float>{1.5, -0.5, 0.5}));
}

TEST(Render, BandsComeInOrderAndStaySmall) {
  Scene scene = smallCourseScene();
  RenderJob job = jobOf(scene, allChannels());
  job.width = 40000, job.height = 100;  // 59 bytes a pixel: 28 rows a band
  job.crop = {0, 20, 40000, 60};
  int next = 0, bands = 0, reported = 0;
  render(
      scene, job, Precision::f32,
      [&](Band& band) {
        EXPECT_EQ(band.firstRow, next);
        EXPECT_LE(std::size_t(59) * band.width * band.rows, std::size_t(64) << 20);
        RenderJob lastRow = job;
        lastRow.crop = {17000, 20 + next + band.rows - 1, 1, 1};
        EXPECT_EQ(band.distance[std::size_t(band.rows - 1) * band.width + 17000],
                  renderWhole(scene, lastRow, Precision::f32).distance[0]);
        next += band.rows;
        ++bands;
      },
      2,
      [&](int done, int total) {
        EXPECT_EQ(done, ++reported);
        EXPECT_EQ(total, 60);
      });
  EXPECT_EQ(next, 60);
  EXPECT_EQ(bands, 3);
  EXPECT_EQ(reported, 60);
}

TEST(Render, RefusesImpossibleJobs) {
  const Scene scene = smallCourseScene();
  const auto expectRefused = [&](auto change, const std::string& message) {
    RenderJob job = jobOf(scene, {.rgb8 = true});
    change(job);
    try {
      renderWhole(scene, job, Precision::f64);
      ADD_FAILURE() << "not refused: " << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Exit::usage);
      EXPECT_EQ(error.what(), message);
    }
  };
  expectRefused([](RenderJob& job) { job.width = 0; }, "image size 0x120: expected at least 1x1");
  expectRefused([](RenderJob& job) { job.height = -5; }, "image size 160x-5: expected at least 1x1");
  expectRefused([](RenderJob& job) { job.samples = 0; }, "samples 0: expected at least 1");
  for (const Crop& crop : {Crop{-1, 0, 5, 5}, Crop{0, 0, 161, 5}, Crop{100, 0, 61, 5}, Crop{0, 118, 5, 3},
                           Crop{0, 0, 5, 0}, Crop{2147483647, 0, 2147483647, 5}})
    expectRefused([&](RenderJob& job) { job.crop = crop; },
                  "crop " + std::to_string(crop.x) + "," + std::to_string(crop.y) + "," + std::to_string(crop.width) +
                      "," + std::to_string(crop.height) + ": expected a part of the image of 160x120");
}

TEST(Render, AnExceptionInARowReachesTheCaller) {
  const Scene scene = smallCourseScene();
  EXPECT_THROW(render(
                   scene, jobOf(scene, {.rgb8 = true}), Precision::f64, [](Band&) {}, 2,
                   [](int done, int) {
                     if (done == 7) throw Error(Exit::output, "enough");
                   }),
               Error);
}

TEST(Render, OrthographicScalesAreFullExtents) {
  Scene scene = sceneOf(worldOf({solidcast::InfinitePlane{{0, 0, 1}, {0, 0, 1}}}));
  scene.camera = solidcast::OrthographicCamera{{5, 6, 7}, {0, 0, -2}, {0, 3, 1}, 8, 4};
  scene.width = 4, scene.height = 2;
  const Band band = renderWhole(scene, jobOf(scene, {.distance = true, .position = true}), Precision::f64);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 4; ++i) {
      const int pixel = j * 4 + i;
      EXPECT_EQ(band.distance[pixel], 6);
      EXPECT_FLOAT_EQ(band.position[3 * pixel], 5 - 4 + 2 * (i + 0.5f));
      EXPECT_FLOAT_EQ(band.position[3 * pixel + 1], 6 + 2 - 2 * (j + 0.5f));
    }
}

TEST(Render, PerspectiveOpensByItsAngles) {
  Scene scene = sceneOf(worldOf({solidcast::InfinitePlane{{0, 0, 9}, {0, 0, 1}}}));
  scene.camera = solidcast::PerspectiveCamera{{0, 0, 10}, {0, 0, -3}, {0, 2, 5}, 60, 90};
  scene.width = 5, scene.height = 3;
  const Band band = renderWhole(scene, jobOf(scene, {.distance = true, .position = true}), Precision::f64);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 5; ++i) {
      const double x = (2 * (i + 0.5) / 5 - 1) * 1, y = (1 - 2 * (j + 0.5) / 3) * std::tan(M_PI / 6);
      EXPECT_NEAR(band.position[3 * (j * 5 + i)], x, 1e-6);
      EXPECT_NEAR(band.position[3 * (j * 5 + i) + 1], y, 1e-6);
      EXPECT_NEAR(band.distance[j * 5 + i], std::sqrt(1 + x * x + y * y), 1e-6);
    }
}

TEST(Render, EnvironmentIsLongitudeAndLatitude) {
  // From the middle of a unit sphere the position is the direction.
  Scene scene = sceneOf(worldOf({solidcast::Sphere{{0, 0, 0}, 1}}));
  scene.camera = solidcast::EnvironmentCamera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 180, 360};
  scene.width = 8, scene.height = 4;
  const Band band = renderWhole(scene, jobOf(scene, {.position = true}), Precision::f64);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 8; ++i) {
      const double theta = (2 * (i + 0.5) / 8 - 1) * M_PI, phi = (1 - 2 * (j + 0.5) / 4) * M_PI / 2;
      const float* p = &band.position[3 * (j * 8 + i)];
      EXPECT_NEAR(p[0], std::cos(phi) * std::sin(theta), 1e-6);  // to the right of forward
      EXPECT_NEAR(p[1], std::sin(phi), 1e-6);
      EXPECT_NEAR(p[2], -std::cos(phi) * std::cos(theta), 1e-6);
    }
}

TEST(Precisions, AgreeToTheirLastDigits) {
  for (Scene scene : {smallCourseScene(), quadricScene()}) {
    scene.width = 160, scene.height = 120;
    const RenderJob job = jobOf(scene, allChannels());
    const Band f32 = renderWhole(scene, job, Precision::f32), f64 = renderWhole(scene, job, Precision::f64),
               f128 = renderWhole(scene, job, Precision::f128);
    EXPECT_EQ(f64.solid, f128.solid);
    int flips = 0, unequal = 0;
    for (std::size_t pixel = 0; pixel < f128.solid.size(); ++pixel) {
      if (f128.solid[pixel] >= 0) {
        // Rounded to fp32, fp64 and binary128 differ only where a rounding boundary lies between them.
        unequal += f64.distance[pixel] != f128.distance[pixel];
        ASSERT_NEAR(f64.distance[pixel], f128.distance[pixel], 1e-7 * f128.distance[pixel]);
      }
      if (f32.solid[pixel] != f128.solid[pixel]) {
        ++flips;
      } else if (f128.solid[pixel] >= 0) {
        ASSERT_NEAR(f32.distance[pixel], f128.distance[pixel], 1e-3 * f128.distance[pixel]);
      }
    }
    EXPECT_LE(unequal, 1);
    EXPECT_LE(flips, 3);
    EXPECT_NE(f32.distance, f128.distance);  // or the number type is not used
  }
}

TEST(Precisions, AreCarriedThrough) {
  // A planet of radius 1e8 seen from 1 above it: fp32 cannot tell the height, fp64 and binary128 can.
  const solidcast::World planet = worldOf({solidcast::Sphere{{0, -1e8, 0}, 1e8}});
  const QueryRay ray{{0, 1, 0}, {0, -1, 0}};
  QueryHit hit;
  cast(planet, {&ray, 1}, {&hit, 1}, Precision::f128);
  EXPECT_EQ(hit.t, 1);
  cast(planet, {&ray, 1}, {&hit, 1}, Precision::f64);
  EXPECT_NEAR(hit.t, 1, 1e-6);
  cast(planet, {&ray, 1}, {&hit, 1}, Precision::f32);
  EXPECT_NE(hit.t, 1);
  // Between fp64 and binary128: the ray passes a sphere of radius 1 at the distance 1 + 2^-80.
  const solidcast::World tangent = worldOf({solidcast::Sphere{{0, -0x1p-80, -5}, 1}});
  const QueryRay grazing{{0, 1, 0}, {0, 0, -1}};
  cast(tangent, {&grazing, 1}, {&hit, 1}, Precision::f64);
  EXPECT_EQ(hit.t, 5);
  cast(tangent, {&grazing, 1}, {&hit, 1}, Precision::f128);
  EXPECT_FALSE(hit);
}

TEST(Query, AnswersInOrderWithLimits) {
  const solidcast::World world =
      worldOf({solidcast::Triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, solidcast::Sphere{{10, 0, 0}, 2}});
  std::vector<QueryRay> rays;
  for (int i = 0; i < 5000; ++i) {
    if (i % 3 == 0) rays.push_back({{1, 2, 3}, {0, 0, -2}});
    if (i % 3 == 1) rays.push_back({{10, 0, 5 + float(i)}, {0, 0, -1}});
    if (i % 3 == 2) rays.push_back({{1, 2, 3}, {0, 0, -2}, 1.5f});  // tMax is the hit itself: no hit
  }
  std::vector<QueryHit> hits(rays.size());
  cast(world, rays, hits, Precision::f64, 2);
  for (int i = 0; i < 5000; ++i) {
    ASSERT_EQ(hits[i].index, i % 3 == 2 ? -1 : i % 3) << i;
    if (i % 3 == 0) {
      EXPECT_EQ(hits[i].t, 1.5f);
      EXPECT_EQ(hits[i].local, (std::array<float, 3>{0.25, 0.25, 0.5}));
      EXPECT_EQ(hits[i].position, (std::array<float, 3>{1, 2, 0}));
      EXPECT_EQ(hits[i].normal, (std::array<float, 3>{0, 0, 1}));
    }
    if (i % 3 == 1) { EXPECT_EQ(hits[i].t, 3 + float(i)); }
  }
  EXPECT_THROW(cast(world, rays, {hits.data(), 3}, Precision::f64), std::invalid_argument);
}

}  // namespace
}  // namespace solidcast::reference
