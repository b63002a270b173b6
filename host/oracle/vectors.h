// Plain fp64 vectors for drawing test cases; nothing here needs to be accurate.
#pragma once
#include <cmath>

#include "host/scene/world.h"

namespace solidcast::oracle {

inline Triple sum(const Triple& a, const Triple& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Triple difference(const Triple& a, const Triple& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Triple scaled(double s, const Triple& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double inner(const Triple& a, const Triple& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Triple outer(const Triple& a, const Triple& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Triple& a) { return std::sqrt(inner(a, a)); }
inline Triple unitOf(const Triple& a) { return scaled(1 / norm(a), a); }

/// The quadric squares.p^2 + mixed.(xy, xz, yz) + linear.p + constant = 0 with p counted from `center`.
Quadric aboutCenter(const Triple& squares, const Triple& mixed, const Triple& linear, double constant,
                    const Triple& center);

}  // namespace solidcast::oracle
