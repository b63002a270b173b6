// What a ray hits first: everything an integrator wants to know, or failure().
#pragma once
#include "reference_cpu/ray.h"

namespace solidcast::reference {

template <class T>
class Solid;

template <class T>
class Intersection {
 public:
  Intersection(const T& distance, const Ray<T>& ray, const Solid<T>* solid, const Vec<T>& normal, const Vec<T>& local)
      : distance_(distance), ray_(ray), solid_(solid), normal_(normal), local_(local) {}
  static Intersection failure() { return {infinity<T>(), {}, nullptr, {}, {}}; }

  explicit operator bool() const { return solid_ != nullptr; }

  /// Ray parameter t, in lengths of the ray's direction; infinity for a failure.
  const T& distance() const { return distance_; }
  const Ray<T>& ray() const { return ray_; }
  const Solid<T>* solid() const { return solid_; }
  Vec<T> hitPoint() const { return ray_.getPoint(distance_); }
  /// Unit geometric normal, never turned towards the ray.
  const Vec<T>& normal() const { return normal_; }
  /// Triangle: weights of v1, v2, v3; quad: (u, v, 0); all others: the hit point.
  const Vec<T>& local() const { return local_; }

 private:
  T distance_;
  Ray<T> ray_;
  const Solid<T>* solid_;
  Vec<T> normal_, local_;
};

}  // namespace solidcast::reference
