#include "host/cast/list_part.h"

#include <algorithm>
#include <bit>
#include <optional>

#include "host/cast/list_packing.h"
#include "host/cast/list_routes.h"
#include "host/cast/wide.h"

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

std::uint64_t tilesOf(const Footprint& f, std::uint32_t side) {
  const auto of = [side](std::int32_t first, std::int32_t last) {
    return std::uint64_t{static_cast<std::uint32_t>(last) / side - static_cast<std::uint32_t>(first) / side + 1};
  };
  return of(f.x0, f.x1) * of(f.y0, f.y1);
}

/// A solid in many tiles is not copied to each where it fills the wide tiles it lies in: all their tiles walk it. Where it
/// does not, copies cost less, up to so many.
ListLevel levelOf(const Footprint& f, const ListGrid& grid) {
  constexpr std::uint64_t few = 256;
  const std::uint64_t own = tilesOf(f, ListGrid::tile);
  if (own <= few) return narrow;
  const auto across = static_cast<std::uint32_t>(grid.wide);
  const std::uint64_t walked = tilesOf(f, across * ListGrid::tile) * across * across;
  return own <= grid.most && 2 * walked > 3 * own ? narrow : wide;
}

std::uint32_t numberAt(const std::byte* at) {
  std::uint32_t number;
  std::memcpy(&number, at, sizeof number);
  return number;
}

// Of known size, a record is copied by a few vector moves: a sixth of all the time was memcpy's.
template <std::size_t ROW_SIZE, std::size_t ROWS>
void writeAs(std::span<const std::byte> from, std::byte* rows, std::uint32_t* next) {
  constexpr std::size_t record = ROW_SIZE * ROWS;
  for (const std::byte *at = from.data(), *end = at + from.size(); at != end;) {
    const std::byte* tile = at + sizeof(std::uint32_t);
    const std::byte* const solid = tile + numberAt(at) * sizeof(std::uint32_t);
    for (; tile != solid; tile += sizeof(std::uint32_t)) {
      std::uint32_t& to = next[numberAt(tile)];
      std::memcpy(rows + to * ROW_SIZE, solid, record);
      to += ROWS;
    }
    at = solid + record;
  }
}

template <std::size_t ROW_SIZE>
void writeRows(std::span<const std::byte> from, std::uint32_t rowCount, std::byte* rows, std::uint32_t* next) {
  if (rowCount == 2) writeAs<ROW_SIZE, 2>(from, rows, next);
  else if (rowCount == 3) writeAs<ROW_SIZE, 3>(from, rows, next);
  else if (rowCount == 4) writeAs<ROW_SIZE, 4>(from, rows, next);
  else writeAs<ROW_SIZE, 5>(from, rows, next);
}

}  // namespace

std::uint32_t rowsOf(std::size_t kind, bool eyeForms) { return rowsOfKind[kind][eyeForms]; }

void chooseWide(ListGrid& grid, const ListSample& sample, double left) {
  // ns of all threads: to copy a record to a tile, to walk it there; to sift a solid in a wide tile.
  constexpr double copying = 8, walking = 14, sifting = 60, recordBytes = 80, mostBytes = 128 << 20;
  const std::uint64_t tiles = std::uint64_t{1} * grid.across * grid.down;
  ListGrid best = grid;
  double least = 0;
  bool some = false;
  for (grid.wide = 16;; grid.wide *= 2) {
    const auto side = static_cast<std::uint64_t>(grid.wide);
    for (const std::uint64_t most : {std::uint64_t{256}, std::max<std::uint64_t>(256, tiles / 32)}) {
      grid.most = most;
      double copies = 0, walked = 0, sifted = 0;
      for (const auto& one : sample.all) {
        const std::uint64_t own = tilesOf(one.seen, ListGrid::tile);
        const std::uint64_t wides = tilesOf(one.seen, static_cast<std::uint32_t>(side * ListGrid::tile));
        const bool isWide = levelOf(one.seen, grid) == wide;
        copies += static_cast<double>(isWide ? wides : own);
        walked += static_cast<double>(isWide ? wides * side * side : own);
        sifted += static_cast<double>(wides);
      }
      const double ns = left * (copying * copies + walking * walked) + (left < 1 ? sifting * sifted : 0);
      const bool fits = left * copies * sample.each * recordBytes < mostBytes;
      if (fits ? !some || ns < least : !some) best = grid, least = ns, some = fits;
    }
    if (std::uint64_t{1} * grid.wideAcross() * grid.wideDown() <= 256) break;
  }
  grid = best;
}

void ListBuilder::Part::start(const ListGrid& grid) {
  grid_ = grid;
  grazing = farSphere = boxOnFace = false;
  listed.clear();
  seenIn.resize(DepthSlices::count * static_cast<std::size_t>(grid.wideAcross() * grid.wideDown()));
  for (auto& of : seenIn) of.clear();
  wides.clear();
  newWides = 0;
  for (auto& level : found)
    for (Arena& arena : level) arena.clear();
  for (auto& level : tiles)
    for (auto& counts : level) counts.clear();
}

namespace {

/// By blocks; find(block).
void forEachBlock(const Solids& solids, std::size_t from, std::size_t to, auto&& find) {
  for (std::size_t first = from; first < to; first += Footprints::block)
    find(Stretch{solids, static_cast<std::uint32_t>(first),
                 static_cast<std::uint32_t>(std::min(Footprints::block, to - first))});
}

}  // namespace

void ListBuilder::Part::lookForSieve(const Solids& solids, std::size_t from, std::size_t to, Footprints& footprints,
                                     const DepthSlices& slices, const TileLimits* limits, SmallDisc* discs) {
  const int shift = std::countr_zero(static_cast<std::uint32_t>(grid_.wide * ListGrid::tile));
  const std::int32_t across = grid_.wideAcross(), tiles = across * grid_.wideDown();
  const Bins where{shift, across, tiles, slices};
  std::vector<SeenWithin>* const bins = seenIn.data();
  Routes r;
  forEachBlock(solids, from, to, [&](const Stretch& block) {
    const auto anywhere = [&](std::size_t i, const Footprint& f) {
      if (!f.seen()) return;
      const std::uint32_t solid = block.first + static_cast<std::uint32_t>(i);
      if (levelOf(f, grid_) == wide) return wides.push_back({f, solid});
      std::vector<SeenWithin>* const slice = bins + slices.of(f.nearest) * static_cast<std::size_t>(tiles);
      for (std::int32_t y = f.y0 >> shift; y <= f.y1 >> shift; ++y)
        for (std::int32_t x = f.x0 >> shift; x <= f.x1 >> shift; ++x) {
          slice[y * across + x].push_back(within(f, solid, grid_.wideArea(x, y)));
        }
    };
    const auto batch = [&](const auto& b) {
      route(b, where, r);
      if constexpr (requires { b.disc; })
        for (std::size_t i = 0; i < b.count; ++i) discs[block.first - from + b.at[i]].bits = b.disc[i];
      for (std::size_t i = 0; i < b.count; ++i) {
        Footprints::fetchNext(b, i);
        const std::int32_t x0 = b.x0[i], y0 = b.y0[i], x1 = b.x1[i], y1 = b.y1[i];
        if (limits && b.plain[i] && x0 <= x1 && y0 <= y1 &&
            limits->behind(static_cast<std::uint32_t>(x0), static_cast<std::uint32_t>(y0),
                           static_cast<std::uint32_t>(x1), static_cast<std::uint32_t>(y1),
                           static_cast<DepthCode>(b.nearest[i])))
          continue;
        if (r.patch[i] == Routes::none) anywhere(b.at[i], footprints.of(b, i, block));
        else
          r.forEach(i, block.first + b.at[i], static_cast<std::size_t>(across),
                    [&](std::size_t at, const SeenWithin& s) { bins[at].push_back(s); });
      }
    };
    footprints.findBatches(block, true, batch, anywhere);
  });
  farSphere = footprints.farSphere();
}

void ListBuilder::Part::look(std::size_t from, std::size_t to, Footprints& footprints, const TileLimits& limits,
                             const Packs& packs) {
  ListPacking packing(*this, narrow, limits, packs);
  forEachBlock(packs.world.solids, from, to, [&](const Stretch& block) {
    const auto anywhere = [&](std::size_t i, const Footprint& f) {
      if (!f.seen()) return;
      const ListHead head{f, block.first + static_cast<std::uint32_t>(i)};
      if (levelOf(f, grid_) == wide) wides.push_back(head);
      else packing.add(head);
    };
    const auto batch = [&](const auto& b) {
      for (std::size_t i = 0; i < b.count; ++i) {
        Footprints::fetchNext(b, i);
        anywhere(b.at[i], footprints.of(b, i, block));
      }
    };
    footprints.findBatches(block, false, batch, anywhere);
  });
  packing.finish();
  // Of the whole scene, seen or not: so that fast has the same bits in every plan.
  farSphere = footprints.farSphere();
}

std::byte* ListBuilder::Part::add(std::size_t kind, std::size_t bytes, const ListHead& head, ListLevel level,
                                  const TileLimits& limits) {
  const auto side = static_cast<std::uint32_t>(level == wide ? grid_.wide * ListGrid::tile : ListGrid::tile);
  const std::uint32_t across = level == wide ? grid_.wideAcross() : grid_.across;
  const int shift = std::countr_zero(side);
  const Footprint& f = head.seen;
  const auto tile = [&](std::int32_t pixel) { return static_cast<std::uint32_t>(pixel) >> shift; };
  const std::uint32_t x0 = tile(f.x0), y0 = tile(f.y0), x1 = tile(f.x1), y1 = tile(f.y1);
  auto& counts = tiles[level][kind];
  if (counts.empty())
    counts.assign(level == wide ? std::size_t{1} * grid_.wideAcross() * grid_.wideDown()
                                : std::size_t{1} * grid_.across * grid_.down,
                  0);
  Arena& arena = found[level][kind];
  std::byte* const start = arena.room((1 + std::size_t{x1 - x0 + 1} * (y1 - y0 + 1)) * sizeof(std::uint32_t) + bytes);
  std::byte* to = start + sizeof(std::uint32_t);
  // No branches: a third of the tiles see nothing of what they lie beside.
  std::uint32_t in = 0;
  for (std::uint32_t y = y0; y <= y1; ++y) {
    const DepthCode* deepest = limits.row(y);
    for (std::uint32_t x = x0; x <= x1; ++x) {
      const std::uint32_t at = y * across + x, bit = ((y - y0) * 2 + (x - x0)) & 31;
      const std::uint32_t sees = ~(std::uint32_t{f.misses} >> bit) & (f.nearest <= deepest[x]) & 1;
      std::memcpy(to, &at, sizeof at);
      to += sees * sizeof at;
      counts[at] += sees, in += sees;
    }
  }
  std::memcpy(start, &in, sizeof in);
  if (in > 0) arena.take(static_cast<std::size_t>(to - start) + bytes), listed.push_back(head.solid);
  return to;
}

void ListBuilder::Part::write(std::byte* rows, std::size_t rowSize, bool eyeForms) {
  for (const ListLevel level : {narrow, wide})
    for (std::size_t kind = 0; kind < kindCount; ++kind) {
      const auto bytes = found[level][kind].bytes();
      if (bytes.empty()) continue;
      std::uint32_t* next = tiles[level][kind].data();
      if (rowSize == 16) writeRows<16>(bytes, rowsOf(kind, eyeForms), rows, next);
      else writeRows<32>(bytes, rowsOf(kind, eyeForms), rows, next);
    }
}

}  // namespace solidcast
