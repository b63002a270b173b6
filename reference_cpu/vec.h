// A point, vector or colour, and the few operations on it.
#pragma once
#include "host/scene/world.h"
#include "reference_cpu/number.h"

namespace solidcast::reference {

template <class T>
struct Vec {
  T x = 0, y = 0, z = 0;

  T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  const T& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }

  Vec operator-() const { return {-x, -y, -z}; }
  friend Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Vec operator*(const T& s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }
  friend Vec operator/(const Vec& a, const T& s) { return {a.x / s, a.y / s, a.z / s}; }
  friend bool operator==(const Vec& a, const Vec& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
};

template <class T>
T dot(const Vec<T>& a, const Vec<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// cross(b, a) is -cross(a, b) to the last bit; Triangle relies on it.
template <class T>
Vec<T> cross(const Vec<T>& a, const Vec<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The world's fp64 numbers, rounded to T once.
template <class T>
Vec<T> toVec(const Triple& v) {
  return {T(v[0]), T(v[1]), T(v[2])};
}

/// v times the power of two that brings its largest component into [1, 2): the direction keeps all its bits.
template <class T>
Vec<T> rescaled(const Vec<T>& v) {
  const T largest = greater(absolute(v.x), greater(absolute(v.y), absolute(v.z)));
  if (!(largest > 0)) return v;
  const int shift = -ilogb(largest);
  return {ldexp(v.x, shift), ldexp(v.y, shift), ldexp(v.z, shift)};
}

/// Unit vector along v, also where the squares leave T's range; v must not be zero.
template <class T>
Vec<T> normalized(const Vec<T>& v) {
  const T squared = dot(v, v);
  if (squared > Limits<T>::smallest / Limits<T>::epsilon && squared <= Limits<T>::largest) return v / sqrt(squared);
  const Vec<T> w = rescaled(v);
  return w / sqrt(dot(w, w));
}

/// Length of v, also where the squares leave T's range.
template <class T>
T length(const Vec<T>& v) {
  const T squared = dot(v, v);
  if (squared > Limits<T>::smallest / Limits<T>::epsilon && squared <= Limits<T>::largest) return sqrt(squared);
  const T largest = greater(absolute(v.x), greater(absolute(v.y), absolute(v.z)));
  if (!(largest > 0)) return 0;
  const Vec<T> w = rescaled(v);
  return ldexp(sqrt(dot(w, w)), ilogb(largest));
}

}  // namespace solidcast::reference
