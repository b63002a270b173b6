// How work is cut up must not show: crops, bands, samples, portions of the solids, buffers, repeated calls.
#include <cmath>
#include <limits>

#include "reference_cpu/reference.h"
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

Scene course(int width, int height) {
  Scene scene = aSolids();
  scene.width = width;
  scene.height = height;
  return scene;
}

template <class Value>
std::vector<Value> cut(const std::vector<Value>& whole, int width, const Crop& crop) {
  const std::size_t per = whole.size() / static_cast<std::size_t>(width) / 75;
  std::vector<Value> part;
  for (int row = crop.y; row < crop.y + crop.height; ++row) {
    const auto begin =
        whole.begin() + static_cast<std::ptrdiff_t>((static_cast<std::size_t>(row * width + crop.x)) * per);
    part.insert(part.end(), begin, begin + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(crop.width) * per));
  }
  return part;
}

class Plumbing : public OnDevice, public testing::WithParamInterface<Method> {};
INSTANTIATE_TEST_SUITE_P(, Plumbing, testing::ValuesIn(kMethods),
                         [](const auto& info) { return std::string(nameOf(info.param)); });

TEST_P(Plumbing, ACropIsThePartOfTheWholeByteForByte) {
  const Scene scene = course(101, 75);
  RenderJob job = jobOf(scene, allChannels());
  for (const int samples : {1, 2}) {
    job.samples = samples;
    job.crop = {};
    const Band whole = renderWhole(device(), scene, job, {.method = GetParam()});
    for (const Crop& crop : {Crop{0, 0, 101, 75}, Crop{37, 41, 50, 33}, Crop{100, 74, 1, 1}, Crop{1, 30, 99, 1}}) {
      job.crop = crop;
      const Band part = renderWhole(device(), scene, job, {.method = GetParam()});
      Band expected;
      expected.rgb8 = cut(whole.rgb8, 101, crop), expected.radiance = cut(whole.radiance, 101, crop);
      expected.distance = cut(whole.distance, 101, crop), expected.solid = cut(whole.solid, 101, crop);
      expected.normal = cut(whole.normal, 101, crop), expected.local = cut(whole.local, 101, crop);
      expected.position = cut(whole.position, 101, crop);
      expectSame(part, expected, std::to_string(crop.x) + ", " + std::to_string(crop.y));
    }
  }
}

TEST_P(Plumbing, BandsAndRepetitionDoNotShow) {
  const Scene scene = course(101, 75);
  for (const int samples : {1, 2}) {
    RenderJob job = jobOf(scene, allChannels());
    job.samples = samples;
    const Band whole = renderWhole(device(), scene, job, {.method = GetParam()});
    CastOptions small{.method = GetParam(), .memoryBudget = 120'000};
    ImageCaster caster(device(), scene, job, small);
    for (int time = 0; time < 2; ++time) {
      Band all;
      int bands = 0;
      caster.render([&](Band& band) {
        ++bands;
        EXPECT_EQ(band.firstRow, all.rows);
        all.rows += band.rows;
        const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
        append(all.rgb8, band.rgb8), append(all.radiance, band.radiance), append(all.distance, band.distance);
        append(all.solid, band.solid), append(all.normal, band.normal), append(all.local, band.local);
        append(all.position, band.position);
      });
      EXPECT_GT(bands, 3);
      EXPECT_EQ(all.rows, 75);
      expectSame(all, whole, "time " + std::to_string(time));
    }
  }
}

TEST_P(Plumbing, SamplesIntegratorsAndSidesAreTheReferences) {
  for (const char* name : {"a_solids.json", "orthographic.json", "environment.json", "quadrics.json"}) {
    Scene scene = loaded(name);
    scene.width = 80, scene.height = 60;
    const RayCastingDistIntegrator dist{{1, 0.2, 0}, 4, {0.2, 1, 0}, 12};
    for (const int samples : {1, 2, 3}) {
      scene.integrator = samples == 2 ? Integrator{dist} : Integrator{RayCastingIntegrator{}};
      RenderJob job = jobOf(scene, {.rgb8 = true});
      job.samples = samples;
      job.twoSided = samples == 3;
      const Band gpu = renderWhole(device(), scene, job, {.method = GetParam()});
      Band cpu;
      reference::render(scene, job, reference::Precision::f64,
                        [&](Band& b) { cpu.rgb8.insert(cpu.rgb8.end(), b.rgb8.begin(), b.rgb8.end()); });
      ASSERT_EQ(gpu.rgb8.size(), cpu.rgb8.size());
      int beyond = 0, lit = 0;
      for (std::size_t i = 0; i < cpu.rgb8.size(); ++i) {
        beyond += std::abs(int(gpu.rgb8[i]) - int(cpu.rgb8[i])) > 1;
        lit += cpu.rgb8[i] > 0;
      }
      EXPECT_GT(lit, 2000) << name;
      // exact decides as the truth does, and so nearly always does fp64; the others may flip single samples at edges.
      EXPECT_LE(beyond, GetParam() == Method::exact ? 0 : 3 * 3) << name << ", " << samples << " samples";
    }
  }
}

// llvmpipe ends a loop after 65,535 rounds without a word: the solids are searched in portions.
/// Those that are carried were optimised when they were built.
TEST_P(Plumbing, ShadersCompiledNowAreAsCarriedOnes) {
  for (const std::string name : {"a_solids.json", "quadrics.json", "environment.json", "orthographic.json"}) {
    const Scene scene = loaded(name);
    RenderJob job = jobOf(scene, allChannels());
    job.width = 101, job.height = 75;
    CastOptions options{.method = GetParam()};
    const Band carried = renderWhole(device(), scene, job, options);
    options.shaderFolder = SOLIDCAST_SOURCE_DIR "/shaders";
    expectSame(renderWhole(device(), scene, job, options), carried, name);
  }
}

TEST_P(Plumbing, MoreThan65535Solids) {
  Scene scene;
  scene.width = scene.height = 16;
  scene.camera = PerspectiveCamera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 40, 40};
  constexpr int solids = 70'000;
  for (int i = 0; i < solids - 3; ++i)  // all of them out of sight, far behind
    scene.world.solids.push_back({"", Sphere{{0.01 * (i % 1000), 0.01 * (i / 1000), 50}, 4}, 0});
  scene.world.solids.push_back({"", InfinitePlane{{0, 0, -9}, {0, 0, 1}}, 0});
  scene.world.solids.push_back({"", Sphere{{0, 0, -6}, 1}, 0});
  scene.world.solids.push_back({"", Sphere{{0, 0, -5}, 0.5}, 0});
  for (int i = 0; i < solids; ++i) scene.world.groups[0].members.push_back({false, static_cast<std::uint32_t>(i)});
  CastStats stats;
  const Band band = renderWhole(device(), scene, jobOf(scene, {.distance = true, .solid = true, .normal = true}),
                                {.method = GetParam()}, &stats);
  Scene few = scene;
  few.world.solids = {};
  for (std::size_t i = scene.world.solids.size() - 3; i < scene.world.solids.size(); ++i)
    few.world.solids.push_back(scene.world.solids[i]);
  const Band expected =
      renderWhole(device(), few, jobOf(few, {.distance = true, .solid = true, .normal = true}), {.method = GetParam()});
  int seen[3] = {0, 0, 0};
  for (std::size_t i = 0; i < band.solid.size(); ++i) {
    ASSERT_EQ(band.solid[i], expected.solid[i] + solids - 3) << i;
    ASSERT_EQ(band.distance[i], expected.distance[i]) << i;
    ++seen[expected.solid[i]];
  }
  EXPECT_EQ(band.normal, expected.normal);
  for (const int count : seen) EXPECT_GT(count, 3);
  const std::vector<QueryRay> rays{{{0, 0, 0}, {0, 0, -1}}, {{0, 0, -7.5f}, {0, 0, 1}}, {{0, 0, 0}, {0.3f, 0, -1}}};
  const auto hits = castAll(device(), scene.world, rays, {.method = GetParam()});
  EXPECT_EQ(hits[0].index, solids - 1);
  EXPECT_EQ(hits[0].t, 4.5f);
  EXPECT_EQ(hits[1].index, solids - 2);
  EXPECT_EQ(hits[1].t, 0.5f);
  EXPECT_EQ(hits[2].index, solids - 3);
}

// Beyond 4096 solids the records lie in storage buffers: another pipeline, the same answers.
TEST_P(Plumbing, StorageBuffersAreAsUniformOnes) {
  const Scene few = course(60, 45);
  Scene many = few;
  for (int i = 0; i < 4200; ++i) {  // behind the camera
    many.world.groups[0].members.push_back({false, static_cast<std::uint32_t>(many.world.solids.size())});
    many.world.solids.push_back({"", Sphere{{1e-3 * i, 0, 1000}, 100}, 0});
  }
  for (const Camera& camera : {few.camera, loaded("orthographic.json").camera, loaded("environment.json").camera}) {
    Scene a = few, b = many;
    a.camera = b.camera = camera;
    const Channels channels{.distance = true, .solid = true, .normal = true, .local = true, .position = true};
    CastStats statsA, statsB;
    const Band x = renderWhole(device(), a, jobOf(a, channels), {.method = GetParam()}, &statsA);
    const Band y = renderWhole(device(), b, jobOf(b, channels), {.method = GetParam(), .plan = Plan::storage}, &statsB);
    EXPECT_EQ(statsA.modules.at(0).find("storage"), std::string::npos) << statsA.modules[0];
    EXPECT_NE(statsB.modules.at(0).find("storage"), std::string::npos) << statsB.modules[0];
    int changed = 0;  // an environment or orthographic camera may see the others
    for (std::size_t i = 0; i < x.solid.size(); ++i) {
      if (y.solid[i] >= static_cast<int>(few.world.solids.size())) {
        ++changed;
        continue;
      }
      ASSERT_EQ(x.solid[i], y.solid[i]);
      ASSERT_EQ(x.distance[i], y.distance[i]);
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
        ASSERT_EQ(x.normal[k], y.normal[k]);
        ASSERT_EQ(x.local[k], y.local[k]);
        ASSERT_EQ(x.position[k], y.position[k]);
      }
    }
    EXPECT_LT(changed, 10);
  }
}

TEST_P(Plumbing, TMaxIsStrict) {
  const World world = worldOf({Sphere{{0, 0, -5}, 1}, InfinitePlane{{0, 0, -8}, {0, 0, 1}}});
  const float at = 4, above = std::nextafter(at, 5.f), below = std::nextafter(at, 3.f);
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<QueryRay> rays;
  for (const float tMax : {at, above, below, 0.f, 1e-30f, 8.f, infinity, std::numeric_limits<float>::max()})
    rays.push_back({{0, 0, 0}, {0, 0, -1}, tMax});
  const auto hits = castAll(device(), world, rays, {.method = GetParam()});
  const int expected[] = {-1, 0, -1, -1, -1, 0, 0, 0};
  for (std::size_t i = 0; i < rays.size(); ++i) {
    EXPECT_EQ(hits[i].index, expected[i]) << "tMax " << rays[i].tMax;
    if (expected[i] == 0) { EXPECT_EQ(hits[i].t, 4.f); }
  }
}

// tMax at the hit and a few ulps around it, where t is no fp32 number.
TEST_F(OnDevice, TMaxAroundTheHitIsDecidedExactly) {
  for (const oracle::Kind kind : oracle::kKinds) {
    for (const char* family : {"generic", "lattice", "length"}) {
      const oracle::Batch batch = oracle::makeBatches(kind, family, 600, 31, 600)[0];
      const World world = worldOf({batch.shape});
      std::vector<QueryRay> rays;
      for (const QueryRay& ray : batch.rays) {
        const oracle::Truth truth = oracle::intersect(batch.shape, oracle::exactRay(ray));
        if (!truth.hit || oracle::beyondFloat(truth.t)) continue;
        QueryRay limited = ray;
        const auto t = static_cast<float>(truth.t);
        for (const float tMax : {t, std::nextafter(t, 0.f), std::nextafter(t, INFINITY), 0.5f * t, 2 * t}) {
          limited.tMax = tMax;
          if (std::isfinite(tMax)) rays.push_back(limited);
        }
      }
      for (const Arithmetic arithmetic : {Arithmetic::fp64, Arithmetic::df32}) {
        Tally tally;
        castAndCompare(device(), world, rays, {.arithmetic = arithmetic}, tally);
        EXPECT_TRUE(tally.exact()) << oracle::nameOf(kind) << " " << family << ": " << text(tally);
        EXPECT_GT(tally.hits, 20u) << oracle::nameOf(kind) << " " << family;
        EXPECT_LT(tally.hits, tally.rays);
      }
    }
  }
}

TEST_P(Plumbing, RaysStreamInBlocks) {
  const World world = aSolids().world;
  std::vector<QueryRay> rays(70'001);  // more than one block of 65,536
  for (std::size_t i = 0; i < rays.size(); ++i)
    rays[i] = {{0, 0, 10},
               {0.6f * std::sin(0.01f * static_cast<float>(i)), 0.4f * std::cos(0.037f * static_cast<float>(i)), -1}};
  QueryCaster caster(device(), world, {.method = GetParam()});
  std::vector<QueryHit> all(rays.size()), part(101), again(rays.size());
  caster.cast(rays, all);
  caster.cast(std::span(rays).subspan(65'500, 101), part);
  for (std::size_t i = 0; i < part.size(); ++i) {
    ASSERT_EQ(part[i].index, all[65'500 + i].index);
    ASSERT_EQ(part[i].t, all[65'500 + i].t);
    ASSERT_EQ(part[i].normal, all[65'500 + i].normal);
  }
  caster.cast({}, {});
  caster.cast(rays, again);
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(all[i].index, again[i].index);
    ASSERT_EQ(all[i].t, again[i].t);
    hits += all[i].index >= 0;
  }
  EXPECT_GT(hits, 30'000);
}

}  // namespace
}  // namespace solidcast
