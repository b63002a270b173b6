// Meshes: the same triangles from OBJ and every kind of PLY, where they are placed, what is left out, and every refusal.
#include "host/scene/mesh.h"

#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "host/scene/write.h"
#include "tests/scene/scene_text.h"

namespace solidcast {
namespace {

namespace fs = std::filesystem;

class MeshFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              (std::string("solidcast_mesh_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// The message about a file of this text without its folder, or "accepted".
  std::string refusalOf(const std::string& name, const std::string& text) {
    const std::string file = write(name, text);
    try {
      readMesh(file);
    } catch (const Fault& fault) {
      EXPECT_TRUE(fault.text.starts_with(file)) << fault.text;
      return fault.text.substr(file.size());
    }
    return "accepted";
  }

  Scene sceneWith(const std::string& solids, std::vector<std::string>& warnings) {
    return parseScene(withSolids(solids), folder_ / "s.json", warnings);
  }

  fs::path folder_;
};

std::vector<Triangle> trianglesOf(const World& world) { return world.solids.of<Triangle>(); }

constexpr char kTetrahedron[] = "v 0 0 0\nv 1 0 0\nv 0 0.1 0\nv 0 0 -2.5e-3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
constexpr char kPlyHead[] =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n";

std::string asciiPly(const std::string& body) { return "ply\nformat ascii 1.0\n" + (kPlyHead + body); }

template <class Number>
void put(std::string& bytes, Number number, bool big) {
  auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(number);
  if (big != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

/// With a property and an element to be read over, and doubles, so that no digit is lost.
std::string binaryPly(const Mesh& mesh, bool big) {
  std::string text = "ply\r\nformat binary_" + std::string(big ? "big" : "little") +
                     "_endian 1.0\r\ncomment made by a test\r\nelement vertex " + std::to_string(mesh.vertices.size()) +
                     "\r\nproperty uchar red\r\nproperty double x\r\nproperty double y\r\nproperty double z\r\n" +
                     "element face " + std::to_string(mesh.triangles.size()) +
                     "\r\nproperty float weight\r\nproperty list uint16 uint32 vertex_index\r\nend_header\r\n";
  for (const Triple& vertex : mesh.vertices) {
    put(text, std::uint8_t{200}, big);
    for (const double number : vertex) put(text, number, big);
  }
  for (const auto& triangle : mesh.triangles) {
    put(text, 0.5f, big);
    put(text, std::uint16_t{3}, big);
    for (const std::uint32_t index : triangle) put(text, index, big);
  }
  return text;
}

TEST_F(MeshFiles, NumbersAreFp64AsWrittenInTheFilesOrder) {
  const Mesh mesh = readMesh(write("a.obj", kTetrahedron));
  const std::vector<Triple> vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}, {0, 0, -2.5e-3}};
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  EXPECT_EQ(mesh.vertices, vertices);
  EXPECT_EQ(mesh.triangles, triangles);
}

TEST_F(MeshFiles, EveryFormatGivesTheSameTriangles) {
  const Mesh mesh = readMesh(SOLIDCAST_SOURCE_DIR "/scenes/meshes/knot.obj");
  EXPECT_EQ(mesh.triangles.size(), 480u);
  std::string ascii = "ply\nformat ascii 1.0\nobj_info x\nelement face " + std::to_string(mesh.triangles.size()) +
                      "\nproperty list uint8 int32 vertex_indices\nelement vertex " +
                      std::to_string(mesh.vertices.size()) +
                      "\nproperty float64 z\nproperty float64 y\nproperty float64 x\nend_header\n";
  for (const auto& t : mesh.triangles)
    ascii += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
  for (const Triple& v : mesh.vertices)
    ascii += shortest(v[2]) + " " + shortest(v[1]) + (v[0] > 0 ? " +" : " ") + shortest(v[0]) + "\n";
  const Mesh read = readMesh(write("faces_first.ply", ascii));
  EXPECT_EQ(read.triangles, mesh.triangles);
  EXPECT_EQ(read.vertices, mesh.vertices);
  for (const bool big : {false, true}) {
    const Mesh binary = readMesh(write(big ? "big.PLY" : "little.ply", binaryPly(mesh, big)));
    EXPECT_EQ(binary.vertices, mesh.vertices);
    EXPECT_EQ(binary.triangles, mesh.triangles);
  }
}

TEST_F(MeshFiles, ObjFacesOfEveryKind) {
  const Mesh mesh =
      readMesh(write("a.obj",
                     "mtllib x.mtl\nf 1 2 3 # before its vertices\nv 0 0 0\r\nv 1 0 \\\n0\nv 1 1 0 1\nv 0 1 "
                     "0\nvt 0 0\ng one\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1 4/1/1\n"
                     "usemtl red\nf -4 -3 -1\nl 1 2\nf 1 2\nf 1 2 3"));
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2},
                                                               {0, 2, 3}, {0, 1, 3}, {0, 1, 2}};
  EXPECT_EQ(mesh.triangles, triangles);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.thin, 1u);
  EXPECT_EQ(mesh.bent, 0u);
}

TEST_F(MeshFiles, APolygonThatIsNotConvexIsCounted) {
  const std::string arrow = "v 0 0 0\nv 2 -1 0\nv 0 2 0\nv -2 -1 0\n";
  EXPECT_EQ(readMesh(write("a.obj", arrow + "f 1 2 3 4\n")).bent, 0u);  // from the notch every corner is seen
  EXPECT_EQ(readMesh(write("b.obj", arrow + "f 2 3 4 1\n")).bent, 1u);
}

TEST_F(MeshFiles, AGroupOfItsOwnInTheScenesOrder) {
  write("m.obj", kTetrahedron);
  std::vector<std::string> warnings;
  const Scene scene = sceneWith(R"({"type": "sphere", "center": [0,0,0], "radius": 1},
      {"type": "mesh", "name": "it", "file": "m.obj"}, {"type": "sphere", "center": [5,0,0], "radius": 1})",
                                warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_NO_THROW(checkScene(scene, warnings));
  ASSERT_EQ(scene.world.solids.size(), 6u);
  ASSERT_EQ(scene.world.groups.size(), 2u);
  EXPECT_EQ(scene.world.groups[1].name, "it");
  EXPECT_EQ(scene.world.groups[1].members.size(), 4u);
  EXPECT_EQ(std::get<Triangle>(scene.world.solids[1].shape), (Triangle{{0, 0, 0}, {0, 0.1, 0}, {1, 0, 0}}));
  // Written, it is a group of triangles, and reads back as the same world.
  std::string text;
  writeScene(scene, "", [&](std::string_view piece) { text += piece; });
  EXPECT_EQ(parseScene(text, "other.json", warnings).world, scene.world);
}

TEST_F(MeshFiles, PlacedByScaleThenTurnThenShift) {
  write("m.obj", "v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
  std::vector<std::string> warnings;
  const auto placed = [&](const std::string& how) {
    return trianglesOf(sceneWith("{\"type\": \"mesh\", \"file\": \"m.obj\"" + how + "}", warnings).world)[0];
  };
  // Quarters of a turn leave no rounding behind.
  EXPECT_EQ(placed(R"(, "rotate": [0, 0, 7, 90])"), (Triangle{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}));
  EXPECT_EQ(placed(R"(, "rotate": [1, 0, 0, -450])"), (Triangle{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}));
  EXPECT_EQ(placed(R"(, "scale": 0.1, "rotate": [0, 1, 0, 180], "translate": [0.2, 3, 0])"),
            (Triangle{{0.2 - 0.1, 3, 0}, {0.2, 3.1, 0}, {0.2, 3, -0.1}}));
  // A third of a turn about the diagonal goes from axis to axis, but for the last place.
  const Triangle third = placed(R"(, "rotate": [1, 1, 1, 120])");
  EXPECT_NEAR(third.v1[1], 1, 1e-16);
  EXPECT_NEAR(third.v2[2], 1, 1e-16);
  EXPECT_NEAR(third.v3[0], 1, 1e-16);
}

TEST_F(MeshFiles, FacesWithoutAreaAreLeftOutWithOneWarning) {
  write("m.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 1e-8 0 1\nv 0 0 1\nf 1 2 4\nf 1 2 3\nf 1 1 2\nf 1 5 6\nf 1 2\n");
  std::vector<std::string> warnings;
  const Scene scene = sceneWith(R"({"type": "mesh", "file": "m.obj"})", warnings);
  EXPECT_EQ(scene.world.solids.size(), 2u);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0], std::string(folder_ / "s.json") + ": /solids/0/file: " + std::string(folder_ / "m.obj") +
                             ": of 4 triangles: 3 faces without area are left out; 1 triangles are slivers");
}

TEST_F(MeshFiles, RefusalsNameFileAndLine) {
  EXPECT_EQ(refusalOf("a.obj", ""), ": the file has 0 vertices and no faces, expected at least one triangle");
  EXPECT_EQ(refusalOf("a.obj", "v 0 0"), ":1: the file ends, expected z");
  EXPECT_EQ(refusalOf("a.obj", "\nv 0 0\nf"), ":2: the line ends, expected z");
  EXPECT_EQ(refusalOf("a.obj", "v 0 1,5 0\n"), ":1: found \"1,5\", expected y");
  EXPECT_EQ(refusalOf("a.obj", "v 0 nan 0\n"), ":1: nan is not finite, expected a finite number");
  EXPECT_EQ(refusalOf("a.obj", "v 0 1e39 0\n"),
            ":1: number 1e+39 is beyond fp32, expected at most 3.4028234663852886e+38 in size");
  EXPECT_EQ(refusalOf("a.obj", "v 0 1e-999 0\nv 1 0 0\nv 0 1 0\nf 1 2 3"), "accepted");
  const std::string number = "the number of a vertex (from 1, or from -1 backwards)";
  EXPECT_EQ(refusalOf("a.obj", "v 0 0 0\nf 1 0 1\n"),
            ":2: vertex 0 does not exist, expected " + number + "; 1 stand above");
  EXPECT_EQ(refusalOf("a.obj", "v 0 0 0\nf 1 1 -2\n"),
            ":2: vertex -2 does not exist, expected " + number + "; 1 stand above");
  EXPECT_EQ(refusalOf("a.obj", "v 0 0 0\nf 1 1 2\nf 1 1 1"),
            ":2: vertex 2 does not exist, expected " + number + "; the file has 1");
  EXPECT_EQ(refusalOf("a.obj", "f 1 x 2\n"), ":1: found \"x\", expected " + number);

  EXPECT_EQ(refusalOf("a.ply", ""), ": the file does not begin with \"ply\", expected a PLY file");
  EXPECT_EQ(refusalOf("a.ply", "ply\nformat ascii 1.0\n"), ":3: the file ends in the header, expected \"end_header\"");
  EXPECT_EQ(
      refusalOf("a.ply", "ply\nformat asci 1.0\n"),
      ":2: unknown format \"asci\", expected one of ascii, binary_little_endian, binary_big_endian (the nearest is "
      "ascii)");
  EXPECT_EQ(
      refusalOf("a.ply", "ply\nelement vertex 1\nproperty flot x\n"),
      ":3: unknown type \"flot\", expected one of char, uchar, short, ushort, int, uint, float, double (the nearest "
      "is float)");
  EXPECT_EQ(refusalOf("a.ply", asciiPly("0 0 0 1 0 0 0 1 0 0 0 1\n3 0 1 4\n")),
            ":11: vertex 4 does not exist, expected 0 to 3");
  EXPECT_EQ(refusalOf("a.ply", asciiPly("0 0 0 1 0 0 0 1 0 0 0 1\n3 0 1")),
            ":11: the file ends, expected the number of a vertex");
  EXPECT_EQ(refusalOf("a.ply", asciiPly("0 0 0 1 0 0 0 1 0 0 0 1\n3 0 1.5 2")),
            ":11: found \"1.5\", expected the number of a vertex");
  EXPECT_EQ(refusalOf("a.ply", asciiPly("0 0")),
            ":10: the header promises 4 of \"vertex\", expected at most 1 in the 3 bytes that follow");
  EXPECT_EQ(refusalOf("a.stl", "solid"), ": the file's ending is unknown, expected .ply or .obj");
  const Mesh mesh = readMesh(write("t.obj", kTetrahedron));
  const std::string binary = binaryPly(mesh, false);
  EXPECT_EQ(refusalOf("b.ply", binary.substr(0, binary.size() - 1)),
            ": face 3, the number of a vertex: the file ends, expected 4 bytes more");
}

TEST_F(MeshFiles, OnlyRegularFiles) {
  fs::create_directory(folder_ / "folder.ply");
  fs::create_symlink("/dev/zero", folder_ / "zero.ply");
  EXPECT_THROW(readMesh(folder_ / "folder.ply"), Fault);
  EXPECT_THROW(readMesh(folder_ / "zero.ply"), Fault);
  std::vector<std::string> warnings;
  try {
    sceneWith(R"({"type": "mesh", "file": "none.ply"})", warnings);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), std::string(folder_ / "s.json") + ": /solids/0/file: " + std::string(folder_ / "none.ply") +
                                ": no such file, expected a mesh file (.ply or .obj)");
    EXPECT_EQ(error.code(), Exit::usage);
  }
}

TEST_F(MeshFiles, BadPlacementsAreRefused) {
  const std::string mesh = R"({"type": "mesh", "file": "m.obj", )";
  EXPECT_EQ(refusal(withSolids(mesh + R"("scale": 0})")),
            "s.json: /solids/0/scale: 0 is not positive, expected a number above 0");
  EXPECT_EQ(refusal(withSolids(mesh + R"("rotate": [0, 0, 0, 1]})")),
            "s.json: /solids/0/rotate: the vector is zero, expected a direction");
  EXPECT_EQ(refusal(withSolids(mesh + R"("solids": []})")),
            "s.json: /solids/0/solids: \"solids\" in a mesh, expected it only in a group");
  EXPECT_EQ(refusal(withSolids(R"({"type": "mesh"})")), "s.json: /solids/0: missing field \"file\", expected a text");
}

TEST_F(MeshFiles, AMeshFileIsASceneThatSeesAllOfIt) {
  std::vector<std::string> warnings;
  const Scene scene = loadScene(SOLIDCAST_SOURCE_DIR "/scenes/meshes/knot.obj", warnings);
  EXPECT_TRUE(warnings.empty());
  EXPECT_NO_THROW(checkScene(scene, warnings));
  EXPECT_TRUE(scene.twoSided);
  ASSERT_TRUE(scene.distParameters.has_value());
  const auto& camera = std::get<PerspectiveCamera>(scene.camera);
  const double limit = std::cos(22.5 * 3.14159265358979 / 180);
  for (const Triangle& triangle : trianglesOf(scene.world))
    for (const Triple& vertex : {triangle.v1, triangle.v2, triangle.v3}) {
      double along = 0, length = 0;
      for (int i = 0; i < 3; ++i) {
        const double d = vertex[i] - camera.center[i];
        along += d * camera.forward[i], length += d * d;
      }
      length = std::sqrt(length);
      EXPECT_GE(along, limit * length);
      EXPECT_GE(length, scene.distParameters->nearDist * 0.999);
      EXPECT_LE(length, scene.distParameters->farDist * 1.001);
    }
}

// Damaged files are refused or read, and nothing else; under the sanitizers this finds what reads beyond an end.
TEST_F(MeshFiles, DamageIsRefusedOrRead) {
  const Mesh mesh = readMesh(write("t.obj", kTetrahedron));
  const std::pair<const char*, std::string> files[] = {{"d.obj", kTetrahedron},
                                                       {"a.ply", asciiPly("0 0 0\n1 0 0\n0 1 0\n0 0 1\n4 0 1 2 3\n")},
                                                       {"l.ply", binaryPly(mesh, false)},
                                                       {"b.ply", binaryPly(mesh, true)}};
  for (const auto& [name, whole] : files) {
    int refused = 0;
    for (unsigned seed = 0; seed < 150; ++seed) {
      std::mt19937 random(seed);
      std::string text = whole;
      if (random() % 4 == 0) text.resize(1 + random() % text.size());
      for (unsigned edits = random() % 4; edits > 0 && !text.empty(); --edits) {
        const std::size_t place = random() % text.size();
        if (random() % 2) text[place] = static_cast<char>(random());
        else text.erase(place, 1 + random() % 5);
      }
      refused += refusalOf(name, text) != "accepted";
    }
    EXPECT_GT(refused, 20) << name;
    EXPECT_LT(refused, 150) << name;
  }
}

}  // namespace
}  // namespace solidcast
