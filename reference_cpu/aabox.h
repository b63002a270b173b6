// Axis-aligned box as the meeting of three slabs: the ray is inside from the last entry to the first exit. An axis
// along which the ray does not move only asks whether the origin lies between the faces, faces included; it never
// divides by that zero. Where the ray comes through an edge or corner the first axis of x, y, z gives the normal.
#pragma once
#include <utility>

#include "reference_cpu/primitive.h"

namespace solidcast::reference {

template <class T>
class AABox final : public Solid<T> {
 public:
  /// Opposite corners in any order.
  AABox(const Vec<T>& corner1, const Vec<T>& corner2) {
    bounds_.extend(corner1);
    bounds_.extend(corner2);
  }

  Intersection<T> intersect(const Ray<T>& ray, const T& previousBestDistance) const override {
    T entry = -infinity<T>(), exit = infinity<T>();
    int entryAxis = 0, exitAxis = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const T o = ray.origin[axis], d = ray.direction[axis];
      if (d == 0) {
        if (o < bounds_.min[axis] || o > bounds_.max[axis]) return Intersection<T>::failure();
        continue;
      }
      T first = (bounds_.min[axis] - o) / d, second = (bounds_.max[axis] - o) / d;
      if (d < 0) std::swap(first, second);
      if (first > entry) entry = first, entryAxis = axis;
      if (second < exit) exit = second, exitAxis = axis;
    }
    if (entry > exit) return Intersection<T>::failure();

    // From inside (or on the entry face) the far side is what the ray meets.
    const bool outside = entry > 0;
    const T t = outside ? entry : exit;
    if (!this->accepts(t, previousBestDistance)) return Intersection<T>::failure();
    const int axis = outside ? entryAxis : exitAxis;
    Vec<T> normal;
    normal[axis] = (ray.direction[axis] > 0) == outside ? -1 : 1;
    return {t, ray, this, normal, ray.getPoint(t)};
  }

  BBox<T> getBounds() const override { return bounds_; }

  T getArea() const override { return 2 * (faceArea(0) + faceArea(1) + faceArea(2)); }

  /// u chooses the face by area; what is left of it, stretched to [0,1), and v place the point in the face.
  Vec<T> sample(const T& u, const T& v) const override {
    const Vec<T> size = bounds_.max - bounds_.min;
    if (!(getArea() > 0)) this->refuseSample("a box without extent");
    T place = u * getArea();
    int axis = 0;
    while (axis < 2 && place >= 2 * faceArea(axis)) place -= 2 * faceArea(axis++);
    while (faceArea(axis) == 0) --axis;  // only when the last sum was rounded past the end
    const bool upper = place >= faceArea(axis);
    const T along = lesser((upper ? place - faceArea(axis) : place) / faceArea(axis), T(1));

    Vec<T> p = bounds_.min;
    if (upper) p[axis] = bounds_.max[axis];
    const int second = (axis + 1) % 3, third = (axis + 2) % 3;
    p[second] = lesser(p[second] + along * size[second], bounds_.max[second]);
    p[third] = lesser(p[third] + v * size[third], bounds_.max[third]);
    return p;
  }

 private:
  /// Of one of the two faces square to `axis`.
  T faceArea(int axis) const {
    const Vec<T> size = bounds_.max - bounds_.min;
    return size[(axis + 1) % 3] * size[(axis + 2) % 3];
  }

  BBox<T> bounds_;
};

}  // namespace solidcast::reference
