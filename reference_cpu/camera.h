// Cameras: a place (x, y) in the image, each from -1 to 1, x to the right and y up, becomes a ray of unit length.
#pragma once
#include <memory>
#include <variant>

#include "reference_cpu/ray.h"

namespace solidcast::reference {

template <class T>
class Camera {
 public:
  virtual ~Camera() = default;
  virtual Ray<T> getPrimaryRay(const T& x, const T& y) const = 0;

 protected:
  Camera(const Vec<T>& center, const Vec<T>& forward, const Vec<T>& up)
      : center_(center),
        forward_(normalized(forward)),
        right_(normalized(cross(forward_, up))),
        upward_(cross(right_, forward_)) {}

  static T radians(const T& degrees) { return degrees * pi<T>() / 180; }

  Vec<T> center_, forward_, right_, upward_;
};

/// Direction forward + x tan(horizontal / 2) right + y tan(vertical / 2) upward; opening angles in degrees.
template <class T>
class PerspectiveCamera final : public Camera<T> {
 public:
  PerspectiveCamera(const Vec<T>& center, const Vec<T>& forward, const Vec<T>& up, const T& verticalAngle,
                    const T& horizontalAngle)
      : Camera<T>(center, forward, up),
        reachX_(tan(this->radians(horizontalAngle / 2))),
        reachY_(tan(this->radians(verticalAngle / 2))) {}

  Ray<T> getPrimaryRay(const T& x, const T& y) const override {
    return {this->center_, normalized(this->forward_ + x * reachX_ * this->right_ + y * reachY_ * this->upward_)};
  }

 private:
  T reachX_, reachY_;
};

/// Parallel rays along forward, from a rectangle of scaleX by scaleY around the center.
template <class T>
class OrthographicCamera final : public Camera<T> {
 public:
  OrthographicCamera(const Vec<T>& center, const Vec<T>& forward, const Vec<T>& up, const T& scaleX, const T& scaleY)
      : Camera<T>(center, forward, up), scaleX_(scaleX), scaleY_(scaleY) {}

  Ray<T> getPrimaryRay(const T& x, const T& y) const override {
    return {this->center_ + x * scaleX_ / 2 * this->right_ + y * scaleY_ / 2 * this->upward_, this->forward_};
  }

 private:
  T scaleX_, scaleY_;
};

/// Longitude x horizontal / 2 to the right of forward, latitude y vertical / 2; opening angles in degrees.
template <class T>
class EnvironmentCamera final : public Camera<T> {
 public:
  EnvironmentCamera(const Vec<T>& center, const Vec<T>& forward, const Vec<T>& up, const T& verticalAngle,
                    const T& horizontalAngle)
      : Camera<T>(center, forward, up),
        halfHorizontal_(this->radians(horizontalAngle / 2)),
        halfVertical_(this->radians(verticalAngle / 2)) {}

  Ray<T> getPrimaryRay(const T& x, const T& y) const override {
    const T longitude = x * halfHorizontal_, latitude = y * halfVertical_;
    const Vec<T> level = cos(longitude) * this->forward_ + sin(longitude) * this->right_;
    return {this->center_, normalized(cos(latitude) * level + sin(latitude) * this->upward_)};
  }

 private:
  T halfHorizontal_, halfVertical_;
};

}  // namespace solidcast::reference
