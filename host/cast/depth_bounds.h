// What certainly hides what. By pixel a depth (along the camera's forward axis) before which the ray through the pixel's
// centre has hit something; a tile's solids that begin beyond the deepest of its pixels need not be listed. In a crowd
// nearly all solids go this way, before their records are made.
//
// Only what is certain counts: centres that lie inside a solid's projection by more than all rounding, that of `fast` in
// the shader included, and solids that are behind by more than a near tie. Hence no ray's answer, and no doubt of
// exact's about it, hangs on a solid that is left out.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "host/cast/silhouette.h"

namespace solidcast {

class DepthBounds {
 public:
  /// Pixels of the region, and padding up to stride x rows, which bounds nothing.
  void start(const Silhouette& silhouette, const Crop& region, int stride, int rows, RealType type) {
    silhouette_ = &silhouette;
    region_ = region;
    stride_ = static_cast<std::size_t>(stride);
    const double finest = std::max(silhouette.pixelsPerSlopeX(), silhouette.pixelsPerSlopeY());
    margin_ = 1e-3 + (type == RealType::f32 ? 4e-6 : 1e-12) * finest;
    lost_ = type == RealType::f32 ? 0x1p-17 : 0x1p-40;
    depth_.resize(stride_ * static_cast<std::size_t>(rows));
    std::fill(depth_.begin(), depth_.end(), 0.f);
    for (int y = 0; y < region.height; ++y)
      std::fill_n(depth_.begin() + static_cast<std::ptrdiff_t>(y * stride_), region.width,
                  std::numeric_limits<float>::infinity());
  }
  const float* row(std::size_t y) const { return depth_.data() + y * stride_; }

  /// Whether the solid seen in this rectangle is, in its middle, behind what is known already: its own depths are hardly
  /// worth the work.
  bool hidden(const Rectangle& r) const {
    const double x = (r.x.from + r.x.to) * 0.5 - region_.x, y = (r.y.from + r.y.to) * 0.5 - region_.y;
    if (!(x >= 0 && y >= 0 && x < region_.width && y < region_.height)) return false;
    return depth_[static_cast<std::size_t>(y) * stride_ + static_cast<std::size_t>(x)] <= r.nearest;
  }

  template <class Solid>
  void add(const Solid&) {}

  /// A disc through the centre, parallel to the image, is a circle there.
  void add(const Sphere& sphere) {
    const auto c = silhouette_->fromEye(sphere.center);
    const double square = c.x * c.x + c.y * c.y + c.depth * c.depth, all = sphere.radius * sphere.radius;
    // Of the squared radius, what the shader's rounding cannot take; from 16 radii on it has the form for far spheres.
    const double held = all - lost_ * std::sqrt(square * std::min(square, 256 * all));
    if (!(held > 0 && c.depth > 0 && square > all * 1.001)) return;
    const double slope = 1 / c.depth, r = std::sqrt(held) * slope;
    const double x = silhouette_->pixelX(c.x * slope) - region_.x, y = silhouette_->pixelY(c.y * slope) - region_.y;
    const double wide = r * silhouette_->pixelsPerSlopeX() - margin_,
                 high = r * silhouette_->pixelsPerSlopeY() - margin_;
    if (!(wide > 0 && high > 0)) return;
    const double each = 1 / high;
    fill(y - high, y + high, bound(c.depth), [&](double middle, double& from, double& to) {
      const double down = (middle - y) * each, half = wide * std::sqrt(std::max(0.0, 1 - down * down));
      from = x - half, to = x + half;
    });
  }

 private:
  static float bound(double depth) { return static_cast<float>(depth * (1 + 1e-6)); }

  /// Pixels whose centres lie between `span` of their row, of rows from top to bottom.
  void fill(double top, double bottom, float depth, const auto& span) {
    const int first = atLeast(top, 0), last = atMost(bottom, region_.height - 1);
    for (int y = first; y <= last; ++y) {
      double from, to;
      span(y + 0.5, from, to);
      const int x1 = atMost(to, region_.width - 1);
      float* at = depth_.data() + static_cast<std::size_t>(y) * stride_;
      for (int x = atLeast(from, 0); x <= x1; ++x) at[x] = std::min(at[x], depth);
    }
  }
  /// The first pixel whose centre is at `v` or beyond, and the last one not beyond.
  static int atLeast(double v, int least) {
    v = std::max(double(least), v - 0.5);
    const int i = static_cast<int>(std::min(v, 1e9));
    return i + (i < v);
  }
  static int atMost(double v, int most) {
    v = std::min(double(most), v - 0.5);
    return v < 0 ? -1 : static_cast<int>(v);
  }

  const Silhouette* silhouette_ = nullptr;
  Crop region_;
  std::size_t stride_ = 0;
  double margin_ = 0;  // in pixels
  double lost_ = 0;    // of a sphere's q, relative to its terms: what the shader's rounding can take
  std::vector<float> depth_;
};

}  // namespace solidcast
