// Plane n.(p - origin) = 0 with a normal of any length: t = n.(origin - o) / n.d. The unit normal is kept apart,
// because its rounding would tilt the plane under grazing rays. A ray in the plane, or parallel to it, misses.
#pragma once
#include "reference_cpu/primitive.h"

namespace solidcast::reference {

template <class T>
class InfinitePlane final : public Solid<T> {
 public:
  InfinitePlane(const Vec<T>& origin, const Vec<T>& normal)
      : origin_(origin), normal_(rescaled(normal)), unitNormal_(normalized(normal)) {}

  Intersection<T> intersect(const Ray<T>& ray, const T& previousBestDistance) const override {
    const T approach = dot(normal_, ray.direction);
    if (approach == 0) return Intersection<T>::failure();
    const T t = dot(normal_, origin_ - ray.origin) / approach;
    if (!this->accepts(t, previousBestDistance)) return Intersection<T>::failure();
    return {t, ray, this, unitNormal_, ray.getPoint(t)};
  }

  /// Unbounded; flat along an axis that the plane is square to.
  BBox<T> getBounds() const override {
    BBox<T> bounds = BBox<T>::unbounded();
    for (int axis = 0; axis < 3; ++axis)
      if (normal_[(axis + 1) % 3] == 0 && normal_[(axis + 2) % 3] == 0)
        bounds.min[axis] = bounds.max[axis] = origin_[axis];
    return bounds;
  }
  T getArea() const override { return infinity<T>(); }
  Vec<T> sample(const T&, const T&) const override { this->refuseSample("an infinite plane"); }

 private:
  Vec<T> origin_, normal_, unitNormal_;
};

}  // namespace solidcast::reference
