// Good scenes: what is read is what was written, in the order that decides ties; large and deep files included.
#include <gtest/gtest.h>

#include "host/scene/rules.h"
#include "tests/scene/scene_text.h"

namespace solidcast {
namespace {

const std::string kSources = SOLIDCAST_SOURCE_DIR;
const std::string kBall = R"({"type": "sphere", "center": [0, 0, 0], "radius": 1})";

TEST(Load, ASolidsIsTheSameFromFileAndFromApi) {
  std::vector<std::string> warnings;
  Scene fromFile = loadScene(kSources + "/scenes/a_solids.json", warnings);
  Scene fromApi = aSolids();
  fromFile.file = fromApi.file;
  EXPECT_EQ(fromFile, fromApi);
  EXPECT_EQ(fromApi.world.solids.size(), 9u);
  checkScene(fromApi, warnings);
  EXPECT_TRUE(warnings.empty());
  std::vector<SolidEntry> solids(fromApi.world.solids.begin(), fromApi.world.solids.end());
  solids[8].name = "another";
  fromApi.world.solids = Solids(solids);
  EXPECT_NE(fromFile, fromApi);
}

TEST(Load, EverySolid) {
  const Scene scene = parse(withSolids(R"(
      {"type": "sphere", "center": [1, 2, 3], "radius": 0.1},
      {"type": "infinite_plane", "origin": [1, 2, 3], "normal": [0, 0, 7]},
      {"type": "infinite_plane", "equation": [0, 0, 2, -8]},
      {"type": "infinite_plane", "points": [[0, 0, 4], [1, 0, 4], [0, 3, 4]]},
      {"type": "box", "corner1": [1, 2, 3], "corner2": [-1, -2, -3]},
      {"type": "disc", "center": [1, 2, 3], "normal": [0, 3, 4], "radius": 2},
      {"type": "triangle", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]},
      {"type": "quad", "vertex": [1, 1, 1], "span1": [1, 0, 0], "span2": [1, 1, 0]},
      {"type": "quadric", "coefficients": [1, 2, 3, 4, 5, 6, 7, 8, 9, 10]},
      {"type": "quadric", "form": "ellipsoid", "center": [0, 0, 1], "radii": [1, 0.5, 0.25]})"));
  const std::vector<Shape> expected = {Sphere{{1, 2, 3}, 0.1},
                                       InfinitePlane{{1, 2, 3}, {0, 0, 7}},
                                       InfinitePlane{{0, 0, 4}, {0, 0, 2}},
                                       InfinitePlane{{0, 0, 4}, {0, 0, 3}},
                                       AABox{{1, 2, 3}, {-1, -2, -3}},
                                       Disc{{1, 2, 3}, {0, 3, 4}, 2},
                                       Triangle{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
                                       Quad{{1, 1, 1}, {1, 0, 0}, {1, 1, 0}},
                                       Quadric{{1, 2, 3, 4, 5, 6, 7, 8, 9, 10}},
                                       Quadric{{1, 4, 16, 0, 0, 0, 0, 0, -32, 15}}};
  ASSERT_EQ(scene.world.solids.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(scene.world.solids[i].shape, expected[i]) << i;
}

TEST(Load, CamerasIntegratorsAndSwitches) {
  const auto camera = [](const std::string& fields) {
    return parse("{" + kImage + R"(, "camera": {"center": [1, 2, 3], "forward": [0, 0, -1], "up": [0, 1, 0], )" +
                 fields + R"(}, "solids": []})")
        .camera;
  };
  EXPECT_EQ(camera(R"("type": "perspective", "vertical_angle": 45, "horizontal_angle": 60)"),
            Camera(PerspectiveCamera{{1, 2, 3}, {0, 0, -1}, {0, 1, 0}, 45, 60}));
  EXPECT_EQ(camera(R"("type": "orthographic", "scale_x": 4, "scale_y": 3)"),
            Camera(OrthographicCamera{{1, 2, 3}, {0, 0, -1}, {0, 1, 0}, 4, 3}));
  EXPECT_EQ(camera(R"("type": "environment", "vertical_angle": 90, "horizontal_angle": 270)"),
            Camera(EnvironmentCamera{{1, 2, 3}, {0, 0, -1}, {0, 1, 0}, 90, 270}));

  const Scene plain = parse(withSolids(""));
  EXPECT_EQ(plain.width, 64);
  EXPECT_EQ(plain.height, 48);
  EXPECT_EQ(plain.integrator, Integrator(RayCastingIntegrator{}));
  EXPECT_FALSE(plain.distParameters.has_value());
  EXPECT_FALSE(plain.twoSided);

  const RayCastingDistIntegrator dist{{1, 0.2, 0}, 12, {0.2, 1, 0}, 4};
  const std::string distText =
      R"({"type": "castingdist", "near_color": [1, 0.2, 0], "near_dist": 12, "far_color": [0.2, 1, 0], "far_dist": 4})";
  const Scene chosen = parse(withMember("\"two_sided\": true, \"integrator\": " + distText));
  EXPECT_EQ(chosen.integrator, Integrator(dist));
  EXPECT_EQ(chosen.distParameters, dist);
  EXPECT_TRUE(chosen.twoSided);
  const Scene offered = parse(withMember("\"integrator\": [{\"type\": \"casting\"}, " + distText + "]"));
  EXPECT_EQ(offered.integrator, Integrator(RayCastingIntegrator{}));
  EXPECT_EQ(offered.distParameters, dist);
}

TEST(Load, GroupsKeepDepthFirstOrder) {
  const auto ball = [](const std::string& name) { return "{\"name\": \"" + name + "\", " + kBall.substr(1); };
  const Scene scene =
      parse(withSolids(ball("a") + ", {\"solids\": [" + ball("b") + ", {\"type\": \"group\", \"solids\": [" +
                       ball("c") + "]}, " + ball("d") + "], \"name\": \"outer\", \"type\": \"group\"}, " + ball("e") +
                       ", {\"type\": \"group\", \"solids\": []}"));
  const World& world = scene.world;
  ASSERT_EQ(world.solids.size(), 5u);
  std::string order;
  for (const SolidEntry& solid : world.solids) order += solid.name;
  EXPECT_EQ(order, "abcde");
  const std::vector<GroupEntry> groups = {{"", 0, {{false, 0}, {true, 1}, {false, 4}, {true, 3}}},
                                          {"outer", 0, {{false, 1}, {true, 2}, {false, 3}}},
                                          {"", 1, {{false, 2}}},
                                          {"", 0, {}}};
  EXPECT_EQ(world.groups, groups);
  EXPECT_EQ(world.solids.group(2), 2u);
  std::vector<std::string> warnings;
  EXPECT_NO_THROW(checkScene(scene, warnings));
}

std::string nested(int depth) {
  std::string text;
  for (int i = 0; i < depth; ++i) text += R"({"type": "group", "solids": [)";
  text += kBall;
  for (int i = 0; i < depth; ++i) text += "]}";
  return withSolids(text);
}

TEST(Load, DeepNestingIsReadOrRefusedWithTheLimit) {
  const Scene scene = parse(nested(kMaxGroupDepth));
  EXPECT_EQ(scene.world.groups.size(), std::size_t{kMaxGroupDepth} + 1);
  std::vector<std::string> warnings;
  EXPECT_NO_THROW(checkScene(scene, warnings));
  for (const int depth : {kMaxGroupDepth + 1, 10'000, 100'000}) {
    const std::string line = refusal(nested(depth));
    EXPECT_TRUE(line.ends_with(": groups are nested too deep, expected at most 1000")) << line.substr(0, 200);
    EXPECT_LT(line.size(), 250u);
  }
  EXPECT_TRUE(refusal(std::string(1'000'000, '[')).starts_with("s.json: /: wrong type"));
  EXPECT_TRUE(refusal("{\"a\":" + std::string(1'000'000, '[')).find("nested deeper") != std::string::npos);
}

TEST(Load, ManyGroupsSideBySideAreNotDeep) {
  std::string groups = R"({"type": "group", "solids": []})";
  for (int i = 0; i < 2 * kMaxGroupDepth; ++i) groups += R"(, {"type": "group", "solids": []})";
  EXPECT_EQ(parse(withSolids(groups)).world.groups.size(), 2 * std::size_t{kMaxGroupDepth} + 2);
}

TEST(Load, TwoHundredMegabytes) {
  std::string text = withSolids("");
  const std::string tail = text.substr(text.size() - 2);
  text.resize(text.size() - 2);
  constexpr std::size_t kBytes = std::size_t{200} << 20;
  text.reserve(kBytes + 1000);
  const std::string padded = kBall + "," + std::string(140 - kBall.size(), ' ') + "\n";
  std::size_t count = 0;
  for (; text.size() < kBytes; ++count) text += padded;
  text += kBall + tail;
  EXPECT_EQ(parse(text).world.solids.size(), count + 1);
}

TEST(Load, NamesForPeople) {
  const Scene scene =
      parse(withSolids(kBall + R"(, {"type": "infinite_plane", "name": "floor", "equation": [0, 1, 0, 0]})" +
                       R"(, {"type": "infinite_plane", "equation": [0, 1, 0, 1]})"));
  EXPECT_EQ(solidName(scene.world, 0), "sphere 0");
  EXPECT_EQ(solidName(scene.world, 1), "floor");
  EXPECT_EQ(solidName(scene.world, 2), "infinite_plane 2");
}

}  // namespace
}  // namespace solidcast
