// Every solid that must be refused, with the exact line that says so.
#include <gtest/gtest.h>

#include "tests/scene/scene_text.h"

namespace solidcast {
namespace {

struct BadSolid {
  const char* name;
  const char* solids;    // of the scene's list
  const char* expected;  // after "s.json: /solids"
};

constexpr char kBeyond[] = "expected at most 3.4028234663852886e+38 in size";

const BadSolid kBadSolids[] = {
    {"notAnObject", "7", "/0: wrong type: a number, expected an object that is a solid or a group"},
    {"aListInTheList", "[]", "/0: wrong type: a list, expected an object that is a solid or a group"},
    {"noType", R"({"center": [0, 0, 0]})", R"(/0: missing field "type", expected the name of a solid)"},
    {"typeNotText", R"({"type": 3})", "/0/type: wrong type: a number, expected the name of a solid"},
    {"unknownSolid", R"({"type": "spere"})",
     R"(/0/type: unknown solid "spere", expected one of group, mesh, custom, sphere, infinite_plane, box, disc, triangle, quad, )"
     "quadric (the nearest is sphere)"},
    {"unknownKey", R"({"type": "sphere", "center": [0, 0, 0], "raduis": 1})",
     R"(/0/raduis: unknown key "raduis", expected one of type, name, center, radius (the nearest is radius))"},
    {"unknownKeyIsEscaped", R"({"type": "sphere", "a/b~\n": 1})",
     R"(/0/a~1b~0?: unknown key "a/b~?", expected one of type, name, center, radius (the nearest is type))"},
    {"missingRadius", R"({"type": "sphere", "center": [0, 0, 0]})", R"(/0: missing field "radius", expected a number)"},
    {"secondOfTheList", R"({"type": "box", "corner1": [0, 0, 0], "corner2": [1, 1, 1]}, {"type": "box"})",
     R"(/1: missing field "corner1", expected three numbers)"},
    {"textForNumber", R"({"type": "sphere", "center": [0, 0, 0], "radius": "1"})",
     R"(/0/radius: wrong type: the text "1", expected a number)"},
    {"nullForNumber", R"({"type": "sphere", "center": [0, 0, 0], "radius": null})",
     "/0/radius: wrong type: null, expected a number"},
    {"numberForVector", R"({"type": "sphere", "center": 0, "radius": 1})",
     "/0/center: wrong type: a number, expected a list of 3 numbers"},
    {"shortVector", R"({"type": "sphere", "center": [0, 0], "radius": 1})",
     "/0/center: a list of 2, expected a list of 3 numbers"},
    {"booleanInVector", R"({"type": "sphere", "center": [0, 0, true], "radius": 1})",
     "/0/center/2: wrong type: a boolean, expected a number"},
    {"endlessList", R"({"type": "sphere", "center": [0,1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16], "radius": 1})",
     "/0/center/17: the list is longer than any field's, expected at most 16 entries"},
    {"deepValue", R"({"type": "sphere", "center": [[[[[0]]]]], "radius": 1})",
     "/0/center/0/0/0/0: nested deeper than any field, expected numbers"},
    {"zeroRadius", R"({"type": "sphere", "center": [0, 0, 0], "radius": 0})",
     "/0/radius: 0 is not positive, expected a number above 0"},
    {"negativeRadius", R"({"type": "sphere", "center": [0, 0, 0], "radius": -1.5})",
     "/0/radius: -1.5 is not positive, expected a number above 0"},
    {"beyondFp32", R"({"type": "sphere", "center": [0, 1e39, 0], "radius": 1})",
     "/0/center/1: number 1e+39 is beyond fp32, expected at most 3.4028234663852886e+38 in size"},
    {"integerBeyondFp32",
     R"({"type": "sphere", "center": [0, 0, 0], "radius": 1)"
     R"(000000000000000000000000000000000000000})",
     "/0/radius: number 1e+39 is beyond fp32, expected at most 3.4028234663852886e+38 in size"},
    {"discZeroNormal", R"({"type": "disc", "center": [0, 0, 0], "normal": [0, 0, 0], "radius": 1})",
     "/0/normal: the vector is zero, expected a direction"},
    {"discZeroRadius", R"({"type": "disc", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 0})",
     "/0/radius: 0 is not positive, expected a number above 0"},
    {"planeZeroNormal", R"({"type": "infinite_plane", "origin": [0, 0, 0], "normal": [0, 0, -0.0]})",
     "/0/normal: the vector is zero, expected a direction"},
    {"planeOfNothing", R"({"type": "infinite_plane"})",
     R"(/0: missing field, expected "normal", "equation" or "points")"},
    {"planeTwice", R"({"type": "infinite_plane", "equation": [0, 1, 0, 0], "origin": [0, 0, 0], "normal": [0, 1, 0]})",
     R"(/0: more than one description, expected only one of "normal", "equation" or "points")"},
    {"planeOriginBesideEquation", R"({"type": "infinite_plane", "equation": [0, 1, 0, 0], "origin": [0, 0, 0]})",
     R"(/0/origin: "origin" beside "equation", expected it only beside "normal")"},
    {"planeNoOrigin", R"({"type": "infinite_plane", "normal": [0, 1, 0]})",
     R"(/0: missing field "origin", expected three numbers)"},
    {"equationZero", R"({"type": "infinite_plane", "equation": [0, 0, 0, 1]})",
     "/0/equation: A, B and C are zero, expected a normal [A, B, C] that is not"},
    {"planeTwoPoints", R"({"type": "infinite_plane", "points": [[0, 0, 0], [1, 0, 0]]})",
     "/0/points: a list of 2, expected three points of three numbers"},
    {"planeCollinear", R"({"type": "infinite_plane", "points": [[0, 0, 0], [0.1, 0.2, 0.3], [0.2, 0.4, 0.6]]})",
     "/0/points: the three points are collinear, expected points that span a plane"},
    {"triangleNotPoints", R"({"type": "triangle", "vertices": [1, 2, 3]})",
     "/0/vertices/0: wrong type: a number, expected a list of 3 numbers"},
    {"triangleNotAList", R"({"type": "triangle", "vertices": "abc"})",
     R"(/0/vertices: wrong type: the text "abc", expected three points of three numbers)"},
    {"triangleCollinear", R"({"type": "triangle", "vertices": [[1e7, 0, 0], [1e7, 1, 1], [1e7, 3, 3]]})",
     "/0/vertices: the three vertices are collinear, expected a triangle with an area"},
    {"trianglePoint", R"({"type": "triangle", "vertices": [[1, 2, 3], [1, 2, 3], [1, 2, 3]]})",
     "/0/vertices: the three vertices are collinear, expected a triangle with an area"},
    {"quadParallel", R"({"type": "quad", "vertex": [0, 0, 0], "span1": [0.1, 0.2, 0.3], "span2": [-0.2, -0.4, -0.6]})",
     "/0/span2: span2 is parallel to span1, expected two directions"},
    {"quadZeroSpan", R"({"type": "quad", "vertex": [0, 0, 0], "span1": [0, 0, 0], "span2": [0, 1, 0]})",
     "/0/span1: the vector is zero, expected a direction"},
    {"quadricZero", R"({"type": "quadric", "coefficients": [0, 0, 0, 0, 0, 0, 0, 0, 0, 1]})",
     "/0/coefficients: all of a to i are zero, expected at least one that is not"},
    {"quadricNine", R"({"type": "quadric", "coefficients": [1, 1, 1, 0, 0, 0, 0, 0, -1]})",
     "/0/coefficients: a list of 9, expected a list of 10 numbers"},
    {"quadricOfNothing", R"({"type": "quadric"})", R"(/0: missing field, expected "coefficients" or "form")"},
    {"quadricTwice", R"({"type": "quadric", "form": "cone", "coefficients": []})",
     R"(/0: more than one description, expected only one of "coefficients" or "form")"},
    {"quadricUnknownForm", R"({"type": "quadric", "form": "hyperboloid"})",
     R"(/0/form: unknown quadric form "hyperboloid", expected one of ellipsoid, cylinder, cone, paraboloid, )"
     "hyperboloid_one_sheet, hyperboloid_two_sheets, hyperbolic_paraboloid, hyperbolic_cylinder, parabolic_cylinder "
     "(the nearest is paraboloid)"},
    {"quadricRadius", R"({"type": "quadric", "form": "cylinder", "center": [0, 0, 0], "radii": [1, 0]})",
     "/0/radii/1: 0 is not positive, expected a number above 0"},
    {"quadricTooManyRadii", R"({"type": "quadric", "form": "cylinder", "center": [0, 0, 0], "radii": [1, 2, 3]})",
     "/0/radii: a list of 3, expected a list of 2 numbers"},
    {"quadricAxis", R"({"type": "quadric", "form": "cone", "center": [0, 0, 0], "radii": [1, 2, 3], "axis": "w"})",
     R"(/0/axis: unknown axis "w", expected one of x, y, z, -x, -y, -z (the nearest is x))"},
    {"ellipsoidHasNoAxis",
     R"({"type": "quadric", "form": "ellipsoid", "center": [0,0,0], "radii": [1,2,3], "axis": "x"})",
     R"(/0/axis: unknown key "axis", expected one of type, name, form, center, radii (the nearest is radii))"},
    {"groupOfNothing", R"({"type": "group"})", R"(/0: missing field "solids", expected a list of solids)"},
    {"groupNotAList", R"({"type": "group", "solids": {"type": "sphere"}})",
     "/0/solids: wrong type: an object, expected a list of solids"},
    {"groupKey", R"({"type": "group", "solids": [], "center": [0, 0, 0]})",
     R"(/0/center: unknown key "center", expected one of type, name, solids (the nearest is type))"},
    {"insideGroups", R"({"solids": [{"type": "group", "solids": [{"type": "disc"}]}], "type": "group"})",
     R"(/0/solids/0/solids/0: missing field "center", expected three numbers)"},
    {"solidsInASphere", R"({"solids": [], "type": "sphere"})",
     R"(/0/solids: "solids" in a sphere, expected it only in a group)"},
    {"duplicateKey", R"({"type": "sphere", "radius": 1, "center": [0, 0, 0], "radius": 2})",
     R"(/0/radius: duplicate key "radius", expected each key once)"},
    {"duplicateSolids", R"({"type": "group", "solids": [], "solids": []})",
     R"(/0/solids: duplicate key "solids", expected each key once)"},
    {"emptyName", R"({"type": "group", "name": "", "solids": []})",
     "/0/name: the name is empty, expected a text or no name at all"},
    {"nameNotText", R"({"type": "group", "name": 1, "solids": []})", "/0/name: wrong type: a number, expected a text"},
    {"duplicateName",
     R"({"type": "sphere", "name": "a", "center": [0,0,0], "radius": 1}, {"type": "group", "name": "a", "solids": []})",
     R"(/1/name: duplicate name "a", expected a name of its own (it is that of sphere 0))"},
};

TEST(BadSolids, AreRefusedInOneExactLine) {
  for (const BadSolid& bad : kBadSolids) {
    SCOPED_TRACE(bad.name);
    EXPECT_EQ(refusal(withSolids(bad.solids)), std::string("s.json: /solids") + bad.expected);
  }
}

TEST(BadSolids, LongTextIsCutInMessages) {
  const std::string key(100'000, 'k');
  const std::string line = refusal(withSolids("{\"type\": \"sphere\", \"" + key + "\": 1}"));
  EXPECT_LT(line.size(), 400u);
  EXPECT_NE(line.find("unknown key"), std::string::npos);
}

TEST(BadSolids, ExtremeNumbersAreHeldAsParsed) {
  const Scene scene = parse(withSolids(
      R"({"type": "sphere", "center": [3.4028234663852886e38, -3.4028234663852886e38, 5e-324], "radius": 0.1})"));
  EXPECT_EQ(scene.world.solids[0].shape, Shape(Sphere{{0x1.fffffep127, -0x1.fffffep127, 0x1p-1074}, 0.1}));
  EXPECT_NE(
      refusal(withSolids(R"({"type": "sphere", "center": [0, 0, 0], "radius": 3.4028234663852889e38})")).find(kBeyond),
      std::string::npos);
}

// A sliver one ulp from collinear is drawn, with a warning; the collinear one is refused (above).
TEST(Slivers, AreWarnedOfAndNotRefused) {
  EXPECT_EQ(
      firstWarning(R"({"type": "triangle", "vertices": [[1e7, 0, 0], [1e7, 1, 1], [1e7, 3, 3.0000000000000004]]})"),
      "s.json: /solids/0/vertices: sliver: area is below 1e-06 of the longest edge squared");
  EXPECT_EQ(
      firstWarning(
          R"({"type": "quad", "vertex": [0, 0, 0], "span1": [0.1, 0.2, 0.3], "span2": [0.2, 0.4, 0.6000000000000001]})"),
      "s.json: /solids/0: sliver: area is below 1e-06 of the longer span squared");
  EXPECT_EQ(
      firstWarning(R"({"type": "infinite_plane", "points": [[1e7, 0, 0], [1e7, 1, 1], [1e7, 3, 3.0000000000000004]]})"),
      "no warning");  // a plane is as wide as any other, however near its points lie to a line
  EXPECT_EQ(firstWarning(R"({"type": "triangle", "vertices": [[0, 0, 0], [1, 0, 0], [0, 1e-5, 0]]})"), "no warning");
  EXPECT_EQ(firstWarning(R"({"type": "triangle", "vertices": [[0, 0, 0], [1e-200, 0, 0], [0, 1e-200, 0]]})"),
            "no warning");
}

TEST(Slivers, FlatBoxesAreDrawn) {
  const auto box = [](const std::string& corner) {
    return firstWarning(R"({"type": "box", "corner1": [0, 0, 0], "corner2": )" + corner + "}");
  };
  EXPECT_EQ(box("[1, 1, 1]"), "no warning");
  EXPECT_EQ(box("[1, 0, 1]"), "s.json: /solids/0: the box has no extent along y: it is a rectangle");
  EXPECT_EQ(box("[0, 0, 1]"),
            "s.json: /solids/0: the box has no extent along x, y: it is a line, which hardly a ray hits");
  EXPECT_EQ(box("[0, 0, 0]"),
            "s.json: /solids/0: the box has no extent along x, y, z: it is a point, which hardly a ray hits");
}

TEST(Slivers, RadiusBelowFp32IsWarnedOf) {
  EXPECT_EQ(firstWarning(R"({"type": "sphere", "center": [0, 0, 0], "radius": 1e-40})"),
            "s.json: /solids/0/radius: radius 1e-40 is below the smallest normal fp32 number, expected at least "
            "1.1754943508222875e-38: it will hardly be seen");
}

TEST(Slivers, ManyWarningsAreCounted) {
  std::string solids;
  for (int i = 0; i < 50; ++i)
    solids += std::string(i ? "," : "") + R"({"type": "box", "corner1": [0, 0, 0], "corner2": [1, 0, 1]})";
  std::vector<std::string> warnings;
  parse(withSolids(solids), &warnings);
  ASSERT_EQ(warnings.size(), 21u);
  EXPECT_EQ(warnings.back(), "s.json: 30 more warnings of this kind");
}

}  // namespace
}  // namespace solidcast
