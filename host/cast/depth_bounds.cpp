#include "host/cast/depth_bounds.h"

#include <cstring>
#include <limits>

namespace solidcast {
namespace {

// Branches on what differs from solid to solid are mispredicted half of the time, hence small vectors and selections.
using Pair = double __attribute__((vector_size(16)));  // of a row: where a span begins, and minus where it ends
using Four = float __attribute__((vector_size(16)));
using FourPlaces = std::int32_t __attribute__((vector_size(16)));

/// Spans up to this width are lowered in the same number of vectors in every row of a solid.
constexpr int fixedSpan = 64;

double most(double a, double b) { return a > b ? a : b; }
double least(double a, double b) { return a < b ? a : b; }

/// Pixels from `first` up to, not including, `end` whose centres lie between; one exactly on the rim may be missing.
struct Centres {
  int first, end;
  Centres(double from, double to, double all)
      : first(static_cast<int>(least(all, most(0, from + 0.5)))),
        end(static_cast<int>(least(all, most(0, to + 0.5)))) {}
};

/// A depth that is certainly not before the very one.
float bound(double depth, double error) { return static_cast<float>(depth * (1 + 1e-6 + error)); }

}  // namespace

void DepthBounds::start(const Silhouette& silhouette, const Crop& region, int stride, int rows, RealType type,
                        bool layered) {
  silhouette_ = &silhouette;
  region_ = region;
  stride_ = static_cast<std::size_t>(stride);
  const auto pixels = silhouette.pixelsOfSlopes();
  const double finest = std::max(pixels.perX, pixels.perY);
  const double x = pixels.middleX / pixels.perX, y = pixels.middleY / pixels.perY;
  const double steep = 1 + x * x + y * y;
  steepest_ = std::sqrt(steep);
  margin_ = 1e-3 + (type == RealType::f32 ? 4e-6 : 1e-12) * steep * finest;
  lost_ = type == RealType::f32 ? 0x1p-17 : 0x1p-40;
  rounding_ = 8 * unitRoundoff(type);
  layered_ = layered;
  deepest2_.clear();
  work_ = 0;
  most_ = 8.0 * region.width * region.height;
  depth_.resize(stride_ * static_cast<std::size_t>(rows) + fixedSpan + 8);  // what fill() touches beyond a row's end
  std::fill(depth_.begin(), depth_.end(), 0.f);
  for (int y0 = 0; y0 < region.height; ++y0)
    std::fill_n(depth_.begin() + static_cast<std::ptrdiff_t>(stride_) * y0, region.width,
                std::numeric_limits<float>::infinity());
}

/// Pixels whose centres lie within span(y), a Pair, of rows from top to bottom; none is wider than `widest`.
void DepthBounds::fill(double top, double bottom, int widest, float depth, const auto& span) {
  const Centres rows(top, bottom, region_.height);
  const double width = region_.width;
  float* row = depth_.data() + static_cast<std::size_t>(rows.first) * stride_;
  work_ += double(widest) * (rows.end - rows.first);
  const Four all{depth, depth, depth, depth};
  for (int y = rows.first; y < rows.end; ++y, row += stride_) {
    const Pair ends = span(y + 0.5);
    const Centres x(ends[0], -ends[1], width);
    const int base = x.first & ~3, end = widest <= fixedSpan ? base + widest + 3 : x.end;
    FourPlaces place = base + FourPlaces{0, 1, 2, 3};
    for (int k = base; k < end; k += 4, place += 4) {  // the padding and the next row keep what they have
      Four now;
      std::memcpy(&now, row + k, sizeof now);
      const FourPlaces lower = (place >= x.first) & (place < x.end) & (all < now);
      now = lower ? all : now;
      std::memcpy(row + k, &now, sizeof now);
    }
  }
}

void DepthBounds::noteTiles() {
  if (!layered_) return;
  static_assert(side == 4);
  const std::size_t across = stride_ / side, down = (depth_.size() / stride_) / side;
  std::vector<float> deepest(stride_), tiles(across * down);
  for (std::size_t y = 0; y < down; ++y) {
    std::copy_n(row(y * side), stride_, deepest.data());
    for (std::size_t k = 1; k < side; ++k) {
      const float* other = row(y * side + k);
      for (std::size_t x = 0; x < stride_; ++x) deepest[x] = deepest[x] < other[x] ? other[x] : deepest[x];
    }
    for (std::size_t x = 0; x < across; ++x) {
      const float* of = deepest.data() + x * side;
      tiles[y * across + x] = std::max(std::max(of[0], of[1]), std::max(of[2], of[3]));
    }
  }
  // Of each tile and its neighbours to the right and below, at a distance of `step`; there are none beyond the last.
  const auto widened = [&](const std::vector<float>& of, std::size_t step) {
    std::vector<float> to(of.size());
    for (std::size_t y = 0; y < down; ++y)
      for (std::size_t x = 0; x < across; ++x) {
        const std::size_t right = std::min(x + step, across - 1), below = std::min(y + step, down - 1);
        to[y * across + x] = std::max(std::max(of[y * across + x], of[y * across + right]),
                                      std::max(of[below * across + x], of[below * across + right]));
      }
    return to;
  };
  deepest2_ = widened(tiles, 1);
  deepest4_ = widened(deepest2_, 2);
}

bool DepthBounds::hides(const Footprint& f) const {
  if (!layered_ || f.x1 - f.x0 > 5 || f.y1 - f.y0 > 5 || *middle(f) >= f.nearest) return false;
  const Four nearest{f.nearest, f.nearest, f.nearest, f.nearest};
  for (int y = f.y0; y <= f.y1; ++y) {
    const float* at = row(static_cast<std::size_t>(y));
    const int base = f.x0 & ~3;
    FourPlaces place = base + FourPlaces{0, 1, 2, 3}, seen{0, 0, 0, 0};
    for (int k = base; k <= f.x1; k += 4, place += 4) {
      Four now;
      std::memcpy(&now, at + k, sizeof now);
      seen |= (place >= f.x0) & (place <= f.x1) & (now >= nearest);
    }
    if (seen[0] | seen[1] | seen[2] | seen[3]) return false;
  }
  return true;
}

/// A disc through the centre, parallel to the image, is a circle there.
void DepthBounds::add(const Sphere& sphere) {
  const auto c = silhouette_->fromEye(sphere.center);
  const double square = c.x * c.x + c.y * c.y + c.depth * c.depth, all = sphere.radius * sphere.radius;
  // Of the squared radius, what the shader's rounding cannot take; from 16 radii on it has the form for far spheres.
  const double held = all - lost_ * std::sqrt(square * std::min(square, 256 * all));
  if (!(held > 0 && c.depth > 0 && square > all * 1.001)) return;
  const double slope = 1 / c.depth, r = std::sqrt(held) * slope;
  const double x = silhouette_->pixelX(c.x * slope) - region_.x, y = silhouette_->pixelY(c.y * slope) - region_.y;
  const double wide = r * silhouette_->pixelsPerSlopeX() - margin_, high = r * silhouette_->pixelsPerSlopeY() - margin_;
  if (!(wide > 0 && high > 0)) return;
  const double each = 1 / high;
  fill(y - high, y + high, static_cast<int>(std::min(2 * wide, 1e6)) + 1, bound(c.depth, 0),
       [&, middle = Pair{x, -x}](double row) {
         const double down = (row - y) * each;
         return middle - wide * std::sqrt(most(0, 1 - down * down));
       });
}

bool DepthBounds::corner(const Triple& fromEye, Corner& to) const {
  const auto p = silhouette_->toCamera(fromEye);
  if (!Silhouette::inFront(p)) return false;
  const double inverse = 1 / p.depth;
  to = {silhouette_->pixelX(p.x * inverse) - region_.x, silhouette_->pixelY(p.y * inverse) - region_.y, p.depth};
  return true;
}

/// The polygon's own plane is nowhere farther than its farthest corner. `normal` is of any length, `point` in the plane,
/// from the eye.
template <std::size_t CORNERS>
void DepthBounds::polygon(const std::array<Corner, CORNERS>& corners, const Triple& normal, const Triple& point) {
  double top = corners[0].y, bottom = top, left = corners[0].x, right = left, far = corners[0].depth;
  for (std::size_t i = 1; i < CORNERS; ++i) {
    const Corner& c = corners[i];
    top = std::min(top, c.y), bottom = std::max(bottom, c.y), left = std::min(left, c.x), right = std::max(right, c.x);
    far = std::max(far, c.depth);
  }
  // Most triangles of a fine mesh hold no centre.
  if (!(bottom - top > 2 * margin_ && right - left > 2 * margin_)) return;
  const double across = std::sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
  const double plane = std::abs(normal[0] * point[0] + normal[1] * point[1] + normal[2] * point[2]);
  const double error = rounding_ * far * steepest_ * across / plane;
  if (!(error < 1e-3)) return;

  // An edge bounds x in each row, on the left or on the right; on the other side, by `none`, it does not.
  constexpr double none = 1e300;
  struct Edge {
    Pair at, slope;
  } edges[CORNERS];
  double turn = 0;
  for (std::size_t i = 0; i < CORNERS; ++i) {
    const Corner &p = corners[i], &q = corners[(i + 1) % CORNERS];
    turn += p.x * q.y - q.x * p.y;
  }
  std::size_t count = 0;
  for (std::size_t i = 0; i < CORNERS; ++i) {
    const Corner &p = corners[i], &q = corners[(i + 1) % CORNERS];
    const double down = q.y - p.y, along = q.x - p.x;
    if (std::abs(down) <= 1e-7 * std::abs(along)) continue;  // as good as level: top or bottom bounds it
    const double slope = along / down;
    const bool isLeft = (down < 0) == (turn > 0);
    const double shift = margin_ * (1 + std::abs(slope));
    const double x = p.x - slope * p.y;
    edges[count++] = Edge{isLeft ? Pair{x + shift, -none} : Pair{-none, shift - x}, Pair{slope, -slope}};
  }
  fill(top + 2 * margin_, bottom - 2 * margin_, static_cast<int>(std::min(right - left, 1e6)) + 1, bound(far, error),
       [&, box = Pair{left, -right}](double row) {
         Pair ends = box;
         for (std::size_t i = 0; i < count; ++i) {
           const Pair edge = edges[i].at + edges[i].slope * row;
           ends = edge > ends ? edge : ends;
         }
         return ends;
       });
}

namespace {
Triple crossProduct(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
}  // namespace

void DepthBounds::add(const Triangle& triangle) {
  const auto p = outline(triangle, silhouette_->origin());
  std::array<Corner, 3> corners;
  for (std::size_t i = 0; i < 3; ++i)
    if (!corner(p[i], corners[i])) return;
  polygon(corners, crossProduct(difference(p[1], p[0]), difference(p[2], p[0])), p[0]);
}

void DepthBounds::add(const Quad& quad) {
  const auto p = outline(quad, silhouette_->origin());
  std::array<Corner, 4> corners;
  for (std::size_t i = 0; i < 4; ++i)
    if (!corner(p[i ^ i >> 1], corners[i])) return;  // around, not by rows
  polygon(corners, crossProduct(quad.span1, quad.span2), p[0]);
}

}  // namespace solidcast
