// Ways of a camera: turntables close, keys are met, and what is no path is refused with its place.
#include "host/scene/camera_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "host/error.h"
#include "host/scene/load.h"

namespace solidcast {
namespace {

double distance(const Triple& a, const Triple& b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

const PerspectiveCamera& perspective(const Camera& camera) { return std::get<PerspectiveCamera>(camera); }

TEST(CameraPath, ATurntableKeepsItsDistanceAndComesBack) {
  Scene scene = aSolids();
  const Triple pivot = pointLookedAt(scene);
  const PerspectiveCamera& start = perspective(scene.camera);
  const double radius = distance(start.center, pivot);
  EXPECT_GT(radius, 1);
  for (const double angle : {30.0, 90.0, 180.0, 275.0}) {
    const PerspectiveCamera turned = perspective(orbited(scene.camera, pivot, angle));
    EXPECT_NEAR(distance(turned.center, pivot), radius, 1e-12 * radius);
    EXPECT_NEAR(distance(turned.center, start.center), 2 * radius * std::sin(angle * M_PI / 360), 1e-12 * radius);
    // It still looks at the pivot.
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(turned.center[i] + radius * turned.forward[i], pivot[i], 1e-12 * radius);
  }
  EXPECT_LT(distance(perspective(orbited(scene.camera, pivot, 360)).center, start.center), 1e-12 * radius);
}

TEST(CameraPath, NothingAheadIsOneUnitAhead) {
  Scene scene;
  scene.camera = PerspectiveCamera{{1, 2, 3}, {0, 0, -2}, {0, 1, 0}, 45, 60};
  EXPECT_EQ(pointLookedAt(scene), (Triple{1, 2, 2}));
  scene.world.solids.push_back({"", Sphere{{1, 2, 8}, 1}, 0});  // behind
  EXPECT_EQ(pointLookedAt(scene), (Triple{1, 2, 2}));
}

TEST(CameraPath, KeysAreMetAndNumbersMixedBetween) {
  const PerspectiveCamera a{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 40, 60}, b{{2, 0, 0}, {-1, 0, 0}, {0, 1, 0}, 50, 80};
  const CameraPath path = {a, b, a};
  EXPECT_EQ(cameraAt(path, 0), Camera(a));
  EXPECT_EQ(cameraAt(path, 0.5), Camera(b));
  EXPECT_EQ(cameraAt(path, 1), Camera(a));
  const PerspectiveCamera half = perspective(cameraAt(path, 0.25));
  EXPECT_EQ(half.center, (Triple{1, 0, 0}));
  EXPECT_EQ(half.verticalAngle, 45);
  EXPECT_EQ(half.horizontalAngle, 70);
  EXPECT_NEAR(half.forward[0], half.forward[2], 1e-15);
}

TEST(CameraPath, OppositeKeysHaveNoMiddle) {
  const PerspectiveCamera a{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 40, 60}, b{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 40, 60};
  EXPECT_THROW(cameraAt({a, b}, 0.5), Error);
}

class CameraPathFile : public ::testing::Test {
 protected:
  ~CameraPathFile() override { std::filesystem::remove(file_); }
  CameraPath load(const std::string& text) {
    std::ofstream(file_) << text;
    std::vector<std::string> warnings;
    return loadCameraPath(file_, warnings);
  }
  void expectRefused(const std::string& text, const std::string& part) {
    try {
      load(text);
      ADD_FAILURE() << "not refused: " << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), Exit::usage);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
  std::string file_ = ::testing::TempDir() + "camera_path_test_" + std::to_string(getpid()) + ".json";
  const std::string key_ = R"({"type": "perspective", "center": [0,0,0], "forward": [0,0,-1], "up": [0,1,0],
                               "vertical_angle": 45, "horizontal_angle": 60})";
};

TEST_F(CameraPathFile, IsAListOfCameras) {
  EXPECT_EQ(load("[" + key_ + "," + key_ + "] // comments may stand here").size(), 2u);
}

TEST_F(CameraPathFile, IsRefusedWithItsPlace) {
  expectRefused("[", "is not JSON");
  expectRefused("{}", "expected a list of cameras");
  expectRefused("[]", "holds no camera");
  expectRefused("[" + key_ + ", {\"type\": \"pinhole\"}]", "/1/type");
  expectRefused("[" + key_ + R"(, {"type": "orthographic", "center": [0,0,0], "forward": [0,0,-1], "up": [0,1,0],
                 "scale_x": 1, "scale_y": 1}])",
                "/1/type: another kind of camera");
  std::vector<std::string> warnings;
  EXPECT_THROW(loadCameraPath("/no/such/file.json", warnings), Error);
}

}  // namespace
}  // namespace solidcast
