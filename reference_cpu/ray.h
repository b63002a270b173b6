// A half-line. Its parameter t counts in lengths of the direction: a direction of length 2 halves every t.
#pragma once
#include "reference_cpu/vec.h"

namespace solidcast::reference {

template <class T>
struct Ray {
  Vec<T> origin, direction;

  Vec<T> getPoint(const T& t) const { return origin + t * direction; }
};

}  // namespace solidcast::reference
