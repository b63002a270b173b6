// Disc: the plane's hit, kept when it is at most a radius from the center; the rim belongs to the disc.
#pragma once
#include "reference_cpu/primitive.h"

namespace solidcast::reference {

template <class T>
class Disc final : public Solid<T> {
 public:
  /// Normal of any length.
  Disc(const Vec<T>& center, const Vec<T>& normal, const T& radius)
      : center_(center), normal_(rescaled(normal)), unitNormal_(normalized(normal)), radius_(radius) {}

  Intersection<T> intersect(const Ray<T>& ray, const T& previousBestDistance) const override {
    const T approach = dot(normal_, ray.direction);
    if (approach == 0) return Intersection<T>::failure();
    const Vec<T> toCenter = center_ - ray.origin;
    const T t = dot(normal_, toCenter) / approach;
    if (!this->accepts(t, previousBestDistance)) return Intersection<T>::failure();
    if (!(length(t * ray.direction - toCenter) <= radius_)) return Intersection<T>::failure();
    return {t, ray, this, unitNormal_, ray.getPoint(t)};
  }

  /// The rim reaches r sin(angle between normal and axis) along an axis.
  BBox<T> getBounds() const override {
    Vec<T> reach;
    for (int axis = 0; axis < 3; ++axis) {
      const T n1 = unitNormal_[(axis + 1) % 3], n2 = unitNormal_[(axis + 2) % 3];
      reach[axis] = radius_ * sqrt(n1 * n1 + n2 * n2);
    }
    return {center_ - reach, center_ + reach};
  }

  T getArea() const override { return pi<T>() * radius_ * radius_; }

  Vec<T> sample(const T& u, const T& v) const override {
    // Any vector not along the normal gives two axes in the disc.
    const Vec<T> n = unitNormal_;
    const Vec<T> aside = absolute(n.x) < absolute(n.y) ? Vec<T>{1, 0, 0} : Vec<T>{0, 1, 0};
    const Vec<T> e1 = normalized(cross(n, aside)), e2 = cross(n, e1);
    const T r = radius_ * sqrt(u), angle = 2 * pi<T>() * v;
    return center_ + r * cos(angle) * e1 + r * sin(angle) * e2;
  }

 private:
  Vec<T> center_, normal_, unitNormal_;
  T radius_;
};

}  // namespace solidcast::reference
