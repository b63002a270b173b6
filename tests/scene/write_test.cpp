// Scenes to files and back, and random scenes that are the same everywhere.
#include "host/scene/write.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "host/scene/build.h"
#include "host/scene/random.h"
#include "tests/scene/scene_text.h"

namespace solidcast {
namespace {

std::string written(const Scene& scene, std::string_view comment = "") {
  std::string text;
  writeScene(scene, comment, [&](std::string_view piece) { text += piece; });
  return text;
}

Scene again(Scene scene) {
  Scene read = parse(written(scene));
  read.file = scene.file;
  return read;
}

TEST(Write, ReadsBackTheSame) {
  Scene scene = aSolids();
  EXPECT_EQ(again(scene), scene);
  scene.camera = OrthographicCamera{{0.1, 2, 3}, {0, 1. / 3, -1}, {0, 1, 0}, 1e-30, 3e38};
  scene.integrator = *scene.distParameters;
  scene.twoSided = true;
  EXPECT_EQ(again(scene), scene);
  scene.camera = EnvironmentCamera{{0.1, 2, 3}, {0, 0, -1}, {0, 1, 0}, 180, 360};
  scene.integrator = RayCastingIntegrator{};
  scene.distParameters.reset();
  EXPECT_EQ(again(scene), scene);
}

TEST(Write, CustomGlsl) {
  const CustomCode code{"a \"b\".glsl", {{"R", 1.5}, {"colour", Triple{0.1, 2, 3}}}};
  for (Scene scene : {Scene{}, aSolids()}) {
    scene.customIntegrator = CustomIntegrator{code};
    for (const Integrator& chosen : {Integrator{RayCastingIntegrator{}}, Integrator{CustomIntegrator{code}}}) {
      scene.integrator = chosen;
      EXPECT_EQ(again(scene), scene);
    }
    scene.world.customSolids.push_back({"ring", code, std::array<Triple, 2>{{{-1, -2, -3}, {1, 2, 3}}}});
    scene.world.customSolids.push_back({"", {"c.glsl", {}}, {}});
    EXPECT_EQ(again(scene), scene);
  }
}

TEST(Write, GroupsAndOddNames) {
  Scene scene;
  const auto outer = addGroup(scene.world, "a \"quoted\" \\ name\n");
  addSolid(scene.world, Quadric{{1, 2, 3, 4, 5, 6, 7, 8, 9, 0x1.23456789abcdep-20}}, "\xc3\xa9", outer);
  addGroup(scene.world, "", addGroup(scene.world, "empty inside", outer));
  addSolid(scene.world, Sphere{{1, 2, 3}, 4}, "", outer);
  addSolid(scene.world, Sphere{{1, 2, 3}, 5});
  EXPECT_EQ(again(scene), scene);
}

TEST(Write, CommentsLeadEachLine) {
  const std::string text = written(aSolids(), "first\nsecond");
  EXPECT_TRUE(text.starts_with("// first\n// second\n{"));
}

TEST(Random, SameSeedSameScene) {
  for (const std::string& kind : randomKinds()) {
    const std::string text = written(randomScene(kind, 200, 5));
    EXPECT_EQ(text, written(randomScene(kind, 200, 5))) << kind;
    EXPECT_NE(text, written(randomScene(kind, 200, 6))) << kind;
  }
  // The bytes of today are those of any other machine.
  const Scene scene = randomScene("sphere", 1, 1);
  EXPECT_EQ(scene.world.solids[0].shape, Shape(Sphere{{-0.584957, -8.511499, 1.396943}, 9.08185}));
}

TEST(Random, ScenesAreSoundAndOfTheirKind) {
  for (const std::string& kind : randomKinds()) {
    const Scene scene = randomScene(kind, 500, 3);
    std::vector<std::string> warnings;
    EXPECT_NO_THROW(checkScene(scene, warnings)) << kind;
    EXPECT_TRUE(warnings.empty()) << warnings[0];
    EXPECT_EQ(again(scene), scene) << kind;
    EXPECT_EQ(scene.world.solids.size(), 500u);
    std::set<std::string> kinds;
    for (const SolidEntry& solid : scene.world.solids) kinds.insert(kindName(solid.shape));
    EXPECT_EQ(kinds.size(), kind == "mixed" ? 7u : 1u);
    EXPECT_TRUE(kind == "mixed" || kinds.count(kind) == 1);
  }
  EXPECT_THROW(randomScene("cube", 1, 1), Error);
}

TEST(Random, QuadricsAreEllipsoids) {
  // Sylvester: the form is positive definite when its leading minors are.
  for (const SolidEntry& solid : randomScene("quadric", 50, 9).world.solids) {
    const auto& k = std::get<Quadric>(solid.shape).coefficients;
    const double a = k[0], b = k[1], c = k[2], d = k[3] / 2, e = k[4] / 2, f = k[5] / 2;
    EXPECT_GT(a, 0);
    EXPECT_GT(a * b - d * d, 0);
    EXPECT_GT(a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e), 0);
  }
}

}  // namespace
}  // namespace solidcast
