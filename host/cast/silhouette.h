// Where a solid can be seen: the rectangle of the screen that its silhouette lies in. Conservative: a pixel whose ray
// meets the solid is never outside.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "host/cast/bounds.h"
#include "host/cast/records.h"
#include "host/cast/solids/all.h"
#include "host/image/band.h"
#include "host/scene/world.h"

namespace solidcast {

struct Interval {
  double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();
  void add(double v) { from = std::min(from, v), to = std::max(to, v); }
  bool empty() const { return from > to; }
};

/// In pixels of the whole image, x to the right, y down; pixel i has its centre at i + 0.5.
struct Rectangle {
  Interval x, y;
  bool everywhere = false;
  double nearest = 0;  // depth along the camera's forward axis before which nothing of it is; perspective only
};

/// A scene's camera in fp64. All that fp64 loses is far below the thousandth of a pixel that rectangles are widened by.
class Silhouette {
 public:
  /// `samples` per pixel and axis: they lie up to half a pixel off the centre.
  Silhouette(const Scene& scene, int width, int height, int samples);

  Rectangle rectangle(const Quadric& quadric) const {
    const auto bounds = quickBounds(quadric);
    return bounds ? rectangle(AABox{bounds->lo, bounds->hi}) : all();
  }
  template <class Solid>
  Rectangle rectangle(const Solid& solid) const {
    const auto corners = outline(solid, origin_);
    if (corners.size() > 0 && kind_ != CameraKind::environment) return widened(ofCorners(corners));
    const Ball b = ball(solid);
    if (b.radius < 0 || wide_) return all();
    return widened(ofBall(toCamera(difference(b.center, origin_)), b.radius));
  }

  struct P3 {
    double x, y, depth;  // camera axes, y down
  };
  P3 toCamera(const Triple& p) const {
    return {axes_[0][0] * p[0] + axes_[0][1] * p[1] + axes_[0][2] * p[2],
            axes_[1][0] * p[0] + axes_[1][1] * p[1] + axes_[1][2] * p[2],
            axes_[2][0] * p[0] + axes_[2][1] * p[1] + axes_[2][2] * p[2]};
  }
  /// A point from the eye, and where the image has a slope x/depth or y/depth: in pixels. For perspective cameras.
  P3 fromEye(const Triple& p) const { return toCamera(difference(p, origin_)); }
  double pixelX(double slope) const { return slope * perX_ + middleX_; }
  double pixelY(double slope) const { return slope * perY_ + middleY_; }
  double pixelsPerSlopeX() const { return perX_; }
  double pixelsPerSlopeY() const { return perY_; }
  /// Rays go through the centres of pixels alone, of a perspective camera of ordinary angles.
  bool centresAlone() const { return kind_ == CameraKind::perspective && !wide_ && slack_ < 0.5; }
  static bool inFront(const P3& p) { return p.depth > flat * size(p); }
  /// What is wholly in front of the eye is seen where its slopes say.
  bool slopesAreEnough() const { return kind_ == CameraKind::perspective && !wide_; }
  struct PixelsOfSlopes {
    double perX, perY, middleX, middleY, slack;
  };
  PixelsOfSlopes pixelsOfSlopes() const { return {perX_, perY_, middleX_, middleY_, slack_}; }
  const Triple& origin() const { return origin_; }
  const Triple (&axes() const)[3] { return axes_; }

 private:
  enum class CameraKind { perspective, orthographic, environment };  // as in Camera
  static Rectangle all() { return {{}, {}, true, 0}; }
  static constexpr double infinite = std::numeric_limits<double>::infinity();
  /// Directions this close to the plane of the eye count as in it.
  static constexpr double flat = 1e-6;

  template <class Corners>
  Rectangle ofCorners(const Corners& corners) const {
    Rectangle r;
    P3 p[std::tuple_size_v<Corners> + 1];
    std::size_t behind = 0;
    r.nearest = infinite;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      p[i] = toCamera(corners[i]);
      r.nearest = std::min(r.nearest, p[i].depth);
      if (kind_ == CameraKind::orthographic) {
        r.x.add(p[i].x), r.y.add(p[i].y);
      } else if (inFront(p[i])) {
        const double inverse = 1 / p[i].depth;
        r.x.add(p[i].x * inverse), r.y.add(p[i].y * inverse);
      } else {
        ++behind;
      }
    }
    if (behind == 0) return r;
    r.nearest = 0;
    if (wide_) return all();
    if (behind == corners.size()) return {};
    // An edge that passes the plane of the eye goes to infinity on the side where it does.
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (std::size_t k = 0; k < corners.size(); ++k) {
        if (!inFront(p[i]) || inFront(p[k])) continue;
        const double part = p[i].depth / (p[i].depth - p[k].depth), doubt = flat * (size(p[i]) + size(p[k]));
        towards(r.x, p[i].x + (p[k].x - p[i].x) * part, doubt);
        towards(r.y, p[i].y + (p[k].y - p[i].y) * part, doubt);
      }
    return r;
  }
  static double size(const P3& p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.depth); }
  static void towards(Interval& i, double where, double doubt) {
    if (where >= -doubt) i.to = infinite;
    if (where <= doubt) i.from = -infinite;
  }

  /// Slopes across/depth of the rays from the eye that meet a circle: between its tangents, as far as they are in front.
  static Interval slopes(double across, double depth, double r) {
    const double squared = across * across + depth * depth, q = squared - r * r;
    if (q <= flat * squared) return {-infinite, infinite};
    const double h = std::sqrt(q), least = flat * squared;
    const double lowDepth = depth * h + across * r, highDepth = depth * h - across * r;
    if (lowDepth <= least && highDepth <= least) return {};
    return {lowDepth > least ? (across * h - depth * r) / lowDepth : -infinite,
            highDepth > least ? (across * h + depth * r) / highDepth : infinite};
  }

  Rectangle ofBall(const P3& c, double radius) const {
    const double big = radius * (1 + 1e-9) + 1e-12 * size(c);
    if (kind_ == CameraKind::perspective) {
      if (c.depth <= -big) return {};
      return {slopes(c.x, c.depth, big), slopes(c.y, c.depth, big), false, std::max(0.0, c.depth - big)};
    }
    if (kind_ == CameraKind::orthographic) return {{c.x - big, c.x + big}, {c.y - big, c.y + big}, false, 0};
    return onGlobe(c, big);
  }
  Rectangle onGlobe(const P3& c, double radius) const;  // of an environment camera: longitude, latitude

  Rectangle widened(Rectangle r) const {
    if (r.everywhere || r.x.empty() || r.y.empty()) return r;
    const auto widen = [&](Interval& i, double pixels, double middle) {
      i.from *= pixels, i.to *= pixels;
      i.from += middle - slack_ - 2e-9 * std::abs(i.from);
      i.to += middle + slack_ + 2e-9 * std::abs(i.to);
    };
    widen(r.x, perX_, middleX_);
    widen(r.y, perY_, middleY_);
    return r;
  }

  double perX_, perY_;  // pixels a unit of slope, length or angle
  double middleX_, middleY_, slack_;
  bool wide_;  // so wide an angle that `flat` would show
  CameraKind kind_;
  Triple origin_;
  Triple axes_[3];
};

}  // namespace solidcast
