// Small vectors of binary128 numbers, what the second pass calculates in; the flattening also in narrower ones.
#pragma once
#include <quadmath.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "host/scene/world.h"

namespace solidcast {

using f128 = __float128;

// What the flattening alone needs is written for any number type T: double, long double or f128.
inline f128 squareRoot(f128 x) { return sqrtq(x); }
inline f128 magnitude(f128 x) { return fabsq(x); }
inline long double squareRoot(long double x) { return std::sqrt(x); }
inline long double magnitude(long double x) { return std::fabs(x); }
inline double squareRoot(double x) { return std::sqrt(x); }
inline double magnitude(double x) { return std::fabs(x); }
/// 2^exponent, for exponents of normal numbers.
constexpr double twoTo(int exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
}

template <class T>
struct Vec3 {
  T x = 0, y = 0, z = 0;
  Vec3() = default;
  Vec3(T a, T b, T c) : x(a), y(b), z(c) {}
  explicit Vec3(const Triple& t) : x(t[0]), y(t[1]), z(t[2]) {}
  template <class U>
  explicit Vec3(const Vec3<U>& v) : x(static_cast<T>(v.x)), y(static_cast<T>(v.y)), z(static_cast<T>(v.z)) {}
  T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }

  friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
  friend Vec3 operator*(Vec3 a, T k) { return {a.x * k, a.y * k, a.z * k}; }
  friend Vec3 operator*(T k, Vec3 a) { return a * k; }
  friend Vec3 operator/(Vec3 a, T k) { return {a.x / k, a.y / k, a.z / k}; }
  friend T dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  friend Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
  friend T length(Vec3 a) { return squareRoot(dot(a, a)); }
  friend Vec3 normalized(Vec3 a) { return a / length(a); }
  friend bool isZero(Vec3 a) { return a.x == 0 && a.y == 0 && a.z == 0; }
};
using V3 = Vec3<f128>;

// The first argument decides the type: with an int literal there the second would be cut to one.
template <class T>
requires(!std::is_integral_v<T>) T smaller(T a, std::type_identity_t<T> b) { return a < b ? a : b; }
template <class T>
requires(!std::is_integral_v<T>) T larger(T a, std::type_identity_t<T> b) { return a > b ? a : b; }

/// The power of two nearest below |x| (1 for 0).
inline f128 powerOfTwo(f128 x) {
  if (x == 0) return 1;
  int e = 0;
  frexpq(x, &e);
  return ldexpq(1, e - 1);
}
inline long double powerOfTwo(long double x) { return x == 0 ? 1 : std::ldexp(1.0L, std::ilogb(x)); }
inline double powerOfTwo(double x) { return x == 0 ? 1 : std::ldexp(1.0, std::ilogb(x)); }

/// A vector orthogonal to the unit vector n and of unit length.
template <class T>
Vec3<T> orthogonal(Vec3<T> n) {
  T x = magnitude(n.x), y = magnitude(n.y), z = magnitude(n.z);
  Vec3<T> axis = x <= y && x <= z ? Vec3<T>{1, 0, 0} : y <= z ? Vec3<T>{0, 1, 0} : Vec3<T>{0, 0, 1};
  return normalized(cross(n, axis));
}

}  // namespace solidcast
