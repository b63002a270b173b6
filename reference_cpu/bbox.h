// Axis-aligned bounds, closed; infinite where something is unbounded, empty (min above max) where there is nothing.
#pragma once
#include "reference_cpu/vec.h"

namespace solidcast::reference {

template <class T>
struct BBox {
  Vec<T> min{infinity<T>(), infinity<T>(), infinity<T>()};
  Vec<T> max{-infinity<T>(), -infinity<T>(), -infinity<T>()};

  static BBox empty() { return {}; }
  static BBox unbounded() { return {empty().max, empty().min}; }

  bool isEmpty() const { return min.x > max.x || min.y > max.y || min.z > max.z; }
  bool isUnbounded() const {
    for (int axis = 0; axis < 3; ++axis)
      if (min[axis] == -infinity<T>() || max[axis] == infinity<T>()) return !isEmpty();
    return false;
  }
  bool contains(const Vec<T>& p) const {
    for (int axis = 0; axis < 3; ++axis)
      if (p[axis] < min[axis] || p[axis] > max[axis]) return false;
    return true;
  }
  void extend(const Vec<T>& p) { extend(BBox{p, p}); }
  void extend(const BBox& other) {
    for (int axis = 0; axis < 3; ++axis) {
      min[axis] = lesser(min[axis], other.min[axis]);
      max[axis] = greater(max[axis], other.max[axis]);
    }
  }
};

}  // namespace solidcast::reference
