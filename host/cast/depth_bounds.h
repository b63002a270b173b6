// What certainly hides what. By pixel a depth (along the camera's forward axis) before which the ray through the pixel's
// centre has hit something; a tile's solids that begin beyond the deepest of its pixels need not be listed. In a crowd
// nearly all solids go this way, before their records are made.
//
// Only what is certain counts: centres that lie inside a solid's projection by more than all rounding, that of `fast` in
// the shader included, and solids that are behind by more than a near tie. Hence no ray's answer, and no doubt of
// exact's about it, hangs on a solid that is left out. (fast can see a solid at so flat an angle that its own rounding
// puts it before what hides it; where it is left out, the picture is the right one.)
#pragma once
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "host/cast/footprints.h"

namespace solidcast {

class DepthBounds {
 public:
  static constexpr int side = 4;

  /// Pixels of the region, and padding up to stride x rows, which bounds nothing. `layered`: many solids lie one behind
  /// the other.
  void start(const Silhouette& silhouette, const Crop& region, int stride, int rows, RealType type, bool layered);
  /// Depths of a row as they are now.
  float* row(std::size_t y) { return depth_.data() + y * stride_; }
  const float* row(std::size_t y) const { return depth_.data() + y * stride_; }

  /// The depth in the middle of where a solid is seen; to be fetched ahead.
  const float* middle(const Footprint& f) const {
    return row(static_cast<std::size_t>((f.y0 + f.y1) / 2)) + (f.x0 + f.x1) / 2;
  }
  /// Whether to add the solid seen there: not where its middle is hidden already, and no more large ones when many have
  /// been added. Small polygons, which cover hardly a tile, only where the scene has many layers.
  bool worthIt(const Footprint& f, bool polygon) const {
    const int width = f.x1 - f.x0 + 1, height = f.y1 - f.y0 + 1;
    if (polygon && !layered_ && (width < 8 || height < 8)) return false;
    return *middle(f) > f.hides && (double(width) * height < 4096 || work_ < most_);
  }
  /// Takes down the deepest pixel of every 2x2 and 4x4 tiles, as things are now, for behindTiles(). Done now and then it
  /// costs little, and most solids are found to be hidden without a look at their pixels.
  void noteTiles();
  bool behindTiles(const Footprint& f) const {
    if (deepest2_.empty()) return false;
    const int x = f.x0 / side, y = f.y0 / side, across = f.x1 / side - x, down = f.y1 / side - y;
    const std::vector<float>& deepest = (across < 2) & (down < 2) ? deepest2_ : deepest4_;
    return (across < 4) & (down < 4) &
           (f.nearest > deepest[static_cast<std::size_t>(y) * (stride_ / side) + static_cast<std::size_t>(x)]);
  }
  /// Whether nothing of a small solid can be seen where `f` says: each of its pixels is known to be hit before. Of a larger
  /// one, tile by tile, that is sooner seen from the tiles' limits.
  bool hides(const Footprint& f) const;

  static constexpr bool knows(const Shape& shape) {
    return std::holds_alternative<Sphere>(shape) || std::holds_alternative<Triangle>(shape) ||
           std::holds_alternative<Quad>(shape);
  }
  template <class Solid>
  void add(const Solid&) {}
  void add(const Sphere& sphere);
  void add(const Triangle& triangle);
  void add(const Quad& quad);

 private:
  struct Corner {
    double x, y, depth;  // in pixels of the region; along the forward axis
  };
  bool corner(const Triple& fromEye, Corner& to) const;
  template <std::size_t CORNERS>
  void polygon(const std::array<Corner, CORNERS>& corners, const Triple& normal, const Triple& point);
  void fill(double top, double bottom, int widest, float depth, const auto& span);

  const Silhouette* silhouette_ = nullptr;
  Crop region_;
  std::size_t stride_ = 0;
  double margin_ = 0;           // in pixels
  double steepest_ = 0;         // length of the longest of the directions (x, y, 1)
  double lost_ = 0;             // of a sphere's q, relative to its terms: what the shader's rounding can take
  double rounding_ = 0;         // of a flat solid's s, relative to s over the sine of the angle it is seen at
  double work_ = 0, most_ = 0;  // pixels
  bool layered_ = false;
  std::vector<float> depth_, deepest2_, deepest4_;
};

}  // namespace solidcast
