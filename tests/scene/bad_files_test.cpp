// Files that are no scenes, broken JSON, and what is wrong outside the list of solids.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/scene/scene_text.h"

namespace solidcast {
namespace {

std::string fileRefusal(const std::string& file) {
  std::vector<std::string> warnings;
  try {
    loadScene(file, warnings);
  } catch (const Error& error) { return error.what(); }
  return "accepted";
}

TEST(BadFiles, MissingFolderAndEmpty) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "solidcast_bad_files";
  std::filesystem::create_directories(folder);
  const std::string missing = folder / "none.json", empty = folder / "empty.json";
  std::ofstream(empty).close();
  EXPECT_EQ(fileRefusal(missing), missing + ": no such file, expected a scene file");
  EXPECT_EQ(fileRefusal(folder), folder.string() + ": is a folder, expected a scene file");
  EXPECT_EQ(fileRefusal(empty), empty + ":1:1: the file is empty, expected a JSON object");
  EXPECT_EQ(fileRefusal(empty + "/x"), empty + "/x: Not a directory, expected a scene file");
  std::filesystem::remove_all(folder);
}

struct Bad {
  const char* text;
  const char* expected;
};

TEST(BadFiles, SyntaxErrorsHaveLineAndColumn) {
  const Bad table[] = {
      {" \n\t\n", "s.json:1:1: the file is empty, expected a JSON object"},
      {"// only a comment\n", "s.json:2:1: unexpected end of input, expected '[', '{', or a literal"},
      {"{\"image\": {\"width\": 1,,}", "s.json:1:23: unexpected ',', expected string literal"},
      {"{\n  \"a\": 1\n  \"b\": 2}", "s.json:3:5: unexpected string literal, expected '}'"},
      {"{\"a\": 1", "s.json:1:8: unexpected end of input, expected '}'"},
      {"{\"a\": \"x", "s.json:1:9: invalid string: missing closing quote, expected valid JSON"},
      {"{\"a\": [1, 2,]}", "s.json:1:13: unexpected ']', expected '[', '{', or a literal"},
      {"{\"a\":\n tru}", "s.json:2:5: invalid literal, expected valid JSON"},
      {"{\"a\": \"\xff\"}", "s.json:1:8: invalid string: ill-formed UTF-8 byte, expected valid JSON"},
      {"{'a': 1}", "s.json:1:2: invalid literal, expected string literal"},
      {"{\n \"a\": NaN}", "s.json:2:7: NaN is not a JSON number, expected a finite number"},
      {"{\n \"a\": inf}", "s.json:2:7: inf is not a JSON number, expected a finite number"},
      {"{\"a\": [0, -Infinity]}", "s.json:1:11: -Infinity is not a JSON number, expected a finite number"},
      {"{\n\n\"a\": 1e400}",
       "s.json:3:6: number \"1e400\" is beyond fp32, expected at most 3.4028234663852886e+38 in size"},
  };
  for (const Bad& bad : table) EXPECT_EQ(refusal(bad.text), bad.expected);
  EXPECT_EQ(refusal(withSolids("") + " x").substr(0, 7), "s.json:");
  EXPECT_NE(refusal(withSolids("") + " x").find("expected end of input"), std::string::npos);
}

TEST(BadFiles, AByteOrderMarkAndCommentsAreAllowed) {
  EXPECT_EQ(refusal("\xef\xbb\xbf// seen: nothing\n" + withSolids("/* none */")), "accepted");
}

TEST(BadFiles, EveryTruncationIsRefused) {
  const std::string whole = withSolids(R"({"type": "sphere", "center": [0, 0, 0], "radius": 1})");
  for (std::size_t length = 0; length < whole.size(); ++length) {
    const std::string line = refusal(whole.substr(0, length));
    EXPECT_TRUE(line.starts_with("s.json:1:")) << length << " bytes: " << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

TEST(BadTop, ImageCameraIntegrator) {
  const std::string size = ", expected a whole number of pixels from 1 to 100000";
  const std::string camera = R"("camera": {"center": [0, 0, 9], "forward": [0, 0, -1], "up": [0, 1, 0], )";
  const auto image = [&](const std::string& fields) { return "{\"image\": " + fields + ", " + kCamera + "}"; };
  const auto view = [&](const std::string& fields) { return "{" + kImage + ", " + camera + fields + "}}"; };
  const std::vector<std::pair<std::string, std::string>> table = {
      {"[1, 2]", "/: wrong type: a list, expected an object"},
      {"17", "/: wrong type: a number, expected an object"},
      {"{}", "/: missing field \"image\", expected width and height"},
      {"{" + kImage + "}", "/: missing field \"camera\", expected a camera"},
      {"{" + kImage + ", " + kCamera + "}", "/: missing field \"solids\", expected a list of solids"},
      {"{" + kImage + ", " + kCamera + ", \"solids\": 3}", "/solids: wrong type: a number, expected a list of solids"},
      {"{" + kImage + ", " + kImage + "}", "/image: duplicate key \"image\", expected each key once"},
      {withMember("\"twosided\": true"),
       "/twosided: unknown key \"twosided\", expected one of $schema, image, camera, integrator, two_sided, solids "
       "(the "
       "nearest is two_sided)"},
      {withMember("\"two_sided\": 1"), "/two_sided: wrong type: a number, expected true or false"},
      {image("7"), "/image: wrong type: a number, expected an object"},
      {image(R"({"width": 0, "height": 1})"), "/image/width: size 0 is out of range" + size},
      {image(R"({"width": -3, "height": 1})"), "/image/width: size -3 is out of range" + size},
      {image(R"({"width": 1, "height": 1000000000})"), "/image/height: size 1e+09 is out of range" + size},
      {image(R"({"width": 1, "height": 2.5})"), "/image/height: size 2.5 is out of range" + size},
      {image(R"({"width": 1, "hight": 2})"),
       "/image/hight: unknown key \"hight\", expected one of width, height (the nearest is height)"},
      {view(R"("type": "persp")"),
       "/camera/type: unknown camera \"persp\", expected one of perspective, orthographic, environment (the nearest is "
       "perspective)"},
      {view(R"("type": "perspective", "vertical_angle": 180, "horizontal_angle": 60)"),
       "/camera/vertical_angle: angle 180 is out of range, expected degrees above 0 and below 180"},
      {view(R"("type": "perspective", "vertical_angle": 45, "horizontal_angle": 0)"),
       "/camera/horizontal_angle: angle 0 is out of range, expected degrees above 0 and below 180"},
      {view(R"("type": "perspective", "vertical_angle": -45, "horizontal_angle": 60)"),
       "/camera/vertical_angle: angle -45 is out of range, expected degrees above 0 and below 180"},
      {view(R"("type": "environment", "vertical_angle": 180.5, "horizontal_angle": 360)"),
       "/camera/vertical_angle: angle 180.5 is out of range, expected degrees above 0 and at most 180"},
      {view(R"("type": "environment", "vertical_angle": 180, "horizontal_angle": 361)"),
       "/camera/horizontal_angle: angle 361 is out of range, expected degrees above 0 and at most 360"},
      {view(R"("type": "orthographic", "scale_x": 0, "scale_y": 1)"),
       "/camera/scale_x: 0 is not positive, expected a number above 0"},
      {"{" + kImage + R"(, "camera": {"type": "orthographic", "center": [0,0,0], "forward": [0.1,0.2,0.3], )" +
           R"("up": [-0.2,-0.4,-0.6], "scale_x": 1, "scale_y": 1}})",
       "/camera/up: up is parallel to forward, expected another direction"},
      {"{" + kImage + R"(, "camera": {"type": "orthographic", "center": [0,0,0], "forward": [0,0,0], )" +
           R"("up": [0,1,0], "scale_x": 1, "scale_y": 1}})",
       "/camera/forward: the vector is zero, expected a direction"},
      {withMember(R"("integrator": "casting")"), "/integrator: wrong type: the text \"casting\", expected an object"},
      {withMember(R"("integrator": [])"), "/integrator: the list is empty, expected at least one integrator"},
      {withMember(R"("integrator": {"type": "cast"})"),
       "/integrator/type: unknown integrator \"cast\", expected one of casting, castingdist, custom (the nearest is "
       "casting)"},
      {withMember(R"("integrator": [{"type": "casting"}, {"type": "casting"}])"),
       "/integrator/1: a second integrator of type casting, expected each type once"},
      {withMember(R"("integrator": {"type": "castingdist", "near_color": [1,1,1], "near_dist": 4, )"
                  R"("far_color": [0,0,0], "far_dist": 4.0})"),
       "/integrator/far_dist: far_dist equals near_dist (4), expected two distances"},
      {withMember(R"("integrator": {"type": "castingdist", "near_color": [1,1,1], "near_dist": 4, "far_dist": 5})"),
       "/integrator: missing field \"far_color\", expected three numbers"},
  };
  for (const auto& [text, expected] : table) EXPECT_EQ(refusal(text), "s.json: " + expected);
}

TEST(BadTop, LimitsThemselvesAreAccepted) {
  const auto view = [](const std::string& camera) {
    return "{" + kImage + R"(, "camera": {"center": [0, 0, 9], "forward": [0, 0, -1], "up": [0, 1, 0], )" + camera +
           R"(}, "solids": []})";
  };
  EXPECT_EQ(refusal(view(R"("type": "environment", "vertical_angle": 180, "horizontal_angle": 360)")), "accepted");
  EXPECT_EQ(refusal(view(R"("type": "perspective", "vertical_angle": 179.9999, "horizontal_angle": 1e-6)")),
            "accepted");
  EXPECT_EQ(refusal("{\"image\": {\"width\": 100000, \"height\": 1.0}, " + kCamera + ", \"solids\": []}"), "accepted");
}

}  // namespace
}  // namespace solidcast
