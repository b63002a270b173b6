// Custom solids: the torus against its own equation in binary128, and how custom and built-in solids share a picture.
#include <quadmath.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "host/cast/records.h"
#include "host/error.h"
#include "tests/custom/own_glsl.h"

namespace solidcast {
namespace {

using Polynomial = std::vector<__float128>;  // from x^0 up

__float128 value(const Polynomial& f, __float128 x) {
  __float128 sum = 0;
  for (auto c = f.rbegin(); c != f.rend(); ++c) sum = sum * x + *c;
  return sum;
}

/// All roots between a and b that change the sign, in order: between those of the derivative, by halving.
Polynomial roots(const Polynomial& f, __float128 a, __float128 b) {
  if (f.size() < 2) return {};
  Polynomial derivative;
  for (std::size_t i = 1; i < f.size(); ++i) derivative.push_back(f[i] * static_cast<int>(i));
  Polynomial cuts = roots(derivative, a, b), found;
  cuts.insert(cuts.begin(), a);
  cuts.push_back(b);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    __float128 low = cuts[i], high = cuts[i + 1];
    const bool above = value(f, low) > 0;
    if ((value(f, high) > 0) == above) continue;
    for (int round = 0; round < 120; ++round) {
      const __float128 middle = (low + high) / 2;
      ((value(f, middle) > 0) == above ? low : high) = middle;
    }
    found.push_back(low);
  }
  return found;
}

Polynomial times(const Polynomial& a, const Polynomial& b) {
  Polynomial product(a.size() + b.size() - 1);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) product[i + j] += a[i] * b[j];
  return product;
}

/// (|q|^2 + R^2 - r^2)^2 - 4 R^2 (|q|^2 - (q.a)^2) along the ray, q from the centre.
Polynomial torus(const RayQ& ray, const CustomCode& code, __float128 radius) {
  const auto triple = [&](const char* name) {
    for (const GlslParameter& p : code.parameters)
      if (p.name == name) return V3(std::get<Triple>(p.value));
    return V3{};
  };
  const V3 q = ray.origin - triple("center"), axis = normalized(triple("axis"));
  const __float128 large = std::get<double>(code.parameters[0].value);
  const Polynomial squared = {dot(q, q), 2 * dot(q, ray.direction), 1},
                   along = {dot(q, axis), dot(ray.direction, axis)};
  Polynomial inner = squared, flat = squared;
  inner[0] += large * large - radius * radius;
  const Polynomial alongSquared = times(along, along);
  for (std::size_t i = 0; i < 3; ++i) flat[i] -= alongSquared[i];
  Polynomial f = times(inner, inner);
  for (std::size_t i = 0; i < 3; ++i) f[i] -= 4 * large * large * flat[i];
  return f;
}

TEST_F(OwnGlsl, TorusIsWhatItsEquationSays) {
  Scene scene = loaded("custom/torus.json");
  scene.world = {{}, {GroupEntry{}}, {scene.world.customSolids[0]}};
  scene.width = 84, scene.height = 56;
  const CustomCode& code = scene.world.customSolids[0].code;
  ASSERT_EQ(code.parameters[0].name, "R");
  const double r = std::get<double>(code.parameters[3].value);
  ASSERT_EQ(code.parameters[3].name, "r");
  auto& camera = std::get<PerspectiveCamera>(scene.camera);
  // As it is; from far away through a long lens; from inside the tube; along a wall, through the hole.
  const PerspectiveCamera views[] = {camera,
                                     {{0, 1000, 4000}, {0, -0.25, -1}, {0, 1, 0}, 0.05, 0.075},
                                     {{-0.6, 0.3 + 0.894, -0.447}, {1, -0.4, 0.3}, {0, 1, 0}, 100, 120},
                                     {{-0.6, 0.3, 0.001}, {1, 0, 0.001}, {0, 1, 0}, 90, 110}};
  for (const PerspectiveCamera& view : views) {
    camera = view;
    const Band band = render(scene, {.distance = true, .solid = true, .normal = true});
    const PixelRays rays(scene, scene.width, scene.height, 1);
    // What a ray that starts at the camera is in fp32: its direction is off by an ulp, and so is its end.
    const double off = 4e-7 * (static_cast<double>(length(V3(view.center))) + 2);
    std::size_t hits = 0;
    for (int y = 0; y < scene.height; ++y)
      for (int x = 0; x < scene.width; ++x) {
        const auto i = static_cast<std::size_t>(y * scene.width + x);
        const RayQ ray = rays.ray(x, y);
        const auto first = [&](double radius) {
          const Polynomial all = roots(torus(ray, code, radius), 0, 10000);
          return all.empty() ? std::numeric_limits<double>::infinity() : static_cast<double>(all[0]);
        };
        // Where a torus a little thinner or thicker says otherwise, fp32 may say either.
        const double exact = first(r), thin = first(r - 20 * off), thick = first(r + 20 * off);
        const double slack = std::max(std::abs(thin - exact), std::abs(thick - exact)) + off;
        if (std::isinf(exact) && std::isinf(thick)) ASSERT_EQ(band.solid[i], -1) << x << ' ' << y;
        if (!std::isfinite(slack)) continue;
        ASSERT_EQ(band.solid[i], 0) << x << ' ' << y << ' ' << exact << ' ' << view.center[2];
        ASSERT_NEAR(band.distance[i], exact, slack) << x << ' ' << y;
        ++hits;
      }
    EXPECT_GT(hits, 250u);
  }
}

// The search does not know of users' code: its module is word for word the one that it is without.
TEST_F(OwnGlsl, TheSearchsModuleStaysTheSame) {
  const auto modulesOf = [&](const Scene& scene, const Channels& channels, Method method) {
    std::vector<std::vector<std::uint32_t>> modules;
    device().watchModules([&](const auto&, auto, auto given) { modules.emplace_back(given.begin(), given.end()); });
    const RenderJob job = jobOf(scene, channels);
    const CastOptions options{.method = method};
    ImageCaster caster(device(), scene, job, options);
    device().watchModules({});
    return modules;
  };
  for (const Method method : kMethods) {
    Scene scene = loaded("custom/torus.json");
    const auto with = modulesOf(scene, {.rgb8 = true}, method);
    EXPECT_EQ(with.size(), 4u);  // search, surfaces, torus once for both rings, shade
    scene.world.customSolids.clear();
    const auto without = modulesOf(scene, {.distance = true, .solid = true}, method);
    ASSERT_EQ(without.size(), 1u);
    EXPECT_EQ(with[0], without[0]);
    EXPECT_EQ(modulesOf(scene, {.rgb8 = true}, method).size(), 1u);
    scene.integrator = CustomIntegrator{{"normals.glsl", {}}};
    const auto own = modulesOf(scene, {.rgb8 = true}, method);
    EXPECT_EQ(own.size(), 3u);
    EXPECT_EQ(own[0], without[0]);
  }
}

// Where no custom solid is in front, distances and solids are those of the method; in front of them nothing of it is.
TEST_F(OwnGlsl, BuiltInSolidsStayWhatTheyAre) {
  Scene scene = loaded("custom/torus.json");
  scene.width = 160, scene.height = 107;
  const Channels channels{.distance = true, .solid = true};
  for (const Method method : kMethods) {
    const Band with = render(scene, channels, {.method = method});
    Scene bare = scene;
    bare.world.customSolids.clear();
    const Band without = render(bare, channels, {.method = method});
    std::size_t rings[2] = {};
    for (std::size_t i = 0; i < with.solid.size(); ++i) {
      if (with.solid[i] < 2) {
        ASSERT_EQ(with.solid[i], without.solid[i]);
        ASSERT_EQ(with.distance[i], without.distance[i]);
        continue;
      }
      ASSERT_LT(with.distance[i], without.distance[i]);
      ++rings[with.solid[i] - 2];
    }
    EXPECT_GT(rings[0], 500u);
    EXPECT_GT(rings[1], 500u);
  }
}

TEST_F(OwnGlsl, ASphereByHandIsTheSphere) {
  write("ball.glsl", R"(
bool intersect(Ray ray, float tMin, float tMax, Parameters p, out float t, out vec3 normal) {
  vec3 f = ray.origin - p.center;
  float b = dot(f, ray.direction);
  vec3 away = f - b * ray.direction;
  float square = p.radius * p.radius - dot(away, away);
  if (square < 0.0) return false;
  t = -b - sqrt(square);
  normal = f + t * ray.direction;
  return true;
})");
  const Scene own =
      scene(R"("integrator": {"type": "castingdist", "near_color": [1, 0, 0], "near_dist": 3,
                              "far_color": [0, 0, 1], "far_dist": 9})",
            R"({"type": "custom", "glsl": "ball.glsl", "parameters": {"center": [-1, 1, 1], "radius": 1}})");
  Scene same = own;
  same.world.customSolids.clear();
  same.world.groups[0].members.push_back({false, 2});
  same.world.solids.push_back({"", Sphere{{-1, 1, 1}, 1}, 0});
  for (const int samples : {1, 2}) {
    const Band a = render(own, allChannels(), {}, samples), b = render(same, allChannels(), {}, samples);
    std::size_t flips = 0;
    for (std::size_t i = 0; i < a.solid.size(); ++i) {
      if (a.solid[i] != b.solid[i]) {
        ++flips;
        continue;
      }
      if (a.solid[i] < 0) continue;
      EXPECT_NEAR(a.distance[i], b.distance[i], 2e-3);  // at the rim the square root takes half of the digits
      for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
        EXPECT_NEAR(a.position[k], b.position[k], 2e-3);
        EXPECT_NEAR(a.local[k], b.local[k], 2e-3);
        EXPECT_NEAR(a.normal[k], b.normal[k], 2e-3);
        if (samples == 1) EXPECT_NEAR(a.radiance[k], b.radiance[k], 2e-3);
      }
    }
    EXPECT_LE(flips, 2u);
    EXPECT_GT(std::count(a.solid.begin(), a.solid.end(), 2), 150);
  }
}

// A plane z = 0 by hand: what lies outside of the bounds is not seen, and hits that are none are no hits.
TEST_F(OwnGlsl, BoundsCutAndHitsBehindAreNone) {
  const std::string glsl = R"(
bool intersect(Ray ray, float tMin, float tMax, Parameters p, out float t, out vec3 normal) {
  t = p.sign * -ray.origin.z / ray.direction.z;
  if (p.sign == 0.0) t = sqrt(-1.0 - ray.origin.z);
  normal = vec3(0.0, 0.0, 1.0);
  return true;
})";
  write("plane.glsl", glsl);
  const auto seen = [&](const std::string& sign, const std::string& bounds) {
    Scene own =
        scene("", R"({"type": "custom", "glsl": "plane.glsl", "parameters": {"sign": )" + sign + "}" + bounds + "}");
    own.world.solids = {};
    own.world.groups[0].members.clear();
    const Band band = render(own, {.solid = true, .position = true});
    std::size_t count = 0;
    for (std::size_t i = 0; i < band.solid.size(); ++i) {
      if (band.solid[i] < 0) continue;
      ++count;
      EXPECT_EQ(band.solid[i], 0);
      if (bounds.empty()) continue;
      EXPECT_LE(std::abs(band.position[3 * i]), 1.00001);
      EXPECT_LE(std::abs(band.position[3 * i + 1] - 1), 0.50001);
    }
    return count;
  };
  EXPECT_EQ(seen("1", ""), 64u * 48u);
  const std::size_t cut = seen("1", R"(, "bounds": {"min": [-1, 0.5, 0], "max": [1, 1.5, 0]})");
  EXPECT_GT(cut, 200u);
  EXPECT_LT(cut, 700u);
  EXPECT_EQ(seen("-1", ""), 0u);
  EXPECT_EQ(seen("0", ""), 0u);  // NaN
}

TEST_F(OwnGlsl, WhatIsWrongWithASolidIsSaid) {
  const auto own = [&](const std::string& glsl) {
    write("s.glsl", glsl);
    return scene("", R"({"type": "custom", "glsl": "s.glsl"})");
  };
  const std::string head =
      "bool intersect(Ray ray, float tMin, float tMax, Parameters p, out float t, out vec3 normal)";
  EXPECT_EQ(complaint(own("float f() { return 1.0; }"), Exit::shader),
            path("s.glsl") + ":1: error: there is no function intersect, expected " + head);
  EXPECT_EQ(complaint(own("bool intersect(Ray ray) { return false; }"), Exit::shader),
            path("s.glsl") + ":1: error: intersect is declared otherwise, expected " + head);
  EXPECT_EQ(complaint(own(head + "\n{ t = 1.0; while (t > 0.0) ; return true; }"), Exit::shader),
            path("s.glsl") + ":2: error: a pixel's loops went on for more than 8191 rounds here, expected them to end");
}

TEST_F(OwnGlsl, FreeRaysAreNotCastAtThem) {
  const Scene scene = loaded("custom/torus.json");
  EXPECT_THROW(QueryCaster(device(), scene.world, {}), Error);
}

// The bundled scenes: all of it works, on all cameras' methods, and shows something.
TEST_F(OwnGlsl, BundledScenesHaveColours) {
  for (const char* name : {"normals", "depth", "ambient", "checker", "solids", "torus"}) {
    Scene scene = loaded(std::string("custom/") + name + ".json");
    scene.width = 96, scene.height = 64;
    for (const Method method : kMethods) {
      const Band band = render(scene, {.rgb8 = true, .solid = true}, {.method = method});
      std::set<std::array<std::uint8_t, 3>> colours;
      for (std::size_t i = 0; i < band.rgb8.size(); i += 3)
        colours.insert({band.rgb8[i], band.rgb8[i + 1], band.rgb8[i + 2]});
      EXPECT_GT(colours.size(), 30u) << name;
      EXPECT_EQ(stats_.nanColours, 0u) << name;
    }
  }
}

}  // namespace
}  // namespace solidcast
