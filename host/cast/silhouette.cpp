#include "host/cast/silhouette.h"

namespace solidcast {

Silhouette::Silhouette(const Scene& scene, int width, int height, int samples)
    : middleX_(width / 2.0),
      middleY_(height / 2.0),
      slack_(samples > 1 ? 0.501 : 1e-3),
      kind_(static_cast<CameraKind>(scene.camera.index())) {
  const EyeFrame eye = eyeFrame(scene, RealType::f64);
  for (int k = 0; k < 3; ++k) {
    auto at = static_cast<std::size_t>(k);
    origin_[at] = static_cast<double>(eye.origin[k]);
    axes_[0][at] = static_cast<double>(eye.right[k]);
    axes_[1][at] = static_cast<double>(-eye.upward[k]);
    axes_[2][at] = static_cast<double>(-eye.backward[k]);
  }
  const auto [stepX, stepY] = pixelSteps(scene.camera, width, height);
  perX_ = static_cast<double>(1 / stepX), perY_ = static_cast<double>(1 / stepY);
  wide_ = kind_ == CameraKind::perspective && std::max(middleX_ / perX_, middleY_ / perY_) > 1e4;
}

Rectangle Silhouette::onGlobe(const P3& c, double radius) const {
  const double distance = std::sqrt(c.x * c.x + c.y * c.y + c.depth * c.depth);
  if (distance <= radius * 1.001) return all();
  const double size = std::asin(radius / distance) + 1e-9;
  const double latitude = std::asin(std::clamp(c.y / distance, -1.0, 1.0)), longitude = std::atan2(c.x, c.depth);
  Rectangle r{{-infinite, infinite}, {latitude - size, latitude + size}, false, 0};
  const double wide = std::sin(size) / std::cos(latitude);  // the cap's half width, unless it holds a pole
  if (std::abs(latitude) + size >= M_PI / 2 || wide >= 1) return r;
  const double half = std::asin(wide) + 1e-9;
  // Over the seam behind the eye it is at both ends of the image.
  if (longitude - half >= -M_PI && longitude + half <= M_PI) r.x = {longitude - half, longitude + half};
  return r;
}

}  // namespace solidcast
