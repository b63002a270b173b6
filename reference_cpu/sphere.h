// Sphere |p - c| = r. With L = o - c the ray meets it where a t^2 + 2 b t + C = 0, a = d.d, b = L.d, C = L.L - r^2.
//   Outside (C > 0) the discriminant b^2 - a C is written a r^2 - |L x d|^2 (Lagrange's identity): nothing of the size
//   of the distance is subtracted, so far and small spheres keep their outline. Only a ray that approaches (b < 0) hits.
//   Inside (C < 0) b^2 - a C is a sum of positive terms, and the far side is hit.
//   On the surface the roots are 0, which is no hit, and -2 b / a.
// Each root is taken in the form whose denominator or numerator does not cancel.
#pragma once
#include "reference_cpu/primitive.h"

namespace solidcast::reference {

template <class T>
class Sphere final : public Solid<T> {
 public:
  Sphere(const Vec<T>& center, const T& radius) : center_(center), radius_(radius) {}

  Intersection<T> intersect(const Ray<T>& ray, const T& previousBestDistance) const override {
    const Vec<T> L = ray.origin - center_;
    const T b = dot(L, ray.direction);
    const T C = dot(L, L) - radius_ * radius_;
    if (C >= 0 && b >= 0) return Intersection<T>::failure();  // leaving
    const T a = dot(ray.direction, ray.direction);
    T t;
    if (C > 0) {
      const Vec<T> moment = cross(L, ray.direction);
      const T discriminant = a * radius_ * radius_ - dot(moment, moment);
      if (!(discriminant >= 0)) return Intersection<T>::failure();
      t = C / (sqrt(discriminant) - b);
    } else if (C < 0) {
      const T root = sqrt(b * b - a * C);
      t = b > 0 ? -C / (root + b) : (root - b) / a;
    } else {
      t = -2 * b / a;
    }
    if (!this->accepts(t, previousBestDistance)) return Intersection<T>::failure();
    return {t, ray, this, normalized(L + t * ray.direction), ray.getPoint(t)};
  }

  BBox<T> getBounds() const override {
    const Vec<T> r{radius_, radius_, radius_};
    return {center_ - r, center_ + r};
  }

  T getArea() const override { return 4 * pi<T>() * radius_ * radius_; }

  /// Archimedes: height and longitude are uniform.
  Vec<T> sample(const T& u, const T& v) const override {
    const T z = 1 - 2 * u, longitude = 2 * pi<T>() * v;
    const T s = sqrt(greater(T(0), 1 - z * z));
    return center_ + radius_ * Vec<T>{s * cos(longitude), s * sin(longitude), z};
  }

 private:
  Vec<T> center_;
  T radius_;
};

}  // namespace solidcast::reference
