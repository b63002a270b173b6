// The number types of the reference (float, double, long double, __float128) under one set of names. The builtin
// __float128 is found by no argument-dependent look-up, so the overloads live here, beside those of <cmath>.
#pragma once
#include <quadmath.h>

#include <cmath>
#include <limits>

namespace solidcast::reference {

using std::cos;
using std::ilogb;
using std::ldexp;
using std::sin;
using std::sqrt;
using std::tan;
inline __float128 cos(__float128 x) { return cosq(x); }
inline int ilogb(__float128 x) { return ilogbq(x); }
inline __float128 ldexp(__float128 x, int exponent) { return ldexpq(x, exponent); }
inline __float128 sin(__float128 x) { return sinq(x); }
inline __float128 sqrt(__float128 x) { return sqrtq(x); }
inline __float128 tan(__float128 x) { return tanq(x); }

template <class T>
T absolute(T x) {
  return x < 0 ? -x : x;
}

template <class T>
T lesser(T x, T y) {
  return y < x ? y : x;
}

template <class T>
T greater(T x, T y) {
  return x < y ? y : x;
}

template <class T>
T infinity() {
  return T(HUGE_VALQ);
}

template <class T>
T pi() {
  return T(M_PIq);
}

/// Largest finite number, smallest normal number and distance from 1 to the next number. (The standard library of the
/// supported compilers does not know them for __float128.)
template <class T>
struct Limits {
  static constexpr T largest = std::numeric_limits<T>::max();
  static constexpr T smallest = std::numeric_limits<T>::min();
  static constexpr T epsilon = std::numeric_limits<T>::epsilon();
};
template <>
struct Limits<__float128> {
  static constexpr __float128 largest = FLT128_MAX;
  static constexpr __float128 smallest = FLT128_MIN;
  static constexpr __float128 epsilon = FLT128_EPSILON;
};

}  // namespace solidcast::reference
