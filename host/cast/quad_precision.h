// Small vectors of binary128 numbers: what the flattening and the second pass calculate in.
#pragma once
#include <quadmath.h>

#include "host/scene/world.h"

namespace solidcast {

using f128 = __float128;

struct V3 {
  f128 x = 0, y = 0, z = 0;
  V3() = default;
  V3(f128 a, f128 b, f128 c) : x(a), y(b), z(c) {}
  explicit V3(const Triple& t) : x(t[0]), y(t[1]), z(t[2]) {}
  f128 operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  f128& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
};

inline V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline V3 operator-(V3 a) { return {-a.x, -a.y, -a.z}; }
inline V3 operator*(V3 a, f128 k) { return {a.x * k, a.y * k, a.z * k}; }
inline V3 operator*(f128 k, V3 a) { return a * k; }
inline V3 operator/(V3 a, f128 k) { return {a.x / k, a.y / k, a.z / k}; }
inline f128 dot(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V3 cross(V3 a, V3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline f128 length(V3 a) { return sqrtq(dot(a, a)); }
inline V3 normalized(V3 a) { return a / length(a); }
inline bool isZero(V3 a) { return a.x == 0 && a.y == 0 && a.z == 0; }

inline f128 smaller(f128 a, f128 b) { return a < b ? a : b; }
inline f128 larger(f128 a, f128 b) { return a > b ? a : b; }

/// The power of two nearest below |x| (1 for 0).
inline f128 powerOfTwo(f128 x) {
  if (x == 0) return 1;
  int e = 0;
  frexpq(x, &e);
  return ldexpq(1, e - 1);
}

/// A vector orthogonal to the unit vector n and of unit length.
inline V3 orthogonal(V3 n) {
  V3 axis = fabsq(n.x) <= fabsq(n.y) && fabsq(n.x) <= fabsq(n.z) ? V3{1, 0, 0}
            : fabsq(n.y) <= fabsq(n.z)                           ? V3{0, 1, 0}
                                                                 : V3{0, 0, 1};
  return normalized(cross(n, axis));
}

}  // namespace solidcast
