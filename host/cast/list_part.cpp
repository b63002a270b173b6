#include "host/cast/list_part.h"

#include <algorithm>
#include <bit>

#include "host/cast/list_routes.h"

namespace solidcast {
namespace {

std::uint64_t tilesOf(const Footprint& f, std::uint32_t side) {
  const auto of = [side](std::int32_t first, std::int32_t last) {
    return std::uint64_t{static_cast<std::uint32_t>(last) / side - static_cast<std::uint32_t>(first) / side + 1};
  };
  return of(f.x0, f.x1) * of(f.y0, f.y1);
}

/// A solid in many tiles is not copied to each where it fills the wide tiles it lies in: all their tiles walk it. Where it
/// does not, copies cost less, up to so many.
bool isWide(const Footprint& f, const ListGrid& grid) {
  constexpr std::uint64_t few = 256;
  const std::uint64_t own = tilesOf(f, ListGrid::tile);
  if (own <= few) return false;
  const auto across = static_cast<std::uint32_t>(grid.wide);
  const std::uint64_t walked = tilesOf(f, across * ListGrid::tile) * across * across;
  return own > grid.most || 2 * walked <= 3 * own;
}

}  // namespace

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
        const bool apart = isWide(one.seen, grid);
        copies += static_cast<double>(apart ? wides : own);
        walked += static_cast<double>(apart ? wides * side * side : own);
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

void ListPart::start(const ListGrid& grid) {
  grid_ = grid;
  flags = {}, farSphere = false;
  listed.clear(), wides.clear(), records.clear();
  seenIn.resize(DepthSlices::count * static_cast<std::size_t>(grid.wideAcross() * grid.wideDown()));
  for (auto& of : seenIn) of.clear();
  newWides = 0;
}

namespace {

/// By blocks; find(block).
void forEachBlock(const Solids& solids, std::size_t from, std::size_t to, auto&& find) {
  for (std::size_t first = from; first < to; first += Footprints::block)
    find(Stretch{solids, static_cast<std::uint32_t>(first),
                 static_cast<std::uint32_t>(std::min(Footprints::block, to - first))});
}

}  // namespace

void ListPart::lookForSieve(const Solids& solids, std::size_t from, std::size_t to, Footprints& footprints,
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
      if (isWide(f, grid_)) return wides.push_back({f, solid});
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

void ListPart::look(std::size_t from, std::size_t to, Footprints& footprints, const ListPacks& packs,
                    ListLayout::Share& share) {
  auto packing = packingOf<ListHead>(packs, flags, [&](std::size_t kind, std::size_t bytes, const ListHead& head) {
    return record(head.solid, bytes, [&](const std::byte* at) { return share.addAnywhere(kind, at, head.seen); });
  });
  forEachBlock(packs.world.solids, from, to, [&](const Stretch& block) {
    // Inlined, so that a footprint is put together where it is kept: to copy one waits for its own small stores.
    const auto anywhere = [&](std::size_t i, const Footprint& f) __attribute__((always_inline)) {
      if (!f.seen()) return;
      const ListHead head{f, block.first + static_cast<std::uint32_t>(i)};
      if (isWide(f, grid_)) wides.push_back(head);
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

}  // namespace solidcast
