// What certainly hides what. By pixel a depth (along the camera's forward axis) before which the ray through the pixel's
// centre has hit something; a tile's solids that begin beyond the deepest of its pixels need not be listed. In a crowd
// nearly all solids go this way, before their records are made.
//
// Only what is certain counts: centres that lie inside a solid's projection by more than all rounding, that of `fast` in
// the shader included (Footprints::cover), and solids that are behind by more than a near tie. Hence no ray's answer, and
// no doubt of exact's about it, hangs on a solid that is left out. (fast can see a solid at so flat an angle that its own
// rounding puts it before what hides it; where it is left out, the picture is the right one.)
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "host/cast/footprints.h"
#include "host/cast/pile.h"

namespace solidcast {

/// Of every tile the depth beyond which nothing is seen of it.
class TileLimits {
 public:
  static constexpr int side = Footprints::tile;

  /// Nothing hidden.
  void start(std::size_t across, std::size_t down);
  std::size_t size() const { return across_ * down_; }
  DepthCode* row(std::size_t y) { return byTile_.data() + y * across_; }
  const DepthCode* row(std::size_t y) const { return byTile_.data() + y * across_; }
  /// Whether something that begins at `nearest` can be seen in some of the tiles, first and last.
  bool some(std::uint32_t x0, std::uint32_t y0, std::uint32_t x1, std::uint32_t y1, DepthCode nearest) const {
    for (std::size_t y = y0; y <= y1; ++y)
      for (std::size_t x = x0; x <= x1; ++x)
        if (row(y)[x] >= nearest) return true;
    return false;
  }
  /// To be called when rows have changed, for behind().
  void widen();
  /// Whether nothing can be seen of a solid that begins at `nearest` and lies in few tiles; pixels, first and last. In one
  /// tile: as the tile's limit says.
  bool behind(std::uint32_t x0, std::uint32_t y0, std::uint32_t x1, std::uint32_t y1, DepthCode nearest) const {
    const std::uint32_t x = x0 / side, y = y0 / side, most = (x1 / side - x) | (y1 / side - y);
    const DepthCode* deepest = levels_[most < 3 ? most : 3];
    return (most < 4) & (nearest > deepest[std::size_t{y} * across_ + x]);
  }

 private:
  std::size_t across_ = 0, down_ = 0;
  std::vector<DepthCode> byTile_, deepest2_, deepest3_, deepest4_;  // of 1, 2x2, ... tiles from each on
  std::array<const DepthCode*, 4> levels_{};                        // by how many tiles, less one, a solid is in
};

/// What is seen of a solid within a rectangle of whole tiles, pixels counted from that one's corner. In words, for vectors.
struct SeenWithin {
  std::uint32_t first, last;  // pixels: y << 16 | x
  std::uint32_t more;         // shape or disc | misses << 16 | nearest
  std::uint32_t solid;
  int x0() const { return static_cast<int>(first & 0xffff); }
  int y0() const { return static_cast<int>(first >> 16); }
  int x1() const { return static_cast<int>(last & 0xffff); }
  int y1() const { return static_cast<int>(last >> 16); }
  DepthCode nearest() const { return static_cast<DepthCode>(more); }
  std::uint8_t misses() const { return static_cast<std::uint8_t>(more >> 16); }
  static constexpr std::uint32_t shape = 1 << 24, disc = 1 << 25;  // it may hide something: as Cover, as SmallDisc says
  bool covers() const { return more >> 24; }
  bool isDisc() const { return more & disc; }
};
SeenWithin within(const Footprint& f, std::uint32_t solid, const Crop& area);

/// Of solids from `first` on.
struct SmallDiscs {
  const SmallDisc* of;
  std::size_t first;
};

/// Of a rectangle of a region's pixels, whole tiles.
class DepthBounds {
 public:
  static constexpr int side = Footprints::tile;

  /// No pixel hidden. Those beyond the region's `width` x `height` bound nothing.
  void start(const Crop& area, int width, int height);
  const Crop& area() const { return area_; }

  /// `seen` within the area hides what begins beyond `hides` where `cover` says, in pixels of the region.
  void add(const SeenWithin& seen, DepthCode hides, const Cover& cover);

  /// The same of small discs, those of `solids` at `places`.
  void add(std::span<const SeenWithin> solids, std::span<const std::uint32_t> places, const SmallDiscs& discs);

  /// Takes down the deepest pixel of every tile, as things are now, for all below.
  void noteTiles();
  const TileLimits& tiles() const { return tiles_; }
  DepthCode deepest() const { return deepest_; }

  /// Of `solids` in that order the places of those that can be seen, as far as is known: one that is in few tiles by these
  /// and by its pixels, a larger one tile by tile. Ends when the places are full or so many of those seen may cover
  /// something, or up to 63 more; `looked`: how far it came.
  std::size_t visible(std::span<const SeenWithin> solids, std::span<const std::uint32_t> order,
                      std::size_t mostCovering, std::span<std::uint32_t> places, std::size_t& looked) const;
  /// To the end of `to` those that do not lie behind the tiles' limits.
  void addNotBehind(std::span<const SeenWithin> solids, Pile<SeenWithin>& to) const;
  bool hides(const SeenWithin& seen) const {
    std::uint32_t place = 0;
    std::size_t looked = 0;
    return visible({&seen, 1}, {&place, 1}, 1, {&place, 1}, looked) == 0;
  }

 private:
  Crop area_{};
  std::ptrdiff_t stride_ = 0;
  std::vector<DepthCode> depth_;
  TileLimits tiles_;
  DepthCode deepest_ = DepthScale::none;
};

}  // namespace solidcast
