// Bundled scenes and the JSON Schema: every scene loads, is valid, and says what one should see; schema and loader know
// the same keys.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "tests/scene/scene_text.h"
#include "tests/scene/schema.h"

namespace solidcast {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

const fs::path kRoot = SOLIDCAST_SOURCE_DIR;

std::string readText(const fs::path& file) {
  std::ifstream in(file);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<fs::path> bundledScenes() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / "scenes"))
    if (entry.path().extension() == ".json" && entry.path().filename() != "scene.schema.json")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

Json schema() { return Json::parse(readText(kRoot / "scenes/scene.schema.json")); }
Json withComments(const std::string& text) { return Json::parse(text, nullptr, true, true); }

TEST(BundledScenes, AreAllThere) {
  std::set<std::string> names;
  for (const fs::path& file : bundledScenes()) names.insert(fs::relative(file, kRoot / "scenes").replace_extension());
  std::set<std::string> expected = {"a_solids",    "quadrics",      "showpiece", "orthographic",
                                    "environment", "nested_groups", "mesh"};
  for (const char* solid : {"sphere", "infinite_plane", "box", "disc", "triangle", "quad", "quadric"})
    expected.insert(std::string("solids/") + solid);
  for (const char* quadric :
       {"ellipsoid", "elliptic_cone", "elliptic_paraboloid", "hyperbolic_paraboloid", "hyperboloid_one_sheet",
        "hyperboloid_two_sheets", "elliptic_cylinder", "hyperbolic_cylinder", "parabolic_cylinder"})
    expected.insert(std::string("quadrics/") + quadric);
  for (const char* custom : {"normals", "depth", "ambient", "checker", "solids", "torus"})
    expected.insert(std::string("custom/") + custom);
  EXPECT_EQ(names, expected);
}

TEST(BundledScenes, LoadWithoutWarningsAndSayWhatOneShouldSee) {
  for (const fs::path& file : bundledScenes()) {
    SCOPED_TRACE(file);
    std::vector<std::string> warnings;
    Scene scene;
    ASSERT_NO_THROW(scene = loadScene(file, warnings));
    EXPECT_NO_THROW(checkScene(scene, warnings));
    EXPECT_TRUE(warnings.empty()) << warnings[0];
    EXPECT_FALSE(scene.world.solids.empty());
    EXPECT_TRUE(scene.distParameters.has_value());
    const std::string text = readText(file);
    EXPECT_TRUE(text.starts_with("// "));
    std::string comment = text.substr(0, text.find("\n{"));
    std::replace(comment.begin(), comment.end(), '\n', ' ');
    comment.erase(std::remove(comment.begin(), comment.end(), '/'), comment.end());
    EXPECT_NE(comment.find("should"), std::string::npos);
    EXPECT_NE(comment.find(" see"), std::string::npos);
  }
}

TEST(BundledScenes, EachOfItsKind) {
  std::vector<std::string> warnings;
  for (const auto& entry : fs::directory_iterator(kRoot / "scenes/solids"))
    EXPECT_EQ(std::string(kindName(loadScene(entry.path(), warnings).world.solids[0].shape)), entry.path().stem());
  for (const auto& entry : fs::directory_iterator(kRoot / "scenes/quadrics"))
    EXPECT_STREQ(kindName(loadScene(entry.path(), warnings).world.solids[0].shape), "quadric");
  std::set<std::string> kinds;
  for (const SolidEntry& solid : loadScene(kRoot / "scenes/showpiece.json", warnings).world.solids)
    kinds.insert(kindName(solid.shape));
  EXPECT_EQ(kinds.size(), 7u);
  EXPECT_GT(loadScene(kRoot / "scenes/nested_groups.json", warnings).world.groups.size(), 40u);
}

TEST(Schema, HoldsForEveryBundledScene) {
  const Json rules = schema();
  for (const fs::path& file : bundledScenes()) {
    EXPECT_EQ(violation(rules, withComments(readText(file))), "") << file;
    // The name by which editors find it leads to it.
    const std::string named = withComments(readText(file)).at("$schema");
    EXPECT_TRUE(fs::equivalent(file.parent_path() / named, kRoot / "scenes/scene.schema.json")) << file;
  }
}

TEST(Schema, RefusesWhatTheLoaderRefuses) {
  const std::string bad[] = {
      withSolids(R"({"type": "spere"})"),
      withSolids(R"({"type": "sphere", "center": [0, 0, 0], "radius": 0})"),
      withSolids(R"({"type": "sphere", "center": [0, 0], "radius": 1})"),
      withSolids(R"({"type": "sphere", "center": [0, 0, 1e39], "radius": 1})"),
      withSolids(R"({"type": "sphere", "center": [0, 0, 0], "raduis": 1})"),
      withSolids(R"({"type": "infinite_plane", "normal": [0, 1, 0]})"),
      withSolids(R"({"type": "infinite_plane", "equation": [0, 1, 0]})"),
      withSolids(R"({"type": "quadric", "form": "ellipsoid", "center": [0,0,0], "radii": [1,1,1], "axis": "x"})"),
      withSolids(R"({"type": "quadric", "form": "cylinder", "center": [0,0,0], "radii": [1,1,1]})"),
      withSolids(R"({"type": "group"})"),
      withSolids(R"({"type": "mesh"})"),
      withSolids(R"({"type": "custom"})"),
      withSolids(R"({"type": "custom", "glsl": ""})"),
      withSolids(R"({"type": "custom", "glsl": "a", "parameters": {"a": [1, 2]}})"),
      withSolids(R"({"type": "custom", "glsl": "a", "bounds": {"min": [0, 0, 0]}})"),
      withMember(R"("integrator": {"type": "custom"})"),
      withSolids(R"({"type": "mesh", "file": "a.ply", "scale": -1})"),
      withSolids(R"({"type": "mesh", "file": "a.ply", "rotate": [1, 0, 0]})"),
      withSolids(R"({"type": "group", "name": "", "solids": []})"),
      withMember(R"("two_sided": 1)"),
      withMember(R"("integrator": "casting")"),
      withMember(R"("integrator": [])"),
      withMember(R"("foo": 1)"),
      "{" + kImage + ", " + kCamera + "}",
      "{\"image\": {\"width\": 0, \"height\": 1}, " + kCamera + ", \"solids\": []}",
      "{\"image\": {\"width\": 100001, \"height\": 1}, " + kCamera + ", \"solids\": []}",
      "{\"image\": {\"width\": 1.5, \"height\": 1}, " + kCamera + ", \"solids\": []}",
  };
  const Json rules = schema();
  for (const std::string& text : bad) {
    EXPECT_NE(violation(rules, Json::parse(text)), "") << text;
    EXPECT_NE(refusal(text), "accepted") << text;
  }
  EXPECT_EQ(violation(rules, Json::parse(withSolids(""))), "");
}

TEST(Documentation, ExamplesAreScenes) {
  const std::string text = readText(kRoot / "docs/scene-format.md");
  const Json rules = schema();
  std::set<std::string> shown;
  const auto check = [&rules](const Json& example, const std::string& block) {
    const std::string type = example.value("type", "scene");
    std::string scene = withSolids(block);
    if (type == "scene") scene = block;
    if (type.starts_with("casting")) scene = withMember("\"integrator\": " + block);
    if (example.contains("forward")) scene = "{" + kImage + ", \"solids\": [], \"camera\": " + block + "}";
    std::vector<std::string> warnings;  // files are named from the folder of the bundled scenes
    EXPECT_NO_THROW(parseScene(scene, kRoot / "scenes/s.json", warnings)) << block;
    EXPECT_EQ(violation(rules, withComments(scene)), "") << block;
    return type;
  };
  for (std::size_t at = text.find("```json\n"); at != std::string::npos; at = text.find("```json\n", at)) {
    const std::size_t begin = at + 8, end = text.find("```", begin);
    const std::string block = text.substr(begin, end - begin);
    at = end + 3;
    const Json example = withComments(block);
    if (example.is_array()) {  // a camera path
      for (const Json& camera : example) check(camera, camera.dump());
    } else {
      shown.insert(check(example, block));
    }
  }
  const std::set<std::string> expected = {
      "scene", "perspective", "orthographic", "environment", "casting", "sphere", "castingdist", "infinite_plane",
      "box",   "disc",        "quadric",      "triangle",    "quad",    "group",  "mesh",        "custom"};
  EXPECT_EQ(shown, expected);
}

/// The keys that a refusal of the unknown key "?" lists.
std::set<std::string> keysOf(const std::string& line) {
  const std::size_t begin = line.find("one of ") + 7, end = line.find(" (the nearest");
  std::istringstream list(line.substr(begin, end - begin));
  std::set<std::string> keys;
  for (std::string key; list >> key;) keys.insert(key.substr(0, key.find(',')));
  return keys;
}

TEST(Schema, KnowsTheLoadersKeys) {
  const Json rules = schema();
  std::map<std::string, std::set<std::string>> inSchema;  // a quadric's two descriptions together
  for (const Json& solid : rules["definitions"]["solid"]["oneOf"])
    for (const auto& [key, rule] : solid["properties"].items())
      inSchema[solid["properties"]["type"]["const"]].insert(key);
  EXPECT_EQ(inSchema.size(), 10u);
  for (const auto& [type, keys] : inSchema) {
    std::string description = type == "group"            ? R"("solids": [])"
                              : type == "mesh"           ? R"("file": "")"
                              : type == "custom"         ? R"("glsl": "a")"
                              : type == "infinite_plane" ? R"("points": 0)"
                                                         : R"("coefficients": 0)";
    std::set<std::string> known =
        keysOf(refusal(withSolids("{\"type\": \"" + type + "\", \"?\": 0, " + description + "}")));
    if (type == "quadric") known.merge(keysOf(refusal(withSolids(R"({"type": "quadric", "?": 0, "form": "cone"})"))));
    EXPECT_EQ(keys, known) << type;
  }
  std::set<std::string> top;
  for (const auto& [key, rule] : rules["properties"].items()) top.insert(key);
  EXPECT_EQ(top, keysOf(refusal(withMember(R"("?": 0)"))));
}

}  // namespace
}  // namespace solidcast
