// What is compiled once for each instruction set, and chosen when the program runs.
#pragma once
#include <cstdint>

#include "host/bench/rays.h"

struct RTCSceneTy;
struct RTCIntersectFunctionNArguments;

namespace solidcast::bench {

/// Records of the solids relative to the shared origin o: what depends on it alone is calculated once. f is the solid's
/// point minus o (triangle, quad: o minus the vertex).
///   plane     n num                  n unit, num = n.f
///   sphere    f C sign sign/r        C = |f|^2 - r^2, sign -1 from inside
///   disc      n num f r^2
///   triangle  n num U V              U = f x e2, V = e1 x f, num = -n.f, all over |e1 x e2|
///   quad      as the triangle
///   box       lo hi                  minus o
///   quadric   xx yy zz 2xy 2xz 2yz w C   A = d'Md, B = w.d
struct SimdScene {
  enum Kind { plane, sphere, disc, triangle, quad, box, quadric, kinds };
  const float* records[kinds];
  int count[kinds];
};
constexpr int kSimdFloats[SimdScene::kinds] = {4, 6, 8, 10, 10, 6, 10};

/// Solids of the kinds that Embree does not have, as its callbacks get them:
///   planes    n num                num = n.point
///   boxes     lo hi
///   quadrics  xx yy zz 2xy 2xz 2yz l j place   p'Mp + 2 l.p + j with p counted from `place`
struct UserSolids {
  const float* records;
};
constexpr int kUserFloats[3] = {4, 6, 13};

struct Kernels {
  const char* name;  // "avx512"
  int width;         // rays at a time
  /// Rows [first, first + kPacketRows) of the image.
  void (*simdRows)(const SimdScene&, const RayView&, const Light&, std::uint32_t* out, int first);
  void (*simdRowsSkipping)(const SimdScene&, const RayView&, const Light&, std::uint32_t* out, int first);
  // nullptr in a build without Embree
  void (*embree16)(RTCSceneTy*, const RayView&, const Light&, std::uint32_t* out, int first) = nullptr;
  void (*embree1)(RTCSceneTy*, const RayView&, const Light&, std::uint32_t* out, int first) = nullptr;
  void (*embreePlanes)(const RTCIntersectFunctionNArguments*) = nullptr;
  void (*embreeBoxes)(const RTCIntersectFunctionNArguments*) = nullptr;
  void (*embreeQuadrics)(const RTCIntersectFunctionNArguments*) = nullptr;
};
extern const Kernels kAvx512, kAvx2;

/// The best for this CPU; nullptr where it has not even AVX2 and FMA.
const Kernels* kernelsOfCpu();

}  // namespace solidcast::bench
