#include "host/cast/footprints.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/cast/footprint_kernels.h"
#include "host/cast/wide.h"

namespace solidcast {
namespace {

/// Of `count` solids, as a batch takes them from `to` on: spheres as they are, corners from the eye.
template <class Solid>
inline __attribute__((always_inline)) void cornersOf(const Solid* __restrict solids, std::size_t count,
                                                     const Triple& from, auto& __restrict b, std::size_t to) {
  const Triple origin = from;
  for (std::size_t i = 0; i < count; ++i) {
    const auto corners = outline(solids[i], origin);
#pragma GCC unroll 9
    for (std::size_t k = 0; k < corners.size(); ++k)
#pragma GCC unroll 9
      for (std::size_t axis = 0; axis < 3; ++axis) b.v[3 * k + axis][to + i] = corners[k][axis];
  }
}
WIDE void numbersOf(const Triangle* solids, std::size_t count, const Triple& origin, Footprints::Triangles& b,
                    std::size_t to) {
  cornersOf(solids, count, origin, b, to);
}
WIDE void numbersOf(const Quad* solids, std::size_t count, const Triple& origin, Footprints::Quads& b, std::size_t to) {
  cornersOf(solids, count, origin, b, to);
}
WIDE void numbersOf(const AABox* solids, std::size_t count, const Triple& origin, Footprints::Boxes& b,
                    std::size_t to) {
  cornersOf(solids, count, origin, b, to);
}

/// Edges of a polygon, around so that its inner side has along dy - down dx >= 0, dx and dy from the edge's corner. `p`: the
/// corners in pixels.
template <std::size_t CORNERS>
struct Sides {
  double along[CORNERS], down[CORNERS];

  explicit Sides(const double (&p)[2 * CORNERS]) {
    double turn = 0;
#pragma GCC unroll 9
    for (std::size_t k = 0; k < CORNERS; ++k) {
      const std::size_t next = k + 1 == CORNERS ? 0 : k + 1;
      turn += p[2 * k] * p[2 * next + 1] - p[2 * next] * p[2 * k + 1];
    }
    const double sign = turn < 0 ? -1 : 1;
#pragma GCC unroll 9
    for (std::size_t k = 0; k < CORNERS; ++k) {
      const std::size_t next = k + 1 == CORNERS ? 0 : k + 1;
      along[k] = (p[2 * next] - p[2 * k]) * sign, down[k] = (p[2 * next + 1] - p[2 * k + 1]) * sign;
    }
  }
};

/// Whether some centre of the 3x3 pixels from (x, y) on lies in a polygon, or nearer to it than the margin: many triangles
/// of a fine mesh hold none.
template <std::size_t CORNERS>
inline __attribute__((always_inline)) bool holdsCentre(const double (&p)[2 * CORNERS], const Sides<CORNERS>& sides,
                                                       double x, double y, double margin) {
  double inside[9];
#pragma GCC unroll 9
  for (double& of : inside) of = 1;
#pragma GCC unroll 9
  for (std::size_t k = 0; k < CORNERS; ++k) {
    const double along = sides.along[k], down = sides.down[k];
    const double first =
        along * (y + 0.5 - p[2 * k + 1]) - down * (x + 0.5 - p[2 * k]) + margin * (std::abs(along) + std::abs(down));
#pragma GCC unroll 9
    for (std::size_t i = 0; i < 9; ++i) {
      const double at = first + along * static_cast<double>(i / 3) - down * static_cast<double>(i % 3);
      inside[i] = at < inside[i] ? at : inside[i];
    }
  }
  double best = inside[0];
#pragma GCC unroll 9
  for (const double of : inside) best = of > best ? of : best;
  return best >= 0;
}

/// Footprint::misses of a polygon: an edge has all centres of the tile's part of the rectangle on its outer side, and not
/// nearer than the margin.
template <std::size_t CORNERS>
inline __attribute__((always_inline)) std::int32_t missedTiles(const double (&p)[2 * CORNERS],
                                                               const Sides<CORNERS>& sides, std::int32_t x0,
                                                               std::int32_t y0, std::int32_t x1, std::int32_t y1,
                                                               double margin) {
  constexpr std::int32_t last = Footprints::tile - 1;
  const std::int32_t splitX = (x0 | last) + 1, splitY = (y0 | last) + 1;  // where the second tiles begin
  const double left[2] = {x0 + 0.5, splitX + 0.5}, right[2] = {(x1 < splitX ? x1 : splitX - 1) + 0.5, x1 + 0.5};
  const double top[2] = {y0 + 0.5, splitY + 0.5}, bottom[2] = {(y1 < splitY ? y1 : splitY - 1) + 0.5, y1 + 0.5};
  double inside[4] = {1, 1, 1, 1};
#pragma GCC unroll 9
  for (std::size_t k = 0; k < CORNERS; ++k) {
    const double along = sides.along[k], down = sides.down[k], near = margin * (std::abs(along) + std::abs(down));
#pragma GCC unroll 9
    for (std::size_t i = 0; i < 4; ++i) {
      const double x = down > 0 ? left[i % 2] : right[i % 2], y = along > 0 ? bottom[i / 2] : top[i / 2];
      const double at = along * (y - p[2 * k + 1]) - down * (x - p[2 * k]) + near;
      inside[i] = at < inside[i] ? at : inside[i];
    }
  }
  const bool few = (x1 - splitX < Footprints::tile) & (y1 - splitY < Footprints::tile);
  const std::int32_t missed =
      (inside[0] < 0 ? 1 : 0) + (inside[1] < 0 ? 2 : 0) + (inside[2] < 0 ? 4 : 0) + (inside[3] < 0 ? 8 : 0);
  return few ? missed : 0;
}

/// Corners from the eye. COVERS: the first three tell the plane, and what hides by it is nowhere beyond the farthest
/// corner, unless it is seen so flat that the shader's rounding can move it.
template <std::size_t CORNERS, bool POLYGON, bool COVERS>
inline __attribute__((always_inline)) void corners(const Footprints::View& view, auto& b) {
  const Footprints::View v = view;
  for (std::size_t i = 0, count = b.count; i < count; ++i) {
    const auto& p = b.v;
    Slopes s{1e300, -1e300, 1e300, -1e300};
    double nearest = 1e300, farthest = 0, around[2 * CORNERS];
    bool front = true, covers = POLYGON;
#pragma GCC unroll 9
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
      const std::size_t to = CORNERS == 4 ? k ^ k >> 1 : k;  // around, not by rows
      around[2 * to] = across * v.perX + v.middleX, around[2 * to + 1] = down * v.perY + v.middleY;
    }
    if constexpr (COVERS) {
#pragma GCC unroll 9
      for (std::size_t k = 0; k < 2 * CORNERS; ++k) b.cover[k][i] = around[k];
      const double ax = p[3][i] - p[0][i], ay = p[4][i] - p[1][i], az = p[5][i] - p[2][i];
      const double bx = p[6][i] - p[0][i], by = p[7][i] - p[1][i], bz = p[8][i] - p[2][i];
      const double nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
      const double plane = nx * p[0][i] + ny * p[1][i] + nz * p[2][i], least = v.flat * farthest;
      covers = (nx * nx + ny * ny + nz * nz) * (least * least) < plane * plane;
      const double edges = 2 * v.margin;
      covers = covers & ((s.x1 - s.x0) * v.perX > edges) & ((s.y1 - s.y0) * v.perY > edges);
    }
    store(v, s, front, nearest, farthest * (1 + 0x1p-12), covers, i, b);
    if constexpr (POLYGON && !COVERS) {
      const Sides<CORNERS> sides(around);
      const std::int32_t x0 = b.x0[i], y0 = b.y0[i], x1 = b.x1[i], y1 = b.y1[i];
      b.misses[i] = missedTiles<CORNERS>(around, sides, x0, y0, x1, y1, v.edges);
      const bool held = holdsCentre<CORNERS>(around, sides, x0, y0, v.edges);
      b.x1[i] = (x1 - x0 < 3) & (y1 - y0 < 3) & !held ? -1 : x1;
    }
  }
}
WIDE void ofTriangles(const Footprints::View& v, Footprints::Triangles& b) { corners<3, true, false>(v, b); }
WIDE void ofCoveringTriangles(const Footprints::View& v, Footprints::Triangles& b) { corners<3, true, true>(v, b); }
WIDE void ofQuads(const Footprints::View& v, Footprints::Quads& b) { corners<4, true, false>(v, b); }
WIDE void ofCoveringQuads(const Footprints::View& v, Footprints::Quads& b) { corners<4, true, true>(v, b); }
WIDE void ofBoxes(const Footprints::View& v, Footprints::Boxes& b) { corners<8, false, false>(v, b); }

}  // namespace

Footprints::Footprints(const Silhouette& silhouette, const Crop& region, const Frame<double>& eye, RealType type,
                       DepthScale scale)
    : silhouette_(silhouette), region_(region), vectors_(silhouette.slopesAreEnough()) {
  const auto [perX, perY, middleX, middleY, slack] = silhouette.pixelsOfSlopes();
  for (std::size_t k = 0; k < 3; ++k) {
    view_.origin[k] = silhouette.origin()[k];
    for (std::size_t i = 0; i < 3; ++i) view_.axes[k][i] = silhouette.axes()[k][i];
  }
  view_.perX = perX, view_.perY = perY;
  view_.middleX = middleX - region.x, view_.middleY = middleY - region.y;
  view_.lowX = middleX - slack - 0.5 - region.x, view_.highX = middleX + slack - 0.5 - region.x;
  view_.lowY = middleY - slack - 0.5 - region.y, view_.highY = middleY + slack - 0.5 - region.y;
  view_.lastX = region.width - 1, view_.lastY = region.height - 1;
  view_.inverseUnit = 1 / eye.unit;
  // The longest of the directions (x, y, 1) counts.
  const double x = middleX / perX, y = middleY / perY, steep = 1 + x * x + y * y;
  view_.margin = 1e-3 + (type == RealType::f32 ? 4e-6 : 1e-12) * steep * std::max(perX, perY);
  view_.rough = 2e-3 + 2e-6 * (std::sqrt(steep) * std::max(perX, perY) + std::max(region.width, region.height));
  view_.lost = type == RealType::f32 ? 0x1p-17 : 0x1p-40;
  view_.flat = 8 * unitRoundoff(type) * std::sqrt(steep) * 0x1p12;  // an error of 2^-12
  view_.scale = scale;
  spheres_.corners = 0, triangles_.corners = 3, quads_.corners = 4, boxes_.corners = 0;
  view_.edges = silhouette.centresAlone() ? view_.margin : 1e9;
}

void Footprints::gather(std::span<const ShapeRef> solids) {
  spheres_.count = triangles_.count = quads_.count = boxes_.count = others_.count = 0;
  const auto add = [](const auto& solid, const Triple& origin, auto& batch, std::size_t at) {
    numbersOf(&solid, 1, origin, batch, batch.count);
    batch.at[batch.count++] = static_cast<std::uint32_t>(at);
  };
  const Triple& origin = silhouette_.origin();
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const ShapeRef shape = solids[i];
    const auto* triangle = vectors_ ? shape.getIf<Triangle>() : nullptr;
    const auto* quad = vectors_ ? shape.getIf<Quad>() : nullptr;
    const auto* box = vectors_ ? shape.getIf<AABox>() : nullptr;
    if (const auto* sphere = shape.getIf<Sphere>()) add(*sphere, origin, spheres_, i);
    else if (triangle) add(*triangle, origin, triangles_, i);
    else if (quad) add(*quad, origin, quads_, i);
    else if (box) add(*box, origin, boxes_, i);
    else others_.at[others_.count++] = static_cast<std::uint32_t>(i);
  }
}

/// Those of a kind lie one after the other, so that nothing is asked of them one by one.
void Footprints::gather(const Stretch& solids) {
  std::uint32_t* lists[] = {spheres_.at, triangles_.at, quads_.at, boxes_.at, others_.at};
  enum List { spheres, triangles, quads, boxes, others };
  std::size_t counts[std::size(lists)] = {};
  const auto listOf = [&](std::size_t index) {
    return index == Kinds::indexOf<Sphere>()     ? spheres
           : !vectors_                           ? others
           : index == Kinds::indexOf<Triangle>() ? triangles
           : index == Kinds::indexOf<Quad>()     ? quads
           : index == Kinds::indexOf<AABox>()    ? boxes
                                                 : others;
  };
  const auto place = [&](std::size_t i) { return solids.solids.place(solids.first + i); };
  const Solids::Place first = place(0), last = place(solids.count - 1);
  if (first.index == last.index && first.at + solids.count - 1 == last.at) {  // all of one kind
    const List list = listOf(first.index);
    std::iota(lists[list], lists[list] + solids.count, 0);
    counts[list] = solids.count;
  } else {
    std::array<List, std::variant_size_v<Shape>> listOfKind;
    for (std::size_t index = 0; index < listOfKind.size(); ++index) listOfKind[index] = listOf(index);
    for (std::uint32_t i = 0; i < solids.count; ++i) {
      const List list = listOfKind[place(i).index];
      lists[list][counts[list]++] = i;
    }
  }
  const auto fill = [&]<class Solid>(std::type_identity<Solid>, auto& batch, List list) {
    batch.count = counts[list];
    if (batch.count == 0) return;
    const Solid* from = solids.solids.of<Solid>().data() + place(batch.at[0]).at;
    batch.next = reinterpret_cast<const char*>(from + batch.count), batch.stride = sizeof(Solid);
    numbersOf(from, batch.count, silhouette_.origin(), batch, 0);
  };
  fill(std::type_identity<Sphere>(), spheres_, spheres);
  fill(std::type_identity<Triangle>(), triangles_, triangles);
  fill(std::type_identity<Quad>(), quads_, quads);
  fill(std::type_identity<AABox>(), boxes_, boxes);
  others_.count = counts[others];
}

void Footprints::calculate(Finding what) {
  const bool covers = what == Finding::covers;
  if (spheres_.count) {
    farSphere_ |= covers                   ? ofCoveringSpheres(view_, spheres_)
                  : what == Finding::discs ? ofDiscs(view_, spheres_)
                                           : ofSpheres(view_, spheres_);
    if (!covers && spheres_.near) ofCoveringSpheres(view_, spheres_);  // in fp64 all of them, but for the discs
    if (!vectors_) std::fill_n(spheres_.plain, spheres_.count, 0);
  }
  if (triangles_.count) covers ? ofCoveringTriangles(view_, triangles_) : ofTriangles(view_, triangles_);
  if (quads_.count) covers ? ofCoveringQuads(view_, quads_) : ofQuads(view_, quads_);
  if (boxes_.count) ofBoxes(view_, boxes_);
}

/// Pixel i is seen at i + 0.5, so that [a, b] holds centres from ceil(a - 0.5) to floor(b - 0.5).
Footprint Footprints::ask(ShapeRef shape) const {
  const Rectangle r = shape.visit([&](const auto& solid) { return silhouette_.rectangle(solid); });
  const std::int32_t nearest = view_.scale.begins(static_cast<float>(r.nearest * (1 - 1e-6)));
  Footprint f{0, 0, region_.width - 1, region_.height - 1, static_cast<DepthCode>(nearest), DepthScale::none, 0};
  if (r.everywhere) return f;
  // With NaN, max and min in this order are as far as possible.
  const auto from = [](double v) { return std::max(0.0, v); };
  const auto to = [](double last, double v) { return std::min(last, v); };
  if (r.x.from > r.x.to || r.y.from > r.y.to) return {0, 0, -1, -1, 0, DepthScale::none, 0};
  pixels(from(r.x.from - 0.5 - region_.x), to(view_.lastX, r.x.to - 0.5 - region_.x), view_.lastX, f.x0, f.x1);
  pixels(from(r.y.from - 0.5 - region_.y), to(view_.lastY, r.y.to - 0.5 - region_.y), view_.lastY, f.y0, f.y1);
  return f;
}

}  // namespace solidcast
