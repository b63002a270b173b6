// Which wide tiles' bins a batch's solids go to, and what is seen of them there, by vectors.
#pragma once
#include "host/cast/list_sieve.h"

namespace solidcast {

/// Bins of wide tiles of 2^shift pixels a side, `across` in a row; `tiles` of them for each slice of depths.
struct Bins {
  int shift;
  std::int32_t across, tiles;
  DepthSlices slices;
};

struct Routes {
  static constexpr std::int32_t none = -1;
  static constexpr std::uint32_t right = 1, below = 2;

  // The first wide tile's bin; `none`: in more than 2x2, or not plain, or not seen. And whether it is in the next one as well.
  alignas(64) std::int32_t patch[Footprints::block];
  alignas(64) std::uint32_t beyond[Footprints::block];
  // Of SeenWithin: in the first wide tile; and the last pixel in the last wide tile.
  alignas(64) std::uint32_t first[Footprints::block], last[Footprints::block], more[Footprints::block],
      end[Footprints::block];

  /// to(patch, what is seen there) of the i-th in its wide tiles, of which `across` are in a row.
  void forEach(std::size_t i, std::uint32_t solid, std::size_t across, auto&& to) const {
    constexpr std::uint32_t x = 0xffff, y = ~x;
    const auto at = static_cast<std::size_t>(patch[i]);
    to(at, SeenWithin{first[i], last[i], more[i], solid});
    if (beyond[i] == 0) return;
    // Of the 2x2 tiles that `misses` is about, what is left of them where the wide tile begins after the first.
    constexpr std::uint32_t misses = 0xff0000;
    const auto without = [&](int tiles) { return (more[i] & ~misses) | ((more[i] & misses) >> tiles & misses); };
    if (beyond[i] & right) to(at + 1, SeenWithin{first[i] & y, (last[i] & y) | (end[i] & x), without(1), solid});
    if (!(beyond[i] & below)) return;
    to(at + across, SeenWithin{first[i] & x, (end[i] & y) | (last[i] & x), without(2), solid});
    if (beyond[i] & right) to(at + across + 1, SeenWithin{0, end[i], without(3), solid});
  }
};

void route(const Footprints::Spheres& batch, const Bins& bins, Routes& routes);
void route(const Footprints::Triangles& batch, const Bins& bins, Routes& routes);
void route(const Footprints::Quads& batch, const Bins& bins, Routes& routes);
void route(const Footprints::Boxes& batch, const Bins& bins, Routes& routes);

}  // namespace solidcast
