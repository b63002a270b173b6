#include "host/cast/list_part.h"

#include <algorithm>

namespace solidcast {
namespace {

constexpr std::uint32_t rowsOfKind[kindCount][2] = {
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) {WORLD_ROWS, EYE_ROWS},
#include "shaders/solids.def"
#undef SOLID
};
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  static_assert(EYE_ROWS >= 2 && EYE_ROWS <= 5 && WORLD_ROWS >= 2 && WORLD_ROWS <= 5, "writeRows knows these");
#include "shaders/solids.def"
#undef SOLID

/// Solids in more tiles than this go to the wide ones.
constexpr int mostTiles = 256;

using Place = ListBuilder::Part::Place;

void fetch(const SolidEntry& solid) {
  const auto* at = reinterpret_cast<const char*>(&solid.shape);
  for (std::size_t line = 0; line < sizeof solid.shape; line += 64) __builtin_prefetch(at + line);
}

ListLevel levelOf(const Footprint& f) {
  constexpr int side = ListGrid::tile;
  return std::int64_t{f.x1 / side - f.x0 / side + 1} * (f.y1 / side - f.y0 / side + 1) > mostTiles ? wide : narrow;
}

Place placeOf(const Footprint& f, const ListLimits& limits) {
  const auto tile = [&](std::int32_t pixel) {
    return limits.side == ListGrid::tile ? unsigned(pixel) / ListGrid::tile : unsigned(pixel) / unsigned(limits.side);
  };
  return {tile(f.x0), tile(f.y0), tile(f.x1), tile(f.y1), f.nearest, 0};
}

template <class F>
void eachTile(const Place& place, const ListLimits& limits, const F& f) {
  for (std::size_t y = place.y0; y <= place.y1; ++y)
    for (std::size_t tile = y * limits.across + place.x0; tile <= y * limits.across + place.x1; ++tile)
      if (!limits.byTile || place.nearest <= limits.byTile[tile]) f(tile);
}

bool reaches(const Footprint& f, const ListLimits& limits) {
  const Place place = placeOf(f, limits);
  for (std::size_t y = place.y0; y <= place.y1; ++y)
    for (std::size_t x = place.x0; x <= place.x1; ++x)
      if (place.nearest <= limits.byTile[y * limits.across + x]) return true;
  return false;
}

// Of known size, a record is copied by a few vector moves: a sixth of all the time was memcpy's.
template <std::size_t ROW_SIZE, std::size_t ROWS>
void writeAs(std::span<const std::byte> from, std::byte* rows, std::uint32_t* next, const ListLimits& limits) {
  constexpr std::size_t record = ROW_SIZE * ROWS;
  for (const std::byte* at = from.data(); at != from.data() + from.size(); at += sizeof(Place) + record) {
    Place place;
    std::memcpy(&place, at, sizeof place);
    eachTile(place, limits, [&](std::size_t tile) {
      std::memcpy(rows + next[tile] * ROW_SIZE, at + sizeof place, record);
      next[tile] += ROWS;
    });
  }
}

template <std::size_t ROW_SIZE>
void writeRows(std::span<const std::byte> from, std::uint32_t rowCount, std::byte* rows, std::uint32_t* next,
               const ListLimits& limits) {
  if (rowCount == 2) writeAs<ROW_SIZE, 2>(from, rows, next, limits);
  else if (rowCount == 3) writeAs<ROW_SIZE, 3>(from, rows, next, limits);
  else if (rowCount == 4) writeAs<ROW_SIZE, 4>(from, rows, next, limits);
  else writeAs<ROW_SIZE, 5>(from, rows, next, limits);
}

}  // namespace

std::uint32_t rowsOf(std::size_t kind, bool eyeForms) { return rowsOfKind[kind][eyeForms]; }

void ListBuilder::Part::start() {
  grazing = farSphere = boxOnFace = false;
  seen = 0;
  for (auto& of : heads) of.clear();
  for (auto& level : found)
    for (Arena& arena : level) arena.clear();
  for (auto& level : tiles)
    for (auto& counts : level) counts.clear();
}

void ListBuilder::Part::look(const World& world, std::size_t from, std::size_t to, const Silhouette& silhouette,
                             const EyeFrames& eye, const ListGrid& grid, bool hiding) {
  Footprints footprints(silhouette, grid.region, eye.plain);
  const std::span<const SolidEntry> solids(world.solids);
  // After as many solids as there are tiles, then after twice as many, and so on.
  std::size_t nextNote = from + static_cast<std::size_t>(grid.across) * static_cast<std::size_t>(grid.down);
  for (std::size_t first = from; first < to; first += Footprints::block) {
    const std::size_t count = std::min(Footprints::block, to - first);
    footprints.find(solids.subspan(first, count));
    std::array<bool, Footprints::block> seen;
    if (hiding && first >= nextNote) {
      depths.noteTiles();
      nextNote = from + 2 * (first - from);
    }
    for (std::size_t i = 0; i < count; ++i) {
      seen[i] = footprints[i].seen() && !(hiding && depths.behindTiles(footprints[i]));
      if (hiding && seen[i]) __builtin_prefetch(depths.middle(footprints[i]), 1);
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!seen[i]) continue;
      const Footprint& f = footprints[i];
      const ListLevel level = levelOf(f);
      if (hiding) {
        if (level == narrow && depths.hides(f)) continue;
        const Shape& shape = solids[first + i].shape;
        if (depths.worthIt(f, !std::holds_alternative<Sphere>(shape)))
          std::visit([&](const auto& solid) { depths.add(solid); }, shape);
      }
      heads[level].push_back({static_cast<std::uint32_t>(first + i), f});
    }
  }
  // Of the whole scene, seen or not: so that fast has the same bits in every plan.
  farSphere = footprints.farSphere();
}

void ListBuilder::Part::pack(const World& world, RealType type, bool eyeForms, const EyeFrames& eye,
                             const ListGrid& grid, const Limits& limits, const DepthBounds* hidden) {
  // Those that are left lie far apart in memory: they are fetched a few ahead.
  constexpr std::size_t ahead = 8;
  const std::size_t rowSize = rowBytes(type);
  for (const ListLevel level : {wide, narrow}) {
    const std::vector<Head>& all = heads[level];
    reached_.clear();
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!hidden || (reaches(all[i].seen, limits[level]) && !(level == narrow && hidden->hides(all[i].seen))))
        reached_.push_back(static_cast<std::uint32_t>(i));
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      const Head& head = all[reached_[i]];
      if (i + ahead < reached_.size()) fetch(world.solids[all[reached_[i + ahead]].solid]);
      std::visit(
          [&](const auto& solid) {
            if (!eyeForms) {
              RowWriter rows(type);
              packWorld(solid, eye.exact.origin, head.solid, rows);
              const auto kind = static_cast<std::size_t>(kindNumber(solid));
              std::ranges::copy(rows.bytes(), add(kind, rows.bytes().size(), head, level, grid, limits[level]));
              return;
            }
            packed(solid, eye, head.solid, type, [&](const auto& record) {
              if (record.kind < 0) return;
              grazing = grazing || record.grazing;
              std::byte* to = add(static_cast<std::size_t>(record.kind),
                                  rowSize * static_cast<std::size_t>(record.rows), head, level, grid, limits[level]);
              for (int r = 0; r < record.rows; ++r, to += rowSize) writeRow(to, type, record.row[r]);
            });
            if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, AABox>)
              boxOnFace = boxOnFace || eyeOnFacePlane(solid, eye.extended);
          },
          world.solids[head.solid].shape);
    }
  }
}

std::byte* ListBuilder::Part::add(std::size_t kind, std::size_t bytes, const Head& head, ListLevel level,
                                  const ListGrid& grid, const ListLimits& limits) {
  ++seen;
  const Place place = placeOf(head.seen, limits);
  std::byte* to = found[level][kind].add(sizeof place + bytes);
  std::memcpy(to, &place, sizeof place);
  auto& counts = tiles[level][kind];
  if (counts.empty())
    counts.assign(
        level == wide ? std::size_t{1} * grid.wideAcross() * grid.wideDown() : std::size_t{1} * grid.across * grid.down,
        0);
  eachTile(place, limits, [&](std::size_t tile) { ++counts[tile]; });
  return to + sizeof place;
}

void ListBuilder::Part::write(std::byte* rows, std::size_t rowSize, bool eyeForms, const Limits& limits) {
  for (const ListLevel level : {narrow, wide})
    for (std::size_t kind = 0; kind < kindCount; ++kind) {
      const auto bytes = found[level][kind].bytes();
      if (bytes.empty()) continue;
      std::uint32_t* next = tiles[level][kind].data();
      if (rowSize == 16) writeRows<16>(bytes, rowsOf(kind, eyeForms), rows, next, limits[level]);
      else writeRows<32>(bytes, rowsOf(kind, eyeForms), rows, next, limits[level]);
    }
}

}  // namespace solidcast
