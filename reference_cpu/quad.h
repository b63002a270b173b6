// Parallelogram vertex + u span1 + v span2 by Cramer's rule. With f = o - vertex and P = d x span2 the determinant is
// span1.P, u = f.P / determinant, v = d.(f x span1) / determinant. The tests 0 <= u, v <= 1 are made before the
// division, so the edges belong to the quad wherever the products are exact. t comes from the plane.
#pragma once
#include "reference_cpu/primitive.h"

namespace solidcast::reference {

template <class T>
class Quad final : public Solid<T> {
 public:
  Quad(const Vec<T>& vertex, const Vec<T>& span1, const Vec<T>& span2)
      : vertex_(vertex), span1_(span1), span2_(span2), normal_(cross(span1, span2)), unitNormal_(normalized(normal_)) {}

  Intersection<T> intersect(const Ray<T>& ray, const T& previousBestDistance) const override {
    const T approach = dot(normal_, ray.direction);
    if (approach == 0) return Intersection<T>::failure();
    const Vec<T> f = ray.origin - vertex_;
    const T t = -dot(normal_, f) / approach;
    if (!this->accepts(t, previousBestDistance)) return Intersection<T>::failure();

    const Vec<T> P = cross(ray.direction, span2_);
    T determinant = dot(span1_, P);
    T u = dot(f, P), v = dot(ray.direction, cross(f, span1_));
    if (determinant < 0) determinant = -determinant, u = -u, v = -v;
    const bool inside = u >= 0 && u <= determinant && v >= 0 && v <= determinant && determinant > 0;
    if (!inside) return Intersection<T>::failure();
    return {t, ray, this, unitNormal_, {u / determinant, v / determinant, 0}};
  }

  BBox<T> getBounds() const override {
    BBox<T> bounds;
    bounds.extend(vertex_);
    bounds.extend(vertex_ + span1_);
    bounds.extend(vertex_ + span2_);
    bounds.extend(vertex_ + span1_ + span2_);
    return bounds;
  }

  T getArea() const override { return length(normal_); }

  Vec<T> sample(const T& u, const T& v) const override { return vertex_ + u * span1_ + v * span2_; }

 private:
  Vec<T> vertex_, span1_, span2_, normal_, unitNormal_;
};

}  // namespace solidcast::reference
