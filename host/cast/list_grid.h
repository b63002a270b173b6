// Lists of a picture: its tiles, and what they are written to.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "host/cast/depth_bounds.h"
#include "host/cast/records.h"
#include "host/image/band.h"

namespace solidcast {

/// Part of the image in tiles, and in wide tiles of `wide` x `wide` of them, for solids that would be in too many.
struct ListGrid {
  static constexpr int tile = Footprints::tile;
  Crop region;               // in pixels of the whole image
  int across = 0, down = 0;  // tiles; the planes' padding is covered as well
  // Chosen by collect():
  int wide = 16;
  std::uint64_t most = 256;  // a solid in more tiles is in wide ones alone
  int wideAcross() const { return (across + wide - 1) / wide; }
  int wideDown() const { return (down + wide - 1) / wide; }
  /// A wide tile's pixels, counted from the region's corner.
  Crop wideArea(int x, int y) const {
    const int side = wide * tile;
    return {x * side, y * side, std::min(side, across * tile - x * side), std::min(side, down * tile - y * side)};
  }
};

/// By lane of a dispatch, as lists.comp reads it.
struct ListLane {
  std::uint32_t x, y, unused[2];
};
struct ListSpan {
  std::uint32_t wideFirst, wideCount, first, count;  // rows; `count` is of both
};

/// The rows, and for the first `laneCount` of tiles() a ListLane and a ListSpan for each of `slots` (kinds in order).
struct ListRoom {
  std::span<std::byte> rows, lanes;
  std::size_t laneCount;
  std::array<bool, kindCount> slots;
};

}  // namespace solidcast
