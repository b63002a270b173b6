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

/// Rows of a solid that are looked at together, by eights; the pixels of each that it covers, from its rectangle's left on.
constexpr int together = 32, eight = 8;
struct Spans {
  alignas(64) std::int32_t first[together], end[together];
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

/// `rows` of them from `row` on, by their place from the top of the rectangle; `width` of it.
/// In fp32, which moves the rim by less than 2^-19 of the ellipse's size: it is made so much smaller.
WIDE void ellipseSpans(const double (&v)[8], double left, double top, float width, int row, int rows, Spans& spans) {
  const double less = (v[2] + v[3]) * 0x1p-19;
  const auto x = static_cast<float>(v[0] - left), y = static_cast<float>(v[1] - top - row - 0.5);
  const auto wide = static_cast<float>(v[2] - less), each = static_cast<float>(1 / (v[3] - less));
  for (int of = 0; of < rows; of += eight)
    for (int i = of; i < of + eight; ++i) {
      const float down = (static_cast<float>(i) - y) * each, half = wide * std::sqrt(most(0.f, 1 - down * down));
      spans.first[i] = place(x - half, width);
      spans.end[i] = place(x + half, width);
    }
}

/// An edge bounds x in each row, on the left or on the right; on the other side, by `none`, it does not.
struct Edges {
  double left[4], right[4], slope[4];
};
constexpr double none = 1e300;

WIDE void polygonSpans(const Edges& edges, int count, double width, int row, int rows, Spans& spans) {
  for (int of = 0; of < rows; of += eight) {
    double from[eight], to[eight];
    for (int i = 0; i < eight; ++i) from[i] = 0, to[i] = width;
    for (int k = 0; k < count; ++k) {
      const double left = edges.left[k], right = edges.right[k], slope = edges.slope[k];
      for (int i = 0; i < eight; ++i) {
        const double x = slope * (row + of + i + 0.5);
        from[i] = most(from[i], left + x), to[i] = least(to[i], right + x);
      }
    }
    for (int i = 0; i < eight; ++i) {
      spans.first[of + i] = place(from[i], width);
      spans.end[of + i] = place(to[i], width);
    }
  }
}

/// Lowers what `spans` say of `rows` rows to `depth`; `to` is the rectangle's left in the first of them. Where a span ends
/// within a vector, the rest of it keeps what it has.
WIDE void lower(DepthCode* to, std::size_t stride, int width, int rows, const Spans& spans, DepthCode depth) {
  constexpr Places lane{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  for (int y = 0; y < rows; ++y, to += stride) {
    const auto first = static_cast<std::int16_t>(spans.first[y]), end = static_cast<std::int16_t>(spans.end[y]);
    // Narrow solids: the same number of vectors in each row.
    const int from = width <= 4 * lanes ? 0 : first / lanes * lanes, last = width <= 4 * lanes ? width : end;
    Places at = lane + static_cast<std::int16_t>(from);
    for (int x = from; x < last; x += lanes, at += lanes) {
      Codes now;
      std::memcpy(&now, to + x, sizeof now);
      const Codes other = depth | ~reinterpret_cast<Codes>((at >= first) & (at < end));
      now = now < other ? now : other;
      std::memcpy(to + x, &now, sizeof now);
    }
  }
}

WIDE void lowerAll(DepthCode* to, const DepthCode* by, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) to[i] = std::min(to[i], by[i]);
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

/// Of each tile and its neighbours to the right and below, at a distance of `step`; there are none beyond the last.
WIDE void widened(const DepthCode* of, std::size_t across, std::size_t down, std::size_t step, DepthCode* to) {
  for (std::size_t y = 0; y < down; ++y) {
    const DepthCode *here = of + y * across, *below = of + std::min(y + step, down - 1) * across;
    for (std::size_t x = 0; x + step < across; ++x)
      to[y * across + x] = std::max(std::max(here[x], here[x + step]), std::max(below[x], below[x + step]));
    for (std::size_t x = across - std::min(step, across); x < across; ++x)
      to[y * across + x] = std::max(std::max(here[x], here[across - 1]), std::max(below[x], below[across - 1]));
  }
}

}  // namespace

void DepthBounds::start(const Crop& region, int stride, int rows, int wide) {
  stride_ = static_cast<std::size_t>(stride), rows_ = static_cast<std::size_t>(rows);
  across_ = stride_ / side, wide_ = static_cast<std::size_t>(wide);
  width_ = region.width, height_ = region.height;
  tiles_.clear();
  work_ = 0;
  most_ = 8.0 * width_ * height_;
  depth_.resize(stride_ * rows_ + 8 * lanes);  // what lower() touches beyond a row's end
  std::fill(depth_.begin(), depth_.end(), DepthCode{0});
  for (std::size_t y = 0; y < static_cast<std::size_t>(height_); ++y)
    std::fill_n(depth_.begin() + static_cast<std::ptrdiff_t>(stride_ * y), width_, DepthScale::none);
}

void DepthBounds::add(const Footprint& f, const Cover& cover) {
  const double width = f.x1 - f.x0 + 1;
  const int height = f.y1 - f.y0 + 1;
  work_ += width * height;
  double top, bottom;
  Edges edges;
  int count = 0;
  if (cover.corners == 0) {
    top = cover.v[1] - cover.v[3], bottom = cover.v[1] + cover.v[3];
  } else {
    double turn = 0;
    const auto corner = [&](int i) { return cover.v + 2 * (i == cover.corners ? 0 : i); };
    top = none, bottom = -none;
    for (int i = 0; i < cover.corners; ++i) {
      const double *p = corner(i), *q = corner(i + 1);
      turn += p[0] * q[1] - q[0] * p[1];
      top = least(top, p[1]), bottom = most(bottom, p[1]);
    }
    for (int i = 0; i < cover.corners; ++i) {
      const double *p = corner(i), *q = corner(i + 1);
      const double down = q[1] - p[1], along = q[0] - p[0];
      if (std::abs(down) <= 1e-7 * std::abs(along)) continue;  // as good as level: top or bottom bounds it
      const double slope = along / down, shift = cover.margin * (1 + std::abs(slope));
      const double x = p[0] - f.x0 - slope * (p[1] - f.y0);
      const bool isLeft = (down < 0) == (turn > 0);
      edges.left[count] = isLeft ? x + shift : -none, edges.right[count] = isLeft ? none : x - shift;
      edges.slope[count++] = slope;
    }
    top += 2 * cover.margin, bottom -= 2 * cover.margin;
  }
  const int first = place(top - f.y0, double(height)), end = place(bottom - f.y0, double(height));
  Spans spans;
  for (int row = first; row < end; row += together) {
    const int rows = std::min(end - row, together);
    if (cover.corners == 0) ellipseSpans(cover.v, f.x0, f.y0, static_cast<float>(width), row, rows, spans);
    else polygonSpans(edges, count, width, row, rows, spans);
    lower(depth_.data() + static_cast<std::size_t>(f.y0 + row) * stride_ + f.x0, stride_, static_cast<int>(width), rows,
          spans, f.hides);
  }
}

void DepthBounds::merge(const std::vector<DepthBounds*>& all, std::size_t first, std::size_t end) {
  const std::size_t from = first * all[0]->stride_, count = (end - first) * all[0]->stride_;
  DepthCode* nearest = all[0]->depth_.data() + from;
  for (std::size_t i = 1; i < all.size(); ++i) lowerAll(nearest, all[i]->depth_.data() + from, count);
  for (std::size_t i = 1; i < all.size(); ++i) std::copy_n(nearest, count, all[i]->depth_.data() + from);
}

void DepthBounds::noteTiles() {
  const std::size_t across = across_, down = rows_ / side;
  tiles_.resize(across * down), deepest2_.resize(across * down), deepest4_.resize(across * down);
  for (std::size_t y = 0; y < down; ++y)
    deepestOf(depth_.data() + y * side * stride_, stride_, across, tiles_.data() + y * across);
  widened(tiles_.data(), across, down, 1, deepest2_.data());
  widened(deepest2_.data(), across, down, 2, deepest4_.data());
  levels_ = {tiles_.data(), deepest2_.data(), deepest4_.data(), deepest4_.data()};
  const std::size_t wideAcross = (across + wide_ - 1) / wide_, wideDown = (down + wide_ - 1) / wide_;
  wideTiles_.assign(wideAcross * wideDown, 0);
  for (std::size_t y = 0; y < down; ++y)
    for (std::size_t x = 0; x < across; x += wide_) {
      const DepthCode* of = tiles_.data() + y * across;
      DepthCode& deepest = wideTiles_[y / wide_ * wideAcross + x / wide_];
      deepest = std::max(deepest, *std::max_element(of + x, of + std::min(x + wide_, across)));
    }
}

bool DepthBounds::hides(const Footprint& f) const {
  if (f.x1 - f.x0 >= lanes || f.y1 - f.y0 >= lanes || *middle(f) >= f.nearest) return false;
  const DepthCode* at = depth_.data() + static_cast<std::size_t>(f.y0) * stride_ + f.x0;
  Codes deepest{};
  for (int y = f.y0; y <= f.y1; ++y, at += stride_) {
    Codes now;
    std::memcpy(&now, at, sizeof now);
    deepest = deepest > now ? deepest : now;
  }
  constexpr Places lane{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  const Codes seen = reinterpret_cast<Codes>(lane <= static_cast<std::int16_t>(f.x1 - f.x0)) & (deepest >= f.nearest);
  std::uint64_t any[sizeof seen / 8];
  std::memcpy(any, &seen, sizeof seen);
  return !(any[0] | any[1] | any[2] | any[3]);
}

}  // namespace solidcast
