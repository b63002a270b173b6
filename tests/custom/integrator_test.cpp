// Users' own integrators: what they are given is right, and what is wrong with them is said.
#include <cmath>
#include <limits>

#include "tests/custom/own_glsl.h"

namespace solidcast {
namespace {

const std::string kHead = "vec3 radiance(Hit hit, Ray ray, Parameters p) ";

Scene plain(Scene scene) {
  scene.integrator = RayCastingIntegrator{};
  return scene;
}

// Everything that a hit has, against the channels of exact, which binary128 computed.
TEST_F(OwnGlsl, HitsAreThoseOfTheChannels) {
  Scene all = loaded("custom/normals.json");
  all.width = 96, all.height = 64;
  const EnvironmentCamera around{{0.9, -0.3, -0.4}, {0, 0, -1}, {0, 1, 0}, 180, 360};  // in the box
  const OrthographicCamera parallel{{0, 1, 7}, {0, -0.1, -1}, {0, 1, 0}, 8, 5};
  for (const Camera& camera : {all.camera, Camera{around}, Camera{parallel}}) {
    Scene scene = all;
    scene.camera = camera;
    scene.file = path("s.json");
    scene.integrator = CustomIntegrator{{"my.glsl", {}}};
    const Band truth =
        render(plain(scene), {.distance = true, .solid = true, .normal = true, .local = true, .position = true});
    const auto values = [&](const std::string& expression) {
      write("my.glsl", kHead + "{ return " + expression + "; }");
      return render(scene, {.radiance = true}).radiance;
    };
    const std::vector<float> normal = values("hit.normal"), local = values("hit.local"),
                             position = values("hit.position"),
                             rest = values("vec3(hit.distance, hit.cosine, float(hit.solid))"),
                             along = values("ray.origin + hit.distance * ray.direction");
    std::size_t hits = 0, normals = 0;
    for (std::size_t i = 0; i < truth.solid.size(); ++i) {
      if (truth.solid[i] < 0) {
        EXPECT_EQ(rest[3 * i + 2], 0);
        continue;
      }
      ++hits;
      ASSERT_EQ(rest[3 * i], truth.distance[i]);
      ASSERT_EQ(rest[3 * i + 2], static_cast<float>(truth.solid[i]));
      const float scale = 4e-6f * (1 + truth.distance[i]);
      bool same = true;
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
        EXPECT_NEAR(position[k], truth.position[k], scale);
        EXPECT_NEAR(along[k], truth.position[k], scale);
        EXPECT_NEAR(local[k], truth.local[k], 10 * scale);
        same = same && std::abs(normal[k] - truth.normal[k]) < scale;
      }
      normals += same;  // at a box's edge another face may win
    }
    EXPECT_GT(hits, truth.solid.size() / 3);
    EXPECT_LE(hits - normals, 3u);
  }
}

// The very colours of the built-in integrator, by the user's hand; one-sided, two-sided and with samples.
TEST_F(OwnGlsl, CosineIsThatOfCasting) {
  for (const bool twoSided : {false, true})
    for (const int samples : {1, 3})
      for (const Method method : kMethods) {
        if (samples > 1 && twoSided != (method == Method::exact)) continue;  // each once is enough
        Scene scene = loaded("custom/normals.json");
        scene.width = 80, scene.height = 50;
        scene.twoSided = twoSided;
        const Band truth = render(plain(scene), {.radiance = true}, {.method = method}, samples);
        scene.file = path("s.json");
        scene.integrator = CustomIntegrator{{"my.glsl", {}}};
        write("my.glsl", kHead + "{ return vec3(max(hit.cosine, 0.0)); }");
        const Band own = render(scene, {.radiance = true}, {.method = method}, samples);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < truth.radiance.size(); ++i)
          differ += std::abs(own.radiance[i] - truth.radiance[i]) > 2e-5f;
        EXPECT_LE(differ, 6u) << nameOf(method);  // two pixels: fp32 flips decisions at edges
      }
}

TEST_F(OwnGlsl, ParametersArriveByName) {
  const Band band = render(
      integrated(kHead + "{ return vec3(p.b, p.colour.y, p.a); }", R"({"b": 0.25, "colour": [9, 0.5, 9], "a": 3})"),
      {.radiance = true});
  const std::vector<float> last(band.radiance.end() - 3, band.radiance.end());  // the floor
  EXPECT_EQ(last, (std::vector<float>{0.25f, 0.5f, 3}));
}

TEST_F(OwnGlsl, BandsAndChannelsBesideTheColour) {
  const Scene scene = integrated(kHead + "{ return hit.normal; }");
  const Band whole = render(scene, allChannels());
  expectSame(whole, render(scene, allChannels(), {.memoryBudget = 200'000}));
  Band truth = render(plain(scene), allChannels());
  truth.rgb8 = whole.rgb8;
  truth.radiance = whole.radiance;
  expectSame(whole, truth);
}

TEST_F(OwnGlsl, ChangedFilesAndParametersAreSeen) {
  Scene scene = integrated("#include \"part.glsl\"\n" + kHead + "{ return vec3(p.a + part()); }", R"({"a": 0.25})");
  write("part.glsl", "float part() { return 0.5; }");
  const RenderJob job = jobOf(scene, {.radiance = true});
  ImageCaster caster(device(), scene, job, {});
  int modules = 0;
  device().watchModules([&](const auto&, auto, auto) { ++modules; });
  const auto colour = [&] {
    float last = 0;
    caster.render([&](Band& band) { last = band.radiance.back(); });
    return last;
  };
  EXPECT_EQ(colour(), 0.75f);
  std::get<CustomIntegrator>(scene.integrator).code.parameters[0].value = 0.125;
  caster.setScene(scene);
  EXPECT_EQ(colour(), 0.625f);
  EXPECT_EQ(modules, 0);  // another value compiles nothing
  write("part.glsl", "float part() { return 0.25; }");
  caster.setScene(scene);
  EXPECT_EQ(colour(), 0.375f);
  EXPECT_EQ(modules, 1);
  const Scene other = plain(scene);
  caster.setScene(other);
  EXPECT_NE(colour(), 0.375f);
  caster.setScene(scene);
  EXPECT_EQ(colour(), 0.375f);
  device().watchModules({});
}

TEST_F(OwnGlsl, NanIsCountedAndMagenta) {
  const Scene scene = integrated(kHead + "{ return vec3(0.5, hit.solid == 1u ? sqrt(-hit.distance) : 0.5, 0.5); }");
  const Band band = render(scene, {.rgb8 = true, .solid = true});
  std::uint64_t balls = 0;
  for (std::size_t i = 0; i < band.solid.size(); ++i) {
    const std::uint8_t* c = &band.rgb8[3 * i];
    if (band.solid[i] != 1) continue;
    ++balls;
    EXPECT_TRUE(c[0] == 255 && c[1] == 0 && c[2] == 255);
  }
  EXPECT_GT(balls, 100u);
  EXPECT_EQ(stats_.nanColours, balls);
}

TEST_F(OwnGlsl, WhatIsWrongIsSaidWithItsPlace) {
  const std::string my = path("my.glsl");
  const std::string expected = ", expected vec3 radiance(Hit hit, Ray ray, Parameters p)";
  EXPECT_EQ(complaint(integrated("// radiance(\n"), Exit::shader),
            my + ":1: error: there is no function radiance" + expected);
  EXPECT_EQ(complaint(integrated("\n\nvec3 radiance(Hit hit, Ray ray) { return vec3(0); }"), Exit::shader),
            my + ":3: error: radiance is declared otherwise" + expected);
  EXPECT_EQ(complaint(integrated("\nfloat radiance(Hit hit, Ray ray, Parameters p) { return 0; }"), Exit::shader),
            my + ":2: error: radiance is declared otherwise" + expected);
  EXPECT_TRUE(
      complaint(integrated("\n" + kHead + "{\n  return vec3(0)\n}"), Exit::shader).starts_with(my + ":4: error: "));
  EXPECT_TRUE(complaint(integrated("\n" + kHead + "{ return vec3(p.strength); }"), Exit::shader)
                  .starts_with(my + ":2: error: 'strength'"));
  write("part.glsl", "float part() {\n  return vec2(1.0);\n}");
  EXPECT_TRUE(complaint(integrated("#include \"part.glsl\"\n" + kHead + "{ return vec3(part()); }"), Exit::shader)
                  .starts_with(path("part.glsl") + ":2: error: "));
  EXPECT_EQ(complaint(scene(R"("integrator": {"type": "custom", "glsl": "none.glsl"})"), Exit::shader),
            path("none.glsl") + ": error: cannot be read, expected a file of GLSL");
}

TEST_F(OwnGlsl, EndlessLoopsAreStoppedAndNamed) {
  const std::string tail = ": error: a pixel's loops went on for more than 8191 rounds here, expected them to end";
  const std::string loops[] = {"for (;;) x *= 0.5;", "while (x >= 0.0) x *= 0.5;", "do x *= 0.5; while (x >= 0.0);",
                               "for (int i = 0; i < 100; ++i)\n    for (int j = 0; j >= 0; j = j % 7) x *= 0.5;"};
  for (const std::string& loop : loops) {
    const int line = loop[0] == 'f' && loop[5] == 'i' ? 4 : 3;
    EXPECT_EQ(
        complaint(integrated(kHead + "{\n  float x = hit.distance;\n" + loop + "\n  return vec3(x);\n}"), Exit::shader),
        path("my.glsl") + ":" + std::to_string(line) + tail);
  }
  write("part.glsl", "\nfloat part(float x) { while (x >= 0.0) x *= 0.5; return x; }");
  EXPECT_EQ(
      complaint(integrated("#include \"part.glsl\"\n" + kHead + "{ return vec3(part(hit.distance)); }"), Exit::shader),
      path("part.glsl") + ":2" + tail);
  // As many rounds as are allowed (the last one only finds the end) are all made, on every pixel.
  EXPECT_EQ(
      complaint(integrated(kHead + "{ float n = 0.0; while (n < 8191.0) n += 1.0; return vec3(n); }"), Exit::shader),
      path("my.glsl") + ":1" + tail);
  const Scene enough = integrated(kHead + "{ float n = 0.0; while (n < 8190.0) n += 1.0; return vec3(n); }");
  const Band band = render(enough, {.radiance = true, .solid = true});
  for (std::size_t i = 0; i < band.solid.size(); ++i) ASSERT_EQ(band.radiance[3 * i], band.solid[i] < 0 ? 0.f : 8190.f);
}

}  // namespace
}  // namespace solidcast
