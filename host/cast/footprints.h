// Where solids are seen, a block of them at a time: the same conservative rectangles as silhouette.h, by arithmetic that
// the compiler turns into vectors. It was the largest part of a picture of many solids.
//
// Spheres, the centre c from the eye in camera axes, are seen between the slopes of the tangents of their shadows,
//   x/depth = (c.x c.depth -+ r sqrt(c.x^2 + c.depth^2 - r^2)) / (c.depth^2 - r^2), and the same in y: one division in all;
// triangles, quads and boxes between the slopes of their corners. What is not wholly in front of the eye, other kinds and
// other cameras are left to Silhouette.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "host/cast/silhouette.h"

namespace solidcast {

/// Pixels of a region whose centres a solid can cover, first and last, counted from the region's corner.
struct Footprint {
  std::int32_t x0, y0, x1, y1;
  float nearest;  // Rectangle::nearest, rounded down
  float hides;    // about the depth beyond which it can hide others: a sphere's middle, a polygon's farthest corner
  bool seen() const { return x0 <= x1 && y0 <= y1; }
};

class Footprints {
 public:
  static constexpr std::size_t block = 64;

  Footprints(const Silhouette& silhouette, const Crop& region, const Frame<double>& eye);

  /// Of at most `block` solids; [i] then tells of the i-th.
  void find(std::span<const SolidEntry> solids);
  const Footprint& operator[](std::size_t i) const { return found_[i]; }
  /// Some sphere of all so far, seen or not, needs sphere.glsl's FAR_SPHERES.
  bool farSphere() const { return farSphere_; }

  /// The camera and the region, as the arithmetic takes them. Pixels are counted from the region's corner.
  struct View {
    double origin[3], axes[3][3];
    double perX, perY, lowX, lowY, highX, highY;  // pixel of a slope s: from s per + low, to s per + high
    double lastX, lastY;
    double inverseUnit;  // of length
  };
  /// Numbers of the block's solids of one kind, one array a number; `at`: the solid's place in the block.
  template <std::size_t NUMBERS>
  struct Batch {
    alignas(64) double v[NUMBERS][block];
    std::array<std::uint8_t, block> at;
    std::size_t count = 0;
  };
  struct Result {
    alignas(64) std::int32_t x0[block], y0[block], x1[block], y1[block], plain[block];  // plain: it serves
    alignas(64) float nearest[block], hides[block];
  };

 private:
  Footprint ask(const Shape& shape) const;
  template <class Corners>
  static void add(const Corners& corners, Batch<3 * std::tuple_size_v<Corners>>& batch, std::size_t at);
  template <std::size_t NUMBERS>
  void spread(Batch<NUMBERS>& batch, std::span<const SolidEntry> solids);

  const Silhouette& silhouette_;
  Crop region_;
  View view_;
  bool vectors_;
  bool farSphere_ = false;
  std::array<Footprint, block> found_;
  Batch<4> spheres_;
  Batch<9> triangles_;
  Batch<12> quads_;
  Batch<24> boxes_;
  Result result_;
};

}  // namespace solidcast
