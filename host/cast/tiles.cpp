#include "host/cast/tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include "host/cast/second_pass.h"
#include "host/cast/solids/all.h"

namespace solidcast {
namespace {

enum class CameraKind { perspective, orthographic, environment };  // as in Camera

constexpr double infinite = std::numeric_limits<double>::infinity();

struct Interval {
  double from = infinite, to = -infinite;
  void add(double v) { from = std::min(from, v), to = std::max(to, v); }
  bool empty() const { return from > to; }
};

/// Where a solid can be seen, in pixels of the whole image (x to the right, y down).
struct Rectangle {
  Interval x, y;
  bool everywhere = false;
};

struct P3 {
  double x, y, z;  // camera axes, z backward
};

/// Camera of a scene in fp64: what of the screen a point or ball can cover.
class Projector {
 public:
  Projector(const Scene& scene, int width, int height) : width_(width), height_(height) {
    EyeFrame eye = eyeFrame(scene, RealType::f64);
    for (int k = 0; k < 3; ++k) {
      auto at = static_cast<std::size_t>(k);
      origin_[at] = static_cast<double>(eye.origin[k]);
      axes_[0][at] = static_cast<double>(eye.right[k]);
      axes_[1][at] = static_cast<double>(eye.upward[k]);
      axes_[2][at] = static_cast<double>(eye.backward[k]);
    }
    auto [stepX, stepY] = pixelSteps(scene.camera, width, height);
    stepX_ = static_cast<double>(stepX), stepY_ = static_cast<double>(stepY);
    kind_ = static_cast<CameraKind>(scene.camera.index());
  }

  template <class Solid>
  Rectangle rectangle(const Solid& solid) const {
    Rectangle r;
    Outline corners = outline(solid);
    if (corners.count > 0 && kind_ != CameraKind::environment) {
      int behind = 0;
      for (int i = 0; i < corners.count; ++i) {
        P3 p = toCamera(corners.points[static_cast<std::size_t>(i)]);
        if (kind_ == CameraKind::orthographic) {
          r.x.add(p.x / stepX_), r.y.add(-p.y / stepY_);
        } else if (p.z < 0) {
          r.x.add(p.x / -p.z / stepX_), r.y.add(p.y / p.z / stepY_);
        } else {
          ++behind;
        }
      }
      if (behind == corners.count) return {};  // in front of the eye there is nothing of it
      r.everywhere = behind > 0;
    } else {
      Ball b = ball(solid);
      if (b.radius < 0) {
        r.everywhere = true;
        return r;
      }
      r = ofBall(toCamera(b.center), b.radius);
    }
    return widened(r);
  }

 private:
  P3 toCamera(const Triple& p) const {
    Triple f{p[0] - origin_[0], p[1] - origin_[1], p[2] - origin_[2]};
    double v[3];
    for (int i = 0; i < 3; ++i) v[i] = axes_[i][0] * f[0] + axes_[i][1] * f[1] + axes_[i][2] * f[2];
    return {v[0], v[1], v[2]};
  }

  /// Slopes of the two tangents from the eye to a circle with centre (across, depth): the zeros of
  /// (across - s depth)^2 = r^2 (1 + s^2).
  static Interval tangents(double across, double depth, double r) {
    double a = depth * depth - r * r, q = across * across + a;
    double h = r * std::sqrt(std::max(q, 0.0)), middle = across * depth;
    return {(middle - h) / a, (middle + h) / a};
  }

  Rectangle ofBall(P3 c, double radius) const {
    Rectangle r;
    double depth = -c.z, big = radius * (1 + 1e-9) + 1e-12 * (std::abs(c.x) + std::abs(c.y) + std::abs(c.z));
    switch (kind_) {
      case CameraKind::orthographic:
        r.x = {(c.x - big) / stepX_, (c.x + big) / stepX_};
        r.y = {(-c.y - big) / stepY_, (-c.y + big) / stepY_};
        return r;
      case CameraKind::environment: {
        double distance = std::sqrt(c.x * c.x + c.y * c.y + c.z * c.z);
        if (distance <= big * 1.001) break;
        double size = std::asin(big / distance) + 1e-9;
        double lat = std::asin(std::clamp(c.y / distance, -1.0, 1.0)), lon = std::atan2(c.x, depth);
        r.y = {-(lat + size) / stepY_, -(lat - size) / stepY_};
        double wide = std::sin(size) / std::cos(lat);  // the cap's half width in longitude, unless it holds a pole
        if (std::abs(lat) + size >= M_PI / 2 || wide >= 1) {
          r.x = {-infinite, infinite};
        } else {
          double half = std::asin(wide) + 1e-9;
          r.x = {(lon - half) / stepX_, (lon + half) / stepX_};
          // Over the seam behind the eye: both ends of the image.
          if (lon - half < -M_PI || lon + half > M_PI) r.x = {-infinite, infinite};
        }
        return r;
      }
      case CameraKind::perspective:
        if (depth <= -big) return r;       // behind
        if (depth <= big * 1.0001) break;  // reaches the plane of the eye
        Interval x = tangents(c.x, depth, big), y = tangents(-c.y, depth, big);
        r.x = {x.from / stepX_, x.to / stepX_};
        r.y = {y.from / stepY_, y.to / stepY_};
        return r;
    }
    r.everywhere = true;
    return r;
  }

  /// From the image's middle to its corner, and by more than fp64 can have lost: tiles cost nothing by comparison.
  Rectangle widened(Rectangle r) const {
    if (r.everywhere || r.x.empty()) return r;
    auto widen = [](Interval& i, double middle) {
      double slack = 1e-3 + 1e-9 * (std::abs(i.from) + std::abs(i.to));
      i.from += middle - slack, i.to += middle + slack;
    };
    widen(r.x, width_ / 2.0);
    widen(r.y, height_ / 2.0);
    return r;
  }

  double width_, height_, stepX_, stepY_;
  CameraKind kind_;
  Triple origin_;
  Triple axes_[3];
};

/// Tiles of a grid that a rectangle touches; empty where to < from.
struct Tiles {
  std::int32_t fromX = 0, toX = -1, fromY = 0, toY = -1;
  bool everywhere = false;
};

Tiles touched(const Rectangle& r, const TileGrid& grid) {
  if (r.everywhere) return {0, -1, 0, -1, true};
  if (r.x.empty() || r.y.empty()) return {};
  auto tile = [](double pixel, int first, int size, int tiles) {
    double t = std::floor((pixel - first) / size);
    return static_cast<std::int32_t>(std::clamp(t, -1.0, static_cast<double>(tiles)));
  };
  // Pixel i is seen at i + 0.5: an interval [a, b] holds centres from ceil(a - 0.5) to floor(b - 0.5).
  Tiles t;
  double x0 = std::ceil(r.x.from - 0.5), x1 = std::floor(r.x.to - 0.5);
  double y0 = std::ceil(r.y.from - 0.5), y1 = std::floor(r.y.to - 0.5);
  if (x1 < x0 || y1 < y0) return {};  // between the centres
  t.fromX = std::max(0, tile(x0, grid.region.x, grid.tileWidth, grid.across()));
  t.toX = std::min(grid.across() - 1, tile(x1, grid.region.x, grid.tileWidth, grid.across()));
  t.fromY = std::max(0, tile(y0, grid.region.y, grid.tileHeight, grid.down()));
  t.toY = std::min(grid.down() - 1, tile(y1, grid.region.y, grid.tileHeight, grid.down()));
  if (t.toX < t.fromX || t.toY < t.fromY) return {};
  std::int64_t all = std::int64_t{grid.across()} * grid.down();
  std::int64_t covered = std::int64_t{t.toX - t.fromX + 1} * (t.toY - t.fromY + 1);
  t.everywhere = covered > 64 && covered * 4 > all;
  return t;
}

}  // namespace

TileLists tileLists(const Scene& scene, int width, int height, int samples, const TileGrid& grid) {
  Projector projector(scene, width, height);
  const auto& solids = scene.world.solids;
  std::vector<Tiles> tiles(solids.size());
  inParallel(solids.size(), [&](std::size_t i) {
    Rectangle r = std::visit([&](const auto& s) { return projector.rectangle(s); }, solids[i].shape);
    if (samples > 1 && !r.everywhere && !r.x.empty()) {  // samples lie up to half a pixel off the centre
      r.x.from -= 0.5, r.x.to += 0.5, r.y.from -= 0.5, r.y.to += 0.5;
    }
    tiles[i] = touched(r, grid);
  });

  TileLists lists;
  std::size_t across = static_cast<std::size_t>(grid.across()), count = across * static_cast<std::size_t>(grid.down());
  lists.first.assign(count + 1, 0);
  auto forEachTile = [&](const Tiles& t, const auto& f) {
    for (std::int32_t y = t.fromY; y <= t.toY; ++y)
      for (std::int32_t x = t.fromX; x <= t.toX; ++x)
        f(static_cast<std::size_t>(y) * across + static_cast<std::size_t>(x));
  };
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    if (tiles[i].everywhere) {
      lists.everywhere.push_back(static_cast<std::uint32_t>(i));
    } else {
      forEachTile(tiles[i], [&](std::size_t tile) { ++lists.first[tile + 1]; });
    }
  }
  for (std::size_t tile = 0; tile < count; ++tile) lists.first[tile + 1] += lists.first[tile];
  lists.solids.resize(lists.first[count]);
  std::vector<std::uint32_t> next(lists.first.begin(), lists.first.end() - 1);
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (!tiles[i].everywhere)
      forEachTile(tiles[i], [&](std::size_t tile) { lists.solids[next[tile]++] = static_cast<std::uint32_t>(i); });
  return lists;
}

std::optional<TiledRecords> tiledRecords(const TileLists& lists, const TileGrid& grid, const Records& search,
                                         std::size_t limit) {
  std::size_t rows = 0, entries = 0;
  for (std::size_t k = 0; k < kindCount; ++k) rows += std::size_t{search.count[k]} * search.rowsPer[k];
  if (rows == 0) return std::nullopt;
  const std::size_t rowBytes = search.bytes.size() / rows, tiles = lists.first.size() - 1;
  auto bytesOf = [&](std::uint32_t solid) {
    std::uint32_t kind = search.places[solid][0];
    return kind < kindCount ? search.rowsPer[kind] * rowBytes : 0;
  };
  for (std::uint32_t solid : lists.solids) entries += bytesOf(solid);
  for (std::uint32_t solid : lists.everywhere) entries += bytesOf(solid) * tiles;
  if (entries > limit) return std::nullopt;

  TiledRecords tiled;
  tiled.bytes.reserve(entries);
  std::array<std::vector<std::uint32_t>, kindCount> byKind;  // first rows of a tile's solids
  for (std::size_t tile = 0; tile < tiles; ++tile) {
    for (auto& list : byKind) list.clear();
    auto add = [&](std::uint32_t solid) {
      auto [kind, row] = search.places[solid];
      if (kind < kindCount) byKind[kind].push_back(row);
    };
    for (std::uint32_t solid : lists.everywhere) add(solid);
    for (std::size_t i = lists.first[tile]; i < lists.first[tile + 1]; ++i) add(lists.solids[i]);
    Records here;
    here.rowsPer = search.rowsPer;
    for (std::size_t k = 0; k < kindCount; ++k) {
      here.count[k] = static_cast<std::uint32_t>(byKind[k].size());
      here.firstRow[k] = static_cast<std::uint32_t>(tiled.bytes.size() / rowBytes);
      for (std::uint32_t row : byKind[k]) {
        auto from = search.bytes.begin() + static_cast<std::ptrdiff_t>(row * rowBytes);
        tiled.bytes.insert(tiled.bytes.end(), from, from + static_cast<std::ptrdiff_t>(search.rowsPer[k] * rowBytes));
      }
    }
    auto across = static_cast<std::size_t>(grid.across());
    tiled.tiles.push_back({static_cast<int>(tile % across) * grid.tileWidth,
                           static_cast<int>(tile / across) * grid.tileHeight, portions(here)});
  }
  return tiled;
}

}  // namespace solidcast
