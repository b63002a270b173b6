// Where solids are seen, a block of them at a time: the same conservative rectangles as silhouette.h, by arithmetic that
// the compiler turns into vectors. It was the largest part of a picture of many solids. And what they certainly cover, for
// depth_bounds.h.
//
// Spheres, the centre c from the eye in camera axes, are seen between the slopes of the tangents of their shadows,
//   x/depth = (c.x c.depth -+ r sqrt(c.x^2 + c.depth^2 - r^2)) / (c.depth^2 - r^2), and the same in y: one division in all;
// triangles, quads and boxes between the slopes of their corners. What is not wholly in front of the eye, other kinds and
// other cameras are left to Silhouette.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "host/cast/depth_code.h"
#include "host/cast/silhouette.h"

namespace solidcast {

/// Pixels of a region whose centres a solid can cover, first and last, counted from the region's corner.
struct Footprint {
  std::int32_t x0, y0, x1, y1;
  DepthCode nearest;  // of Rectangle::nearest
  DepthCode hides;    // beyond it, what the solid covers is hidden; DepthScale::none: hides nothing
  // Of a solid in no more than 2x2 tiles of the region: which of them it is not seen in, bits by rows. 0 of others.
  std::uint8_t misses;
  bool seen() const { return x0 <= x1 && y0 <= y1; }
};

inline bool overlap(const Footprint& f, const Crop& area) {
  return f.x0 < area.x + area.width && f.x1 >= area.x && f.y0 < area.y + area.height && f.y1 >= area.y;
}

/// Where a solid is certainly hit, in pixels of the region: an ellipse (corners 0: x, y, half its width, half its height) or
/// a polygon (x, y by corner, around) that is smaller by `margin`.
struct Cover {
  int corners;
  double margin;
  double v[8];
};

/// What a small sphere certainly covers: a circle in 32nds of a pixel, radius below 8 pixels, and from which depth on. For
/// arithmetic in 16 bits.
struct SmallDisc {
  static constexpr int perPixel = 32, most = 254;  // radius
  std::uint64_t bits;
  std::uint16_t x() const { return static_cast<std::uint16_t>(bits); }  // in the region, modulo 2048 pixels
  std::uint16_t y() const { return static_cast<std::uint16_t>(bits >> 16); }
  std::uint16_t radius() const { return static_cast<std::uint16_t>(bits >> 32); }  // 0: there is none
  DepthCode hides() const { return static_cast<DepthCode>(bits >> 48); }
};

class Footprints {
 public:
  static constexpr std::size_t block = 64;
  static constexpr int tile = 4;  // pixels a side

  /// `type`: of the records, whose rounding what is covered must stand. `scale`: of the depths.
  Footprints(const Silhouette& silhouette, const Crop& region, const Frame<double>& eye, RealType type,
             DepthScale scale = DepthScale());

  /// Of at most `block` solids, a Stretch or a span of ShapeRef: seen(i, footprint) of the i-th, those of a kind in their order.
  /// That one hides something may be said of one that does not.
  void find(const auto& solids, auto&& seen) {
    findBatches(
        solids, false,
        [&](const auto& batch) {
          for (std::size_t i = 0; i < batch.count; ++i) seen(batch.at[i], of(batch, i, solids));
        },
        seen);
  }
  /// The same by kinds, for vectors: batch(batch), and seen(i, footprint) of what is in none. With `discs` of spheres, where
  /// asked for.
  void findBatches(const auto& solids, bool discs, auto&& batch, auto&& seen) {
    gather(solids);
    calculate(discs ? Finding::discs : Finding::seen);
    if (spheres_.count) batch(spheres_);
    if (triangles_.count) batch(triangles_);
    if (quads_.count) batch(quads_);
    if (boxes_.count) batch(boxes_);
    for (std::size_t i = 0; i < others_.count; ++i) seen(others_.at[i], ask(solids[others_.at[i]]));
  }
  Footprint of(const auto& batch, std::size_t i, const auto& solids) const {
    return batch.plain[i] ? footprint(batch, i) : ask(solids[batch.at[i]]);
  }
  /// covers(i, footprint, cover) of those that hide something.
  void findCovers(std::span<const ShapeRef> solids, auto&& covers) {
    gather(solids);
    calculate(Finding::covers);
    eachCover(spheres_, covers), eachCover(triangles_, covers), eachCover(quads_, covers);
  }
  /// Some sphere of all so far, seen or not, needs sphere.glsl's FAR_SPHERES.
  bool farSphere() const { return farSphere_; }

  /// The camera and the region, as the arithmetic takes them. Pixels are counted from the region's corner.
  struct View {
    double origin[3], axes[3][3];
    double perX, perY, lowX, lowY, highX, highY;  // pixel of a slope s: from s per + low, to s per + high
    double middleX, middleY;                      // at s per + middle
    double lastX, lastY;
    double inverseUnit;  // of length
    double margin;       // in pixels, within which the shader's rounding may move an edge
    double rough;  // in pixels, what fp32 may move a sphere's place by, above the errors that go with its distance
    double lost;   // of a sphere's q, relative to its terms: what the shader's rounding can take
    double flat;   // a flat solid seen at a smaller sine than this hides nothing
    DepthScale scale;
    double edges;  // the margin where rays go through the centres of pixels alone; more than all otherwise
  };
  /// Numbers of the block's solids of one kind, one array a number, and what is found of them.
  template <std::size_t NUMBERS, std::size_t COVER>
  struct Batch {
    alignas(64) double v[NUMBERS][block];
    alignas(64) std::uint32_t at[block];  // the solid's place in the block
    std::size_t count = 0;
    const char* next;    // of a Stretch: where the kind's next solids lie
    std::size_t stride;  // bytes of one
    int corners;         // of Cover
    alignas(64) std::int32_t x0[block], y0[block], x1[block], y1[block], nearest[block], hides[block];
    alignas(64) std::int32_t plain[block], misses[block]{};  // it serves; Footprint::misses
    alignas(64) double cover[COVER][block];
  };
  /// Into the caches, what comes a block later: solid by solid, while others are worked on; all at once they would wait for
  /// each other.
  static void fetchNext(const auto& batch, std::size_t i) { __builtin_prefetch(batch.next + i * batch.stride); }
  struct Spheres : Batch<4, 4> {
    alignas(64) std::uint64_t disc[block];  // SmallDisc's bits
    bool near;                              // some is too near for fp32
  };
  using Triangles = Batch<9, 6>;
  using Quads = Batch<12, 8>;
  using Boxes = Batch<24, 0>;

  enum class Finding { seen, discs, covers };

 private:
  /// The numbers of all batches, where slopes are enough (or else spheres alone); others_.
  void gather(std::span<const ShapeRef> solids);
  void gather(const Stretch& solids);
  /// What is found of the batches; where slopes are not enough the `plain` of spheres is false.
  void calculate(Finding what);
  Footprint ask(ShapeRef shape) const;
  static Footprint footprint(const auto& batch, std::size_t i) {
    return {batch.x0[i],
            batch.y0[i],
            batch.x1[i],
            batch.y1[i],
            static_cast<DepthCode>(batch.nearest[i]),
            static_cast<DepthCode>(batch.hides[i]),
            static_cast<std::uint8_t>(batch.misses[i])};
  }
  void eachCover(const auto& batch, auto& covers) {
    for (std::size_t i = 0; i < batch.count; ++i) {
      if (!batch.plain[i] || batch.hides[i] == DepthScale::none) continue;
      Cover cover{batch.corners, view_.margin, {}};
      for (std::size_t k = 0; k < std::size(batch.cover); ++k) cover.v[k] = batch.cover[k][i];
      covers(batch.at[i], footprint(batch, i), cover);
    }
  }

  const Silhouette& silhouette_;
  Crop region_;
  View view_;
  bool vectors_;
  bool farSphere_ = false;
  Spheres spheres_;
  Triangles triangles_;
  Quads quads_;
  Boxes boxes_;
  struct {
    std::uint32_t at[block];
    std::size_t count = 0;
  } others_;
};

}  // namespace solidcast
