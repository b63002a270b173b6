#include "host/cast/list_routes.h"

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
inline __attribute__((always_inline)) void routesOf(const Batch& b, int shift, std::int32_t across, Routes& r) {
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
    r.patch[i] = simple ? py * across + px : Routes::none;
    r.beyond[i] = static_cast<std::uint32_t>(moreX | moreY << 1);
  }
}

}  // namespace

WIDE void route(const Footprints::Spheres& batch, int shift, std::int32_t across, Routes& routes) {
  routesOf(batch, shift, across, routes);
}
WIDE void route(const Footprints::Triangles& batch, int shift, std::int32_t across, Routes& routes) {
  routesOf(batch, shift, across, routes);
}
WIDE void route(const Footprints::Quads& batch, int shift, std::int32_t across, Routes& routes) {
  routesOf(batch, shift, across, routes);
}
WIDE void route(const Footprints::Boxes& batch, int shift, std::int32_t across, Routes& routes) {
  routesOf(batch, shift, across, routes);
}

}  // namespace solidcast
