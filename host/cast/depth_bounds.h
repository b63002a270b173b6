// What certainly hides what. By pixel a depth (along the camera's forward axis) before which the ray through the pixel's
// centre has hit something; a tile's solids that begin beyond the deepest of its pixels need not be listed. In a crowd
// nearly all solids go this way, before their records are made.
//
// Only what is certain counts: centres that lie inside a solid's projection by more than all rounding, that of `fast` in
// the shader included (Footprints::cover), and solids that are behind by more than a near tie. Hence no ray's answer, and
// no doubt of exact's about it, hangs on a solid that is left out. (fast can see a solid at so flat an angle that its own
// rounding puts it before what hides it; where it is left out, the picture is the right one.)
#pragma once
#include <cstddef>
#include <vector>

#include "host/cast/footprints.h"

namespace solidcast {

class DepthBounds {
 public:
  static constexpr int side = Footprints::tile;

  /// No pixel of the region hidden. Padding up to stride x rows, both multiples of `side`, bounds nothing; wide tiles are
  /// of `wide` x `wide` tiles.
  void start(const Crop& region, int stride, int rows, int wide);

  /// Whether it pays to add the solid seen there: not where its middle is hidden already, and no more large ones when many
  /// have been added.
  bool worthIt(const Footprint& f) const {
    return *middle(f) > f.hides && (double(f.x1 - f.x0 + 1) * (f.y1 - f.y0 + 1) < 4096 || work_ < most_);
  }
  void add(const Footprint& f, const Cover& cover);

  /// What all know of the rows from `first` up to, not including, `end`: to all of them.
  static void merge(const std::vector<DepthBounds*>& all, std::size_t first, std::size_t end);
  std::size_t rows() const { return rows_; }

  /// Takes down the deepest pixel of every tile, as things are now, for tiles(), wideTiles() and behindTiles().
  void noteTiles();
  bool noted() const { return !tiles_.empty(); }
  const DepthCode* tiles() const { return tiles_.data(); }
  const DepthCode* wideTiles() const { return wideTiles_.data(); }
  /// Whether nothing can be seen of the solid, by the tiles, where it is in few of them. In one: as the tile's limit says.
  bool behindTiles(const Footprint& f) const {
    const auto tile = [](std::int32_t pixel) { return static_cast<std::uint32_t>(pixel) / side; };
    const std::uint32_t x = tile(f.x0), y = tile(f.y0), most = (tile(f.x1) - x) | (tile(f.y1) - y);
    const DepthCode* deepest = levels_[most < 3 ? most : 3];
    return (most < 4) & (f.nearest > deepest[std::size_t{y} * across_ + x]);
  }
  /// Whether nothing of a small solid can be seen where `f` says: each of its pixels is known to be hit before. Of a larger
  /// one, tile by tile, that is sooner seen from the tiles.
  bool hides(const Footprint& f) const;

 private:
  const DepthCode* middle(const Footprint& f) const {
    return depth_.data() + static_cast<std::size_t>((f.y0 + f.y1) / 2) * stride_ + (f.x0 + f.x1) / 2;
  }

  std::size_t stride_ = 0, rows_ = 0, across_ = 0, wide_ = 1;
  std::int32_t width_ = 0, height_ = 0;  // of the region
  double work_ = 0, most_ = 0;           // pixels
  std::vector<DepthCode> depth_, tiles_, deepest2_, deepest4_, wideTiles_;
  std::array<const DepthCode*, 4> levels_{};  // by how many tiles, less one, a solid is in
};

}  // namespace solidcast
