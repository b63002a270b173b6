// One device for all tests of the program, with validation where ctest asks for it: a single message fails the test.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "host/scene/load.h"
#include "tests/cast/measure.h"

namespace solidcast {

class OnDevice : public testing::Test {
 protected:
  static gpu::Device& device() {
    static gpu::Device instance({.select = "llvmpipe"});
    return instance;
  }
  void SetUp() override { before_ = device().validationMessages(); }
  void TearDown() override { EXPECT_EQ(device().validationMessages(), before_) << "see standard error"; }

 private:
  int before_ = 0;
};

inline constexpr Method kMethods[] = {Method::naive, Method::fast, Method::exact};
inline const char* nameOf(Method method) {
  return method == Method::naive ? "naive" : method == Method::fast ? "fast" : "exact";
}

inline Channels allChannels() { return {true, true, true, true, true, true, true}; }

inline Scene loaded(const std::string& name) {
  std::vector<std::string> warnings;
  return loadScene(std::string(SOLIDCAST_SOURCE_DIR) + "/scenes/" + name, warnings);
}

inline std::vector<std::string> bundledScenes() {
  namespace fs = std::filesystem;
  const fs::path root = std::string(SOLIDCAST_SOURCE_DIR) + "/scenes";
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.path().extension() == ".json" && entry.path().filename() != "scene.schema.json")
      names.push_back(fs::relative(entry.path(), root));
  return names;
}

inline std::vector<QueryHit> castAll(gpu::Device& device, const World& world, const std::vector<QueryRay>& rays,
                                     const CastOptions& options = {}) {
  std::vector<QueryHit> hits(rays.size());
  QueryCaster(device, world, options).cast(rays, hits);
  return hits;
}

inline void expectSame(const Band& a, const Band& b, const std::string& what = "") {
  // As bytes: NaN would hide a difference, and +0 is not -0.
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() && std::equal(std::as_bytes(std::span(x)).begin(), std::as_bytes(std::span(x)).end(),
                                              std::as_bytes(std::span(y)).begin());
  };
  EXPECT_TRUE(same(a.rgb8, b.rgb8)) << what;
  EXPECT_TRUE(same(a.radiance, b.radiance)) << what;
  EXPECT_TRUE(same(a.distance, b.distance)) << what;
  EXPECT_TRUE(same(a.solid, b.solid)) << what;
  EXPECT_TRUE(same(a.normal, b.normal)) << what;
  EXPECT_TRUE(same(a.local, b.local)) << what;
  EXPECT_TRUE(same(a.position, b.position)) << what;
}

}  // namespace solidcast
