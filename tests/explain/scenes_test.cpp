// Every kind of solid, camera, method and arithmetic: nothing throws, the explanation says what the picture shows, and its
// stages end at the device's very bits.
#include <nlohmann/json.hpp>

#include "host/error.h"
#include "tests/explain/fixture.h"

namespace solidcast::explain {
namespace {

Scene withCamera(Scene scene, int camera) {
  const auto center = std::visit([](const auto& c) { return c.center; }, scene.camera);
  const auto forward = std::visit([](const auto& c) { return c.forward; }, scene.camera);
  const auto up = std::visit([](const auto& c) { return c.up; }, scene.camera);
  if (camera == 0) scene.camera = PerspectiveCamera{center, forward, up, 45, 60};
  if (camera == 1) scene.camera = EnvironmentCamera{center, forward, up, 120, 200};
  if (camera == 2) scene.camera = OrthographicCamera{center, forward, up, 15, 20};
  return scene;
}

struct Way {
  Method method;
  Arithmetic arithmetic;
};
constexpr Way kWays[] = {{Method::naive, Arithmetic::automatic},
                         {Method::fast, Arithmetic::automatic},
                         {Method::exact, Arithmetic::fp64},
                         {Method::exact, Arithmetic::df32}};

/// Explains pixels of a picture and holds them against it.
void compare(gpu::Device& device, const Scene& scene, Way way, int step, std::array<int, kindCount>& kinds) {
  const RenderJob job{scene.width, scene.height,   {},
                      1,           scene.twoSided, {.rgb8 = true, .distance = true, .solid = true}};
  const CastOptions options{.method = way.method, .arithmetic = way.arithmetic};
  const Band whole = renderWhole(device, scene, job, options);
  for (std::size_t pixel = static_cast<std::size_t>(step) / 2; pixel < whole.solid.size();
       pixel += static_cast<std::size_t>(step)) {
    const int x = static_cast<int>(pixel) % scene.width, y = static_cast<int>(pixel) / scene.width;
    const std::string what = scene.file + " " + std::to_string(x) + "," + std::to_string(y) + " " + nameOf(way.method);
    const Explanation e = explainPixel(device, scene, job, options, reference::Precision::f64, x, y);
    EXPECT_TRUE(e.followed) << what << "\n" << asText(e);
    EXPECT_EQ(e.gpu.index, whole.solid[pixel]) << what;
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(e.gpu.levels[c], whole.rgb8[3 * pixel + c]) << what;
    EXPECT_TRUE(e.gpu.right || way.method != Method::exact) << what << ": " << e.gpu.fault;
    for (const Candidate& c : e.candidates)
      for (int kind = 0; kind < kindCount; ++kind) kinds[static_cast<std::size_t>(kind)] += c.kind == kindLabel(kind);
    if (e.gpu.index >= 0) {
      EXPECT_EQ(static_cast<float>(e.gpu.t), whole.distance[pixel]) << what;
      ASSERT_NE(candidate(e, e.gpu.index), nullptr) << what;
      EXPECT_TRUE(candidate(e, e.gpu.index)->matters) << what;
    }
    EXPECT_EQ(nlohmann::json::parse(asJson(e))["gpu"]["index"], e.gpu.index) << what;
  }
}

TEST_F(Explain, EveryCameraAndMethodOnEveryKind) {
  // All seven kinds: the course's six and quadrics beside them.
  Scene scene = loaded("a_solids.json");
  for (const SolidEntry& solid : loaded("quadrics.json").world.solids) {
    scene.world.groups[0].members.push_back({false, static_cast<std::uint32_t>(scene.world.solids.size())});
    scene.world.solids.push_back({solid.name + "'", solid.shape, 0});
  }
  scene.width = 48, scene.height = 36;
  std::array<int, kindCount> kinds{};
  for (int camera = 0; camera < 3; ++camera)
    for (const Way& way : kWays) {
      if (way.arithmetic == Arithmetic::df32 && camera == 1) continue;  // its pipelines take a second each
      compare(device(), withCamera(scene, camera), way, way.arithmetic == Arithmetic::df32 ? 1700 : 863, kinds);
    }
  for (const int seen : kinds) EXPECT_GT(seen, 0);
}

// The truth's colours come from t and normal in binary128 by code of their own.
TEST_F(Explain, TruthHasTheExactColours) {
  Scene scene = loaded("a_solids.json");
  scene.width = 48, scene.height = 36;
  const std::variant<RayCastingIntegrator, RayCastingDistIntegrator> integrators[] = {
      RayCastingIntegrator{}, RayCastingDistIntegrator{{1, 0.2, 0}, 4, {0, 1, 0.4}, 12}};
  for (const auto& integrator : integrators) {
    std::visit([&](const auto& one) { scene.integrator = one; }, integrator);
    int coloured = 0;
    for (int x = 1; x < scene.width; x += 6)
      for (int y = 1; y < scene.height; y += 6) {
        const RenderJob job{scene.width, scene.height, {}, 1, false, {}};
        const Explanation e = explainPixel(device(), scene, job, {}, reference::Precision::f64, x, y);
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_NEAR(e.truth.radiance[c], e.gpu.radiance[c], 4e-6) << x << "," << y;
          EXPECT_NEAR(e.truth.levels[c], e.gpu.levels[c], 1) << x << "," << y;
          coloured += e.truth.levels[c] > 0 && e.truth.levels[c] < 255;
        }
      }
    EXPECT_GT(coloured, 40);
  }
}

TEST_F(Explain, BundledScenes) {
  std::array<int, kindCount> kinds{};
  for (const std::string& name : bundledScenes()) {
    Scene scene = loaded(name);
    scene.world.customSolids.clear();  // the reference runs no GLSL
    if (std::holds_alternative<CustomIntegrator>(scene.integrator)) scene.integrator = RayCastingIntegrator{};
    scene.width = 64, scene.height = 48;
    for (const Way& way : {kWays[0], kWays[1], kWays[2]}) compare(device(), scene, way, 3001, kinds);
  }
}

TEST_F(Explain, ALargeSceneListsTwentyCandidates) {
  std::vector<Shape> stack;
  for (int i = 0; i < 2000; ++i) stack.push_back(Sphere{{0, 0, -10. - 3 * (1999 - i)}, 1});
  for (int i = 0; i < 3000; ++i) stack.push_back(Sphere{{100. + i, 50, -10}, 1});  // far beside
  const Explanation e = at(onePixel(stack, {0, 0, 0}, {0, 0, -1}), 0, 0, Method::exact);
  EXPECT_TRUE(e.followed);
  EXPECT_EQ(e.gpu.index, 1999);
  EXPECT_EQ(e.candidates.size(), kMostCandidates);
  EXPECT_EQ(e.further, 2000 - kMostCandidates);
  EXPECT_EQ(e.clear, 3000u);
  for (std::size_t i = 0; i < e.candidates.size(); ++i)
    EXPECT_EQ(e.candidates[i].index, 1999 - static_cast<std::int32_t>(i));
}

TEST_F(Explain, APixelOutsideIsRefused) {
  const Scene scene = loaded("a_solids.json");
  for (const auto& [x, y] : {std::pair{640, 0}, {0, 480}, {-1, 0}, {0, -1}}) {
    try {
      at(scene, x, y, Method::exact);
      ADD_FAILURE() << x << "," << y;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Exit::usage);
      EXPECT_NE(std::string(error.what()).find("expected 0,0 to 639,479"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace solidcast::explain
