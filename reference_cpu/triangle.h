// Triangle by signed volumes. Seen from the ray's origin with a, b, c = v1-o, v2-o, v3-o, the volumes d.(b x c),
// d.(c x a), d.(a x b) tell on which side of each edge the ray passes; inside they have one sign, on an edge one is 0
// and counts as inside. They are in proportion to the weights of v1, v2, v3. Two triangles that share an edge find the
// same number for it with opposite signs, bit for bit, so that no ray slips between them. t comes from the plane.
#pragma once
#include "reference_cpu/primitive.h"

namespace solidcast::reference {

template <class T>
class Triangle final : public Solid<T> {
 public:
  Triangle(const Vec<T>& v1, const Vec<T>& v2, const Vec<T>& v3)
      : v1_(v1), v2_(v2), v3_(v3), normal_(cross(v2 - v1, v3 - v1)), unitNormal_(normalized(normal_)) {}

  Intersection<T> intersect(const Ray<T>& ray, const T& previousBestDistance) const override {
    const T approach = dot(normal_, ray.direction);
    if (approach == 0) return Intersection<T>::failure();
    const Vec<T> a = v1_ - ray.origin;
    const T t = dot(normal_, a) / approach;
    if (!this->accepts(t, previousBestDistance)) return Intersection<T>::failure();

    const Vec<T> b = v2_ - ray.origin, c = v3_ - ray.origin;
    const Vec<T> volumes{dot(ray.direction, cross(b, c)), dot(ray.direction, cross(c, a)),
                         dot(ray.direction, cross(a, b))};
    const bool negative = volumes.x < 0 || volumes.y < 0 || volumes.z < 0;
    const bool positive = volumes.x > 0 || volumes.y > 0 || volumes.z > 0;
    if (negative == positive) return Intersection<T>::failure();  // beside it, or all three vanish
    return {t, ray, this, unitNormal_, volumes / (volumes.x + volumes.y + volumes.z)};
  }

  BBox<T> getBounds() const override {
    BBox<T> bounds;
    bounds.extend(v1_);
    bounds.extend(v2_);
    bounds.extend(v3_);
    return bounds;
  }

  T getArea() const override { return length(normal_) / 2; }

  /// sqrt(u) is the distance from v1 to the opposite edge as a fraction, v the place along it.
  Vec<T> sample(const T& u, const T& v) const override {
    const T s = sqrt(u);
    return (1 - s) * v1_ + s * (1 - v) * v2_ + s * v * v3_;
  }

 private:
  Vec<T> v1_, v2_, v3_, normal_, unitNormal_;
};

}  // namespace solidcast::reference
