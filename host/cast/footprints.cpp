#include "host/cast/footprints.h"

#include <algorithm>
#include <cmath>

namespace solidcast {
namespace {

// Compiled for several instruction sets, the processor chooses. None of them fuses products and sums (-ffp-contract), so
// that all give the same numbers. The sanitizers are not ready yet when such a choice is made.
#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define WIDE __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define WIDE
#endif

using View = Footprints::View;
using Result = Footprints::Result;
constexpr std::size_t block = Footprints::block;

struct Slopes {
  double x0, x1, y0, y1;
};

/// The first pixel whose centre is at or beyond `from`, and the last at or before `to`, both in [0, last] or none.
inline void pixels(double from, double to, double last, std::int32_t& first, std::int32_t& final) {
  from = from < 0 ? 0 : from > last + 1 ? last + 1 : from;
  to = to > last ? last : to < -1 ? -1 : to;
  const auto i = static_cast<std::int32_t>(from), k = static_cast<std::int32_t>(to);
  first = i + (i < from), final = k - (k > to);
}

inline void store(const View& v, const Slopes& s, bool plain, double nearest, double hides, std::size_t i, Result& r) {
  const double x0 = s.x0 * v.perX, x1 = s.x1 * v.perX, y0 = s.y0 * v.perY, y1 = s.y1 * v.perY;
  pixels(x0 + v.lowX - 2e-9 * std::abs(x0), x1 + v.highX + 2e-9 * std::abs(x1), v.lastX, r.x0[i], r.x1[i]);
  pixels(y0 + v.lowY - 2e-9 * std::abs(y0), y1 + v.highY + 2e-9 * std::abs(y1), v.lastY, r.y0[i], r.y1[i]);
  r.nearest[i] = static_cast<float>(nearest * (1 - 1e-6));
  r.hides[i] = static_cast<float>(hides);
  r.plain[i] = plain;
}

/// Centres from the world's origin, and radii. True: some sphere is farther than 16 radii.
WIDE bool ofSpheres(const View& v, const double (&c)[4][block], std::size_t n, Result& r) {
  std::int32_t far = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = c[0][i] - v.origin[0], y = c[1][i] - v.origin[1], z = c[2][i] - v.origin[2], radius = c[3][i];
    const double fx = x * v.inverseUnit, fy = y * v.inverseUnit, fz = z * v.inverseUnit, fr = radius * v.inverseUnit;
    far |= fx * fx + fy * fy + fz * fz > 256 * fr * fr;  // isFar()
    const double X = v.axes[0][0] * x + v.axes[0][1] * y + v.axes[0][2] * z;
    const double Y = v.axes[1][0] * x + v.axes[1][1] * y + v.axes[1][2] * z;
    const double Z = v.axes[2][0] * x + v.axes[2][1] * y + v.axes[2][2] * z;
    const double big = radius * (1 + 1e-9) + 1e-12 * (std::abs(X) + std::abs(Y) + std::abs(Z));
    const double q = Z * Z - big * big, inverse = 1 / q;
    const double hx = big * std::sqrt(X * X + q), hy = big * std::sqrt(Y * Y + q);
    store(v, {(X * Z - hx) * inverse, (X * Z + hx) * inverse, (Y * Z - hy) * inverse, (Y * Z + hy) * inverse},
          Z > 1.01 * big, Z - big, Z, i, r);
  }
  return far;
}

/// Corners from the eye.
template <std::size_t CORNERS>
inline __attribute__((always_inline)) void corners(const View& v, const double (&p)[3 * CORNERS][block], std::size_t n,
                                                   Result& r) {
  for (std::size_t i = 0; i < n; ++i) {
    Slopes s{1e300, -1e300, 1e300, -1e300};
    double nearest = 1e300, farthest = 0;
    bool front = true;
    for (std::size_t k = 0; k < CORNERS; ++k) {
      const double x = p[3 * k][i], y = p[3 * k + 1][i], z = p[3 * k + 2][i];
      const double X = v.axes[0][0] * x + v.axes[0][1] * y + v.axes[0][2] * z;
      const double Y = v.axes[1][0] * x + v.axes[1][1] * y + v.axes[1][2] * z;
      const double Z = v.axes[2][0] * x + v.axes[2][1] * y + v.axes[2][2] * z;
      const double inverse = 1 / Z, across = X * inverse, down = Y * inverse;
      front = front & (Z > 1e-6 * (std::abs(X) + std::abs(Y) + std::abs(Z)));
      s.x0 = across < s.x0 ? across : s.x0, s.x1 = across > s.x1 ? across : s.x1;
      s.y0 = down < s.y0 ? down : s.y0, s.y1 = down > s.y1 ? down : s.y1;
      nearest = Z < nearest ? Z : nearest, farthest = Z > farthest ? Z : farthest;
    }
    store(v, s, front, nearest, farthest, i, r);
  }
}
WIDE void ofTriangles(const View& v, const double (&p)[9][block], std::size_t n, Result& r) { corners<3>(v, p, n, r); }
WIDE void ofQuads(const View& v, const double (&p)[12][block], std::size_t n, Result& r) { corners<4>(v, p, n, r); }
WIDE void ofBoxes(const View& v, const double (&p)[24][block], std::size_t n, Result& r) { corners<8>(v, p, n, r); }

}  // namespace

Footprints::Footprints(const Silhouette& silhouette, const Crop& region, const Frame<double>& eye)
    : silhouette_(silhouette), region_(region), vectors_(silhouette.slopesAreEnough()) {
  const auto [perX, perY, middleX, middleY, slack] = silhouette.pixelsOfSlopes();
  for (std::size_t k = 0; k < 3; ++k) {
    view_.origin[k] = silhouette.origin()[k];
    for (std::size_t i = 0; i < 3; ++i) view_.axes[k][i] = silhouette.axes()[k][i];
  }
  view_.perX = perX, view_.perY = perY;
  view_.lowX = middleX - slack - 0.5 - region.x, view_.highX = middleX + slack - 0.5 - region.x;
  view_.lowY = middleY - slack - 0.5 - region.y, view_.highY = middleY + slack - 0.5 - region.y;
  view_.lastX = region.width - 1, view_.lastY = region.height - 1;
  view_.inverseUnit = 1 / eye.unit;
}

template <class Corners>
void Footprints::add(const Corners& corners, Batch<3 * std::tuple_size_v<Corners>>& batch, std::size_t at) {
  for (std::size_t k = 0; k < corners.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) batch.v[3 * k + i][batch.count] = corners[k][i];
  batch.at[batch.count++] = static_cast<std::uint8_t>(at);
}

template <std::size_t NUMBERS>
void Footprints::spread(Batch<NUMBERS>& batch, std::span<const SolidEntry> solids) {
  for (std::size_t i = 0; i < batch.count; ++i) {
    const std::size_t at = batch.at[i];
    found_[at] = result_.plain[i] ? Footprint{result_.x0[i], result_.y0[i],      result_.x1[i],
                                              result_.y1[i], result_.nearest[i], result_.hides[i]}
                                  : ask(solids[at].shape);
  }
  batch.count = 0;
}

void Footprints::find(std::span<const SolidEntry> solids) {
  for (std::size_t i = 0; i < solids.size(); ++i) {
    // The next block's, in time.
    const auto* next = reinterpret_cast<const char*>(solids.data() + block + i);
    __builtin_prefetch(next), __builtin_prefetch(next + 64);
    const Shape& shape = solids[i].shape;
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
      for (std::size_t k = 0; k < 3; ++k) spheres_.v[k][spheres_.count] = sphere->center[k];
      spheres_.v[3][spheres_.count] = sphere->radius;
      spheres_.at[spheres_.count++] = static_cast<std::uint8_t>(i);
    } else if (!vectors_) {
      found_[i] = ask(shape);
    } else if (const auto* triangle = std::get_if<Triangle>(&shape)) {
      add(outline(*triangle, silhouette_.origin()), triangles_, i);
    } else if (const auto* quad = std::get_if<Quad>(&shape)) {
      add(outline(*quad, silhouette_.origin()), quads_, i);
    } else if (const auto* box = std::get_if<AABox>(&shape)) {
      add(outline(*box, silhouette_.origin()), boxes_, i);
    } else {
      found_[i] = ask(shape);
    }
  }
  if (spheres_.count) {
    farSphere_ |= ofSpheres(view_, spheres_.v, spheres_.count, result_);
    if (!vectors_) std::fill_n(result_.plain, spheres_.count, 0);
    spread(spheres_, solids);
  }
  if (triangles_.count) ofTriangles(view_, triangles_.v, triangles_.count, result_), spread(triangles_, solids);
  if (quads_.count) ofQuads(view_, quads_.v, quads_.count, result_), spread(quads_, solids);
  if (boxes_.count) ofBoxes(view_, boxes_.v, boxes_.count, result_), spread(boxes_, solids);
}

/// Pixel i is seen at i + 0.5, so that [a, b] holds centres from ceil(a - 0.5) to floor(b - 0.5).
Footprint Footprints::ask(const Shape& shape) const {
  const Rectangle r = std::visit([&](const auto& solid) { return silhouette_.rectangle(solid); }, shape);
  const auto nearest = static_cast<float>(r.nearest * (1 - 1e-6));
  Footprint f{0, 0, region_.width - 1, region_.height - 1, nearest, nearest};
  if (r.everywhere) return f;
  // With NaN, max and min in this order are as far as possible.
  const auto from = [](double v) { return std::max(0.0, v); };
  const auto to = [](double last, double v) { return std::min(last, v); };
  if (r.x.from > r.x.to || r.y.from > r.y.to) return {0, 0, -1, -1, 0, 0};
  pixels(from(r.x.from - 0.5 - region_.x), to(view_.lastX, r.x.to - 0.5 - region_.x), view_.lastX, f.x0, f.x1);
  pixels(from(r.y.from - 0.5 - region_.y), to(view_.lastY, r.y.to - 0.5 - region_.y), view_.lastY, f.y0, f.y1);
  return f;
}

}  // namespace solidcast
