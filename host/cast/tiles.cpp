#include "host/cast/tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "host/cast/second_pass.h"
#include "host/cast/silhouette.h"

namespace solidcast {
namespace {

/// Tiles of a grid that a rectangle touches; empty where to < from.
struct Tiles {
  std::int32_t fromX = 0, toX = -1, fromY = 0, toY = -1;
  bool everywhere = false;
};

Tiles touched(const Rectangle& r, const TileGrid& grid) {
  if (r.everywhere) return {0, -1, 0, -1, true};
  if (r.x.empty() || r.y.empty()) return {};
  auto tile = [](double pixel, int first, int size, int tiles) {
    double t = std::floor((pixel - first) / size);
    return static_cast<std::int32_t>(std::clamp(t, -1.0, static_cast<double>(tiles)));
  };
  // Pixel i is seen at i + 0.5: an interval [a, b] holds centres from ceil(a - 0.5) to floor(b - 0.5).
  Tiles t;
  double x0 = std::ceil(r.x.from - 0.5), x1 = std::floor(r.x.to - 0.5);
  double y0 = std::ceil(r.y.from - 0.5), y1 = std::floor(r.y.to - 0.5);
  if (x1 < x0 || y1 < y0) return {};  // between the centres
  t.fromX = std::max(0, tile(x0, grid.region.x, grid.tileWidth, grid.across()));
  t.toX = std::min(grid.across() - 1, tile(x1, grid.region.x, grid.tileWidth, grid.across()));
  t.fromY = std::max(0, tile(y0, grid.region.y, grid.tileHeight, grid.down()));
  t.toY = std::min(grid.down() - 1, tile(y1, grid.region.y, grid.tileHeight, grid.down()));
  if (t.toX < t.fromX || t.toY < t.fromY) return {};
  std::int64_t all = std::int64_t{grid.across()} * grid.down();
  std::int64_t covered = std::int64_t{t.toX - t.fromX + 1} * (t.toY - t.fromY + 1);
  t.everywhere = covered > 64 && covered * 4 > all;
  return t;
}

}  // namespace

TileLists tileLists(const Scene& scene, int width, int height, int samples, const TileGrid& grid) {
  const Silhouette silhouette(scene, width, height, samples);
  const auto& solids = scene.world.solids;
  std::vector<Tiles> tiles(solids.size());
  inParallel(solids.size(), [&](std::size_t i) {
    Rectangle r = solids.shape(i).visit([&](const auto& s) { return silhouette.rectangle(s); });
    tiles[i] = touched(r, grid);
  });

  TileLists lists;
  std::size_t across = static_cast<std::size_t>(grid.across()), count = across * static_cast<std::size_t>(grid.down());
  lists.first.assign(count + 1, 0);
  auto forEachTile = [&](const Tiles& t, const auto& f) {
    for (std::int32_t y = t.fromY; y <= t.toY; ++y)
      for (std::int32_t x = t.fromX; x <= t.toX; ++x)
        f(static_cast<std::size_t>(y) * across + static_cast<std::size_t>(x));
  };
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (tiles[i].everywhere) {
      lists.everywhere.push_back(static_cast<std::uint32_t>(i));
    } else {
      forEachTile(tiles[i], [&](std::size_t tile) { ++lists.first[tile + 1]; });
    }
  }
  for (std::size_t tile = 0; tile < count; ++tile) lists.first[tile + 1] += lists.first[tile];
  lists.solids.resize(lists.first[count]);
  std::vector<std::uint32_t> next(lists.first.begin(), lists.first.end() - 1);
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (!tiles[i].everywhere)
      forEachTile(tiles[i], [&](std::size_t tile) { lists.solids[next[tile]++] = static_cast<std::uint32_t>(i); });
  return lists;
}

std::optional<TiledRecords> tiledRecords(const TileLists& lists, const TileGrid& grid, const Records& search,
                                         std::size_t limit) {
  std::size_t rows = 0, entries = 0;
  for (std::size_t k = 0; k < kindCount; ++k) rows += std::size_t{search.count[k]} * search.rowsPer[k];
  if (rows == 0) return std::nullopt;
  const std::size_t rowBytes = search.bytes.size() / rows, tiles = lists.first.size() - 1;
  auto bytesOf = [&](std::uint32_t solid) {
    std::uint32_t kind = search.places[solid][0];
    return kind < kindCount ? search.rowsPer[kind] * rowBytes : 0;
  };
  for (std::uint32_t solid : lists.solids) entries += bytesOf(solid);
  for (std::uint32_t solid : lists.everywhere) entries += bytesOf(solid) * tiles;
  if (entries > limit) return std::nullopt;

  TiledRecords tiled;
  tiled.bytes.reserve(entries);
  std::array<std::vector<std::uint32_t>, kindCount> byKind;  // first rows of a tile's solids
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    for (auto& list : byKind) list.clear();
    auto add = [&](std::uint32_t solid) {
      auto [kind, row] = search.places[solid];
      if (kind < kindCount) byKind[kind].push_back(row);
    };
    for (std::uint32_t solid : lists.everywhere) add(solid);
    for (std::size_t i = lists.first[tile]; i < lists.first[tile + 1]; ++i) add(lists.solids[i]);
    Records here;
    here.rowsPer = search.rowsPer;
    for (std::size_t k = 0; k < kindCount; ++k) {
      here.count[k] = static_cast<std::uint32_t>(byKind[k].size());
      here.firstRow[k] = static_cast<std::uint32_t>(tiled.bytes.size() / rowBytes);
      for (std::uint32_t row : byKind[k]) {
        auto from = search.bytes.begin() + static_cast<std::ptrdiff_t>(row * rowBytes);
        tiled.bytes.insert(tiled.bytes.end(), from, from + static_cast<std::ptrdiff_t>(search.rowsPer[k] * rowBytes));
      }
    }
    auto across = static_cast<std::size_t>(grid.across());
    tiled.tiles.push_back({static_cast<int>(tile % across) * grid.tileWidth,
                           static_cast<int>(tile / across) * grid.tileHeight, portions(here)});
  }
  return tiled;
}

}  // namespace solidcast
