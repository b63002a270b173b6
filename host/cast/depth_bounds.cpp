#include "host/cast/depth_bounds.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "host/cast/wide.h"

namespace solidcast {
namespace {

// Branches on what differs from solid to solid are mispredicted half of the time, hence vectors and selections.
constexpr int lanes = 16;
using Codes = DepthCode __attribute__((vector_size(2 * lanes)));
using Places = std::int16_t __attribute__((vector_size(2 * lanes)));

/// Rows of a solid that are looked at together; the pixels of each that it covers, from its rectangle's left on.
constexpr int eight = 8;
struct Spans {
  alignas(32) std::int32_t first[eight], end[eight];
};

/// What a solid lowers: `to` is its rectangle's first pixel.
struct Area {
  DepthCode* to;
  std::ptrdiff_t stride;
  int width, height;
  DepthCode depth;
};

template <class T>
inline T most(T a, T b) {
  return a > b ? a : b;
}
template <class T>
inline T least(T a, T b) {
  return a < b ? a : b;
}

/// Pixels from the result for `from` up to, not including, that for `to` have their centres between; one exactly on the rim
/// may be missing.
template <class T>
inline std::int32_t place(T at, T all) {
  return static_cast<std::int32_t>(least(all, most(T(0), at + T(0.5))));
}

/// Lowers what `spans` say of the eight rows from `row` on, which may be more than there are. Where a span ends within a
/// vector, the rest of it keeps what it has.
inline __attribute__((always_inline)) void lower(const Area& area, int row, const Spans& spans) {
  constexpr Places lane{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  DepthCode* to = area.to + row * area.stride;
  const auto one = [&](int y, int x) __attribute__((always_inline)) {
    const auto first = static_cast<std::int16_t>(spans.first[y]), end = static_cast<std::int16_t>(spans.end[y]);
    const Places at = lane + static_cast<std::int16_t>(x);
    Codes now;
    std::memcpy(&now, to + x, sizeof now);
    const Codes other = area.depth | ~reinterpret_cast<Codes>((at >= first) & (at < end));
    now = now < other ? now : other;
    std::memcpy(to + x, &now, sizeof now);
  };
  if (area.width <= lanes) {
#pragma GCC unroll 8
    for (int y = 0; y < eight; ++y, to += area.stride) one(y, 0);
    return;
  }
  for (int y = 0; y < eight; ++y, to += area.stride)
    for (int x = spans.first[y] / lanes * lanes; x < spans.end[y]; x += lanes) one(y, x);
}

/// Its centre in pixels from the rectangle's corner, half its width, half its height. In fp32, which moves the rim by less
/// than 2^-19 of the ellipse's size: it is made so much smaller.
struct Ellipse {
  double x, y, wide, high;
};
WIDE void lowerEllipse(const Area& area, const Ellipse& e) {
  const double less = (e.wide + e.high) * 0x1p-19;
  if (e.high <= less || e.wide <= less) return;  // pixels a thousand times as long as wide
  const auto x = static_cast<float>(e.x), y = static_cast<float>(e.y - 0.5), width = static_cast<float>(area.width);
  const auto wide = static_cast<float>(e.wide - less), each = static_cast<float>(1 / (e.high - less));
  for (int row = 0; row < area.height; row += eight) {
    Spans spans;
    for (int i = 0; i < eight; ++i) {
      const float down = (static_cast<float>(row + i) - y) * each, half = wide * std::sqrt(most(0.f, 1 - down * down));
      spans.first[i] = place(x - half, width);
      spans.end[i] = place(x + half, width);
    }
    lower(area, row, spans);
  }
}

/// Eight rows at a time, in 32nds of a pixel: dx^2 + dy^2 <= r^2. What is farther than 255 of them in x is so by 255 as well.
/// `x`, `y`: from the disc's centre to that of the first pixel.
inline __attribute__((always_inline)) void lowerDisc(const Area& area, std::int16_t x, std::int16_t y,
                                                     std::int32_t radius) {
  constexpr Places lane{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  constexpr std::int16_t far = 255, per = SmallDisc::perPixel;
  const Places across = lane * per + x;
  const Places away = across < 0 ? -across : across;
  const Codes near = reinterpret_cast<Codes>(away < far ? away : far), squares = near * near;
  DepthCode* to = area.to;
  for (int row = 0; row < area.height; row += eight) {
    alignas(16) DepthCode within[eight];  // of the squares, this many
    for (int i = 0; i < eight; ++i) {
      const std::int32_t down = y + per * (row + i), left = radius * radius + 1 - down * down;
      within[i] = static_cast<DepthCode>(left > 0 ? left : 0);
    }
#pragma GCC unroll 8
    for (int i = 0; i < eight; ++i, to += area.stride) {
      Codes now;
      std::memcpy(&now, to, sizeof now);
      const Codes other = area.depth | ~reinterpret_cast<Codes>(squares < within[i]);
      now = now < other ? now : other;
      std::memcpy(to, &now, sizeof now);
    }
  }
}

/// Of those of `solids` at `places`. `depth`, `left` and `above`: the area's first pixel.
WIDE void lowerDiscs(DepthCode* depth, std::ptrdiff_t stride, int left, int above, std::span<const SeenWithin> solids,
                     std::span<const std::uint32_t> places, const SmallDiscs& discs) {
  // Modulo 2048 pixels, as the disc's place is: the rectangle is not so far from it.
  const auto from = [](int pixel, std::uint16_t centre) {
    return static_cast<std::int16_t>(pixel * SmallDisc::perPixel + SmallDisc::perPixel / 2 - centre);
  };
  for (const std::uint32_t at : places) {
    const SeenWithin s = solids[at];
    const SmallDisc disc = discs.of[s.solid - discs.first];
    const Area area{depth + s.y0() * stride + s.x0(), stride, s.x1() - s.x0() + 1, s.y1() - s.y0() + 1, disc.hides()};
    lowerDisc(area, from(s.x0() + left, disc.x()), from(s.y0() + above, disc.y()), disc.radius());
  }
}

/// An edge bounds x in each row, on the left or on the right; on the other side, by `none`, it does not. Rows beyond top or
/// bottom are not in it. In pixels from the rectangle's corner.
struct Edges {
  double left[4], right[4], slope[4];
  int count = 0;
  double top, bottom;
};
constexpr double none = 1e300;

WIDE void lowerPolygon(const Area& area, const Edges& edges) {
  const double width = area.width;
  const int first = place(edges.top, double(area.height)), end = place(edges.bottom, double(area.height));
  for (int row = first; row < end; row += eight) {
    double from[eight], to[eight];
    for (int i = 0; i < eight; ++i) from[i] = 0, to[i] = row + i < end ? width : 0;
    for (int k = 0; k < edges.count; ++k) {
      const double left = edges.left[k], right = edges.right[k], slope = edges.slope[k];
      for (int i = 0; i < eight; ++i) {
        const double x = slope * (row + i + 0.5);
        from[i] = most(from[i], left + x), to[i] = least(to[i], right + x);
      }
    }
    Spans spans;
    for (int i = 0; i < eight; ++i) {
      spans.first[i] = place(from[i], width);
      spans.end[i] = place(to[i], width);
    }
    lower(area, row, spans);
  }
}

/// The largest of four rows, by groups of four pixels.
WIDE void deepestOf(const DepthCode* row, std::size_t stride, std::size_t tiles, DepthCode* to) {
  for (std::size_t x = 0; x < tiles; ++x) {
    DepthCode deepest = 0;
    for (std::size_t y = 0; y < DepthBounds::side; ++y)
      for (std::size_t k = 0; k < DepthBounds::side; ++k)
        deepest = std::max(deepest, row[y * stride + DepthBounds::side * x + k]);
    to[x] = deepest;
  }
}

/// Of each tile and its neighbours to the right and below, at a distance of `step`. To the right of a row's last tile the next
/// row is taken, which makes the limit no more than too deep; below the last row is 0.
WIDE void widened(const DepthCode* of, std::size_t tiles, std::size_t across, std::size_t step, DepthCode* to) {
  const DepthCode* below = of + step * across;
  for (std::size_t i = 0; i < tiles; ++i) to[i] = most(most(of[i], of[i + step]), most(below[i], below[i + step]));
}

/// Whether some pixel of a small solid's rectangle is not hit before it begins; `from` is its first. Always whole eights of
/// rows: how many there are differs from solid to solid.
inline __attribute__((always_inline)) bool somePixel(const DepthCode* from, std::ptrdiff_t stride, int width,
                                                     int height, DepthCode nearest) {
  Codes deepest{};
  for (int of = 0; of < height; of += eight)
#pragma GCC unroll 8
    for (int y = of; y < of + eight; ++y) {
      Codes now;
      std::memcpy(&now, from, sizeof now);
      deepest = deepest > now ? deepest : now;
      from += y + 1 < height ? stride : 0;
    }
  constexpr Places lane{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const Codes seen = reinterpret_cast<Codes>(lane < static_cast<std::int16_t>(width)) & (deepest >= nearest);
  std::uint64_t any[sizeof seen / 8];
  std::memcpy(any, &seen, sizeof seen);
  return any[0] | any[1] | any[2] | any[3];
}

__attribute__((noinline)) bool someTile(const TileLimits& tiles, const SeenWithin& s) {
  constexpr std::uint32_t side = TileLimits::side;
  return tiles.some((s.first & 0xffff) / side, (s.first >> 16) / side, (s.last & 0xffff) / side, (s.last >> 16) / side,
                    s.nearest());
}

WIDE std::size_t visibleOf(const DepthCode* depth, std::ptrdiff_t stride, const TileLimits& tiles,
                           std::span<const SeenWithin> solids, std::span<const std::uint32_t> order,
                           std::size_t mostCovering, std::span<std::uint32_t> places, std::size_t& looked) {
  std::size_t found = 0, covering = 0;
  constexpr std::size_t few = Footprints::block;
  while (looked < order.size() && found < places.size() && covering < mostCovering) {
    std::array<std::uint32_t, few> near;  // not behind the tiles' limits
    const std::size_t end = looked + std::min({few, order.size() - looked, places.size() - found});
    std::size_t count = 0;
    for (; looked < end; ++looked) {
      const SeenWithin s = solids[order[looked]];
      near[count] = order[looked];
      count += !tiles.behind(s.first & 0xffff, s.first >> 16, s.last & 0xffff, s.last >> 16, s.nearest());
    }
    for (const std::uint32_t at : std::span(near).first(count)) {
      const SeenWithin s = solids[at];
      const int width = s.x1() - s.x0() + 1, height = s.y1() - s.y0() + 1;
      const bool seen = (width <= lanes) & (height <= lanes)
                            ? somePixel(depth + s.y0() * stride + s.x0(), stride, width, height, s.nearest())
                            : someTile(tiles, s);
      places[found] = at;
      found += seen, covering += seen & s.covers();
    }
  }
  return found;
}

WIDE std::size_t notBehind(const TileLimits& tiles, std::span<const SeenWithin> solids, SeenWithin* to) {
  std::size_t count = 0;
  for (const SeenWithin& s : solids) {
    to[count] = s;
    count += !tiles.behind(s.first & 0xffff, s.first >> 16, s.last & 0xffff, s.last >> 16, s.nearest());
  }
  return count;
}

}  // namespace

void TileLimits::start(std::size_t across, std::size_t down) {
  across_ = across, down_ = down;
  const std::size_t tiles = across * down;
  for (auto* of : {&byTile_, &deepest2_, &deepest3_, &deepest4_}) {
    of->resize(tiles + 2 * (across + 1));
    std::fill_n(of->begin(), tiles, DepthScale::none);
    std::fill(of->begin() + static_cast<std::ptrdiff_t>(tiles), of->end(), DepthCode{0});
  }
  levels_ = {byTile_.data(), deepest2_.data(), deepest3_.data(), deepest4_.data()};
}

void TileLimits::widen() {
  widened(byTile_.data(), across_ * down_, across_, 1, deepest2_.data());
  widened(deepest2_.data(), across_ * down_, across_, 1, deepest3_.data());
  widened(deepest2_.data(), across_ * down_, across_, 2, deepest4_.data());
}

void DepthBounds::start(const Crop& area, int width, int height) {
  area_ = area;
  stride_ = area.width + lanes;  // lower() and visible() touch what is beyond a row's end, and rows beyond the last
  depth_.assign(static_cast<std::size_t>(stride_) * static_cast<std::size_t>(area.height + eight) + lanes,
                DepthCode{0});
  const int inside = std::min(area.width, width - area.x), rows = std::min(area.height, height - area.y);
  for (int y = 0; y < rows; ++y) std::fill_n(depth_.begin() + y * stride_, std::max(inside, 0), DepthScale::none);
  tiles_.start(static_cast<std::size_t>(area.width / side), static_cast<std::size_t>(area.height / side));
  deepest_ = DepthScale::none;
}

SeenWithin within(const Footprint& f, std::uint32_t solid, const Crop& area) {
  constexpr int side = TileLimits::side;
  const auto pixel = [](std::int32_t x, std::int32_t y) {
    return static_cast<std::uint32_t>(y) << 16 | static_cast<std::uint32_t>(x);
  };
  // Of 2x2 tiles, what is left of them where the area begins after the first.
  const int right = f.x0 / side < area.x / side, lower = f.y0 / side < area.y / side;
  const std::uint32_t misses = f.misses >> (right + 2 * lower),
                      covers = f.hides != DepthScale::none ? SeenWithin::shape : 0;
  return {pixel(std::max(f.x0 - area.x, 0), std::max(f.y0 - area.y, 0)),
          pixel(std::min(f.x1 - area.x, area.width - 1), std::min(f.y1 - area.y, area.height - 1)),
          covers | misses << 16 | f.nearest, solid};
}

void DepthBounds::add(const SeenWithin& in, DepthCode hides, const Cover& cover) {
  const double left = in.x0() + area_.x, above = in.y0() + area_.y;  // as the cover counts
  const Area area{depth_.data() + in.y0() * stride_ + in.x0(), stride_, in.x1() - in.x0() + 1, in.y1() - in.y0() + 1,
                  hides};
  if (cover.corners == 0) return lowerEllipse(area, {cover.v[0] - left, cover.v[1] - above, cover.v[2], cover.v[3]});
  const auto corner = [&](int i) { return cover.v + 2 * (i == cover.corners ? 0 : i); };
  double turn = 0, top = none, bottom = -none;
  for (int i = 0; i < cover.corners; ++i) {
    const double *p = corner(i), *q = corner(i + 1);
    turn += p[0] * q[1] - q[0] * p[1];
    top = least(top, p[1]), bottom = most(bottom, p[1]);
  }
  Edges edges;
  edges.top = top - above + 2 * cover.margin, edges.bottom = bottom - above - 2 * cover.margin;
  for (int i = 0; i < cover.corners; ++i) {
    const double *p = corner(i), *q = corner(i + 1);
    const double down = q[1] - p[1], along = q[0] - p[0];
    if (std::abs(down) <= 1e-7 * std::abs(along)) continue;  // as good as level: top or bottom bounds it
    const double slope = along / down, shift = cover.margin * (1 + std::abs(slope));
    const double x = p[0] - left - slope * (p[1] - above);
    const bool isLeft = (down < 0) == (turn > 0);
    edges.left[edges.count] = isLeft ? x + shift : -none, edges.right[edges.count] = isLeft ? none : x - shift;
    edges.slope[edges.count++] = slope;
  }
  lowerPolygon(area, edges);
}

void DepthBounds::add(std::span<const SeenWithin> solids, std::span<const std::uint32_t> places,
                      const SmallDiscs& discs) {
  lowerDiscs(depth_.data(), stride_, area_.x, area_.y, solids, places, discs);
}

void DepthBounds::noteTiles() {
  const auto across = static_cast<std::size_t>(area_.width / side),
             down = static_cast<std::size_t>(area_.height / side);
  deepest_ = 0;
  for (std::size_t y = 0; y < down; ++y) {
    DepthCode* row = tiles_.row(y);
    deepestOf(depth_.data() + static_cast<std::ptrdiff_t>(y) * side * stride_, static_cast<std::size_t>(stride_),
              across, row);
    deepest_ = std::max(deepest_, *std::max_element(row, row + across));
  }
  tiles_.widen();
}

void DepthBounds::addNotBehind(std::span<const SeenWithin> solids, Pile<SeenWithin>& to) const {
  SeenWithin* const end = to.room(solids.size());
  if (deepest_ == DepthScale::none) std::ranges::copy(solids, end), to.take(solids.size());
  else to.take(notBehind(tiles_, solids, end));
}

std::size_t DepthBounds::visible(std::span<const SeenWithin> solids, std::span<const std::uint32_t> order,
                                 std::size_t mostCovering, std::span<std::uint32_t> places, std::size_t& looked) const {
  return visibleOf(depth_.data(), stride_, tiles_, solids, order, mostCovering, places, looked);
}

}  // namespace solidcast
