// A race means something only if all show the same picture: every peer's image is held against the fp64 reference's, on
// the bundled scenes and on random ones. Peers cast in fp32, so a pixel on an edge may show another solid; the budgets
// say how many, and are about twice what was counted.
#include <gtest/gtest.h>

#include "host/bench/peer.h"
#include "host/bench/scenes.h"
#include "host/error.h"
#include "host/image/compare.h"

namespace solidcast::bench {
namespace {

constexpr int kWidth = 317, kHeight = 203;  // no whole number of packets

Scene named(const std::string& name) {
  std::vector<std::string> warnings;
  Scene scene = sceneNamed(name, warnings);
  scene.width = kWidth, scene.height = kHeight;
  return scene;
}

Image imageOf(Peer& peer) {
  peer.run();
  return peer.image();
}
Image truthOf(const Scene& scene) { return imageOf(*referencePeer(scene, kWidth, kHeight, reference::Precision::f64)); }

/// Expects at most `budget` pixels more than a level off, by the kernels of each instruction set that the CPU has.
template <class MakePeer>
void expectSame(const Image& truth, std::int64_t budget, const MakePeer& make) {
  for (const Kernels* kernels : {&kAvx2, kernelsOfCpu()})
    for (const bool flag : {false, true}) {
      const auto peer = make(flag, kernels);
      EXPECT_LE(compareImages(imageOf(*peer), truth, {0, 1}).beyond, budget) << peer->name() << ", " << kernels->name;
    }
}

void expectEmbree(const Scene& scene, const Image& truth, std::int64_t budget) {
#ifdef SOLIDCAST_EMBREE
  expectSame(truth, budget, [&](bool packets, const Kernels* kernels) {
    return embreePeer(scene, kWidth, kHeight, packets, kernels);
  });
#else  // and says how to get it
  try {
    embreePeer(scene, kWidth, kHeight, budget >= 0);
    FAIL() << truth.width;
  } catch (const Error& error) { EXPECT_NE(std::string(error.what()).find("libembree-dev"), std::string::npos); }
#endif
}
void expectSimd(const Scene& scene, const Image& truth, std::int64_t budget) {
  expectSame(truth, budget, [&](bool skipping, const Kernels* kernels) {
    return simdPeer(scene, kWidth, kHeight, skipping, kernels);
  });
}

struct Case {
  const char* scene;
  std::int64_t embree, simd;  // pixels that may differ, of 64,351; -1: refused
};
void PrintTo(const Case& which, std::ostream* out) { *out << which.scene; }
class Peers : public testing::TestWithParam<Case> {};

TEST_P(Peers, ShowTheSamePicture) {
  const Scene scene = named(GetParam().scene);
  const Image truth = truthOf(scene);
  expectEmbree(scene, truth, GetParam().embree);
  if (GetParam().simd >= 0) expectSimd(scene, truth, GetParam().simd);
  else EXPECT_THROW(simdPeer(scene, kWidth, kHeight, false), Error);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Peers,
                         testing::Values(Case{"a_solids", 0, 0}, Case{"quadrics", 0, 0}, Case{"showpiece", 2, 20},
                                         Case{"environment", 0, 0}, Case{"orthographic", 0, -1},
                                         Case{"nested_groups", 0, 30}, Case{"random:sphere:200", 0, 2},
                                         Case{"random:triangle:200", 0, 2}, Case{"random:quad:200", 0, 2},
                                         Case{"random:disc:200", 0, 2}, Case{"random:box:200", 0, 2},
                                         Case{"random:quadric:60", 2, 6}, Case{"random:infinite_plane:30", 0, 0},
                                         Case{"random:mixed:200", 4, 4}),
                         [](const auto& info) {
                           std::string name = info.param.scene;
                           for (char& c : name)
                             if (c == ':') c = '_';
                           return name;
                         });

/// What is seen from inside: the far side of a sphere, a box, an ellipsoid.
TEST(Inside, AllShowTheFarSide) {
  const Shape solids[] = {Sphere{{0.5, 0, 0}, 3}, AABox{{-2, -3, -4}, {3, 4, 5}},
                          Quadric{{1, 2, 3, 0.5, 0, 0.25, 0, 0, 0.5, -9}}};
  for (const Shape& shape : solids) {
    Scene scene;
    scene.twoSided = true;
    scene.world.solids.push_back({"", shape});
    scene.world.groups[0].members.push_back({false, 0});
    const Image truth = truthOf(scene);
    EXPECT_GT(std::get<0>(truth.values)[0], 0) << "seen";
    expectEmbree(scene, truth, 0);
    expectSimd(scene, truth, 0);
  }
}

}  // namespace
}  // namespace solidcast::bench
