// Lists of solids per screen tile, for scenes too large to try every solid on every ray: primary rays arrive in tiles,
// so a solid need only be tried where its silhouette can be. Conservative: a tile that holds a pixel centre inside the
// solid's true projection always lists it.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "host/cast/program.h"
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

/// What is searched in one tile: its records stand together in TiledRecords::bytes.
struct TileSearch {
  int x, y;  // from the region's corner, in pixels
  std::vector<SearchPortion> portions;
};
struct TiledRecords {
  std::vector<std::byte> bytes;
  std::vector<TileSearch> tiles;  // empty ones are there too: their pixels must be stored
};

/// Copies each tile's records together. Nothing where they would take more than `limit` bytes.
std::optional<TiledRecords> tiledRecords(const TileLists& lists, const TileGrid& grid, const Records& search,
                                         std::size_t limit);

/// `samples` per pixel and axis. Uses all cores.
TileLists tileLists(const Scene& scene, int width, int height, int samples, const TileGrid& grid);

}  // namespace solidcast
