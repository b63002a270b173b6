// Lists of solids per screen tile, for scenes too large to try every solid on every ray: primary rays arrive in tiles,
// so a solid need only be tried where its silhouette can be. Conservative: a tile that holds a pixel centre inside the
// solid's true projection always lists it.
#pragma once
#include <cstdint>
#include <vector>

#include "host/cast/records.h"
#include "host/image/band.h"
#include "host/scene/world.h"

namespace solidcast {

/// Part of the image in tiles of tileWidth x tileHeight pixels, from its upper left corner.
struct TileGrid {
  Crop region;  // in pixels of the whole image
  int tileWidth = 4, tileHeight = 4;
  int across() const { return (region.width + tileWidth - 1) / tileWidth; }
  int down() const { return (region.height + tileHeight - 1) / tileHeight; }
};

struct TileLists {
  std::vector<std::uint32_t> first;       // by tile, and one more: where its list starts in `solids`
  std::vector<std::uint32_t> solids;      // indices into World::solids, ascending in each tile
  std::vector<std::uint32_t> everywhere;  // unbounded or too large to be worth listing, ascending
};

/// `samples` per pixel and axis. Uses all cores.
TileLists tileLists(const Scene& scene, int width, int height, int samples, const TileGrid& grid);

}  // namespace solidcast
