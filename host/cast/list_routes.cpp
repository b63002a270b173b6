#include "host/cast/list_routes.h"

#include <array>

#include "host/cast/wide.h"

namespace solidcast {
namespace {

inline std::uint32_t coversOf(const auto& batch, std::size_t i) {
  return batch.hides[i] != DepthScale::none ? SeenWithin::shape : 0;
}
inline std::uint32_t coversOf(const Footprints::Spheres& batch, std::size_t i) {
  const std::uint32_t by = SmallDisc{batch.disc[i]}.radius() != 0 ? SeenWithin::disc : SeenWithin::shape;
  return batch.hides[i] != DepthScale::none ? by : 0;
}

template <class Batch>
inline __attribute__((always_inline)) void routesOf(const Batch& b, const Bins& bins, Routes& r) {
  const int shift = bins.shift;
  const std::int32_t across = bins.across, tiles = bins.tiles;
  std::array<std::int32_t, DepthSlices::count> from{};
  for (std::size_t k = 1; k < from.size(); ++k) from[k] = bins.slices.from[k];
  const std::int32_t inside = (1 << shift) - 1;
  for (std::size_t i = 0, count = b.count; i < count; ++i) {
    const std::int32_t x0 = b.x0[i], y0 = b.y0[i], x1 = b.x1[i], y1 = b.y1[i];
    const std::int32_t px = x0 >> shift, py = y0 >> shift, moreX = (x1 >> shift) - px, moreY = (y1 >> shift) - py;
    // In no more than 16x16 tiles, which are not too many to be listed there.
    const bool few = ((moreX | moreY) <= 1) & (((x1 - x0) | (y1 - y0)) < 60);
    const bool simple = few & (x0 <= x1) & (y0 <= y1) & (b.plain[i] != 0);
    r.first[i] = static_cast<std::uint32_t>((y0 & inside) << 16 | (x0 & inside));
    const std::int32_t lastX = moreX ? inside : x1 & inside, lastY = moreY ? inside : y1 & inside;
    r.last[i] = static_cast<std::uint32_t>(lastY << 16 | lastX);
    r.end[i] = static_cast<std::uint32_t>((y1 & inside) << 16 | (x1 & inside));
    r.more[i] = coversOf(b, i) | static_cast<std::uint32_t>(b.misses[i] << 16 | b.nearest[i]);
    std::int32_t bin = py * across + px;
#pragma GCC unroll 8
    for (std::size_t k = 1; k < from.size(); ++k) bin += b.nearest[i] >= from[k] ? tiles : 0;
    r.patch[i] = simple ? bin : Routes::none;
    r.beyond[i] = static_cast<std::uint32_t>(moreX | moreY << 1);
  }
}

}  // namespace

WIDE void route(const Footprints::Spheres& batch, const Bins& bins, Routes& routes) { routesOf(batch, bins, routes); }
WIDE void route(const Footprints::Triangles& batch, const Bins& bins, Routes& routes) { routesOf(batch, bins, routes); }
WIDE void route(const Footprints::Quads& batch, const Bins& bins, Routes& routes) { routesOf(batch, bins, routes); }
WIDE void route(const Footprints::Boxes& batch, const Bins& bins, Routes& routes) { routesOf(batch, bins, routes); }

}  // namespace solidcast
