// The double-float of shaders/numeric.glsl (ARITHMETIC 2) on the host: the same operations in the same order, so that a
// calculation of the shader can be followed bit by bit. Algorithms and bounds stand there.
#pragma once
#include <quadmath.h>

#include <cmath>

namespace solidcast::explain {

struct DoubleFloat {
  float hi = 0, lo = 0;
};

inline DoubleFloat twoSum(float a, float b) {
  const float s = a + b, bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}
inline DoubleFloat quickTwoSum(float a, float b) {
  const float s = a + b;
  return {s, b - (s - a)};
}
inline DoubleFloat twoProduct(float a, float b) {
  const float p = a * b;
  const float ca = 4097.f * a, ah = ca - (ca - a), al = a - ah;
  const float cb = 4097.f * b, bh = cb - (cb - b), bl = b - bh;
  return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}

inline DoubleFloat operator-(DoubleFloat a) { return {-a.hi, -a.lo}; }
inline DoubleFloat operator+(DoubleFloat a, DoubleFloat b) {
  const DoubleFloat s = twoSum(a.hi, b.hi), t = twoSum(a.lo, b.lo);
  const DoubleFloat v = quickTwoSum(s.hi, s.lo + t.hi);
  return quickTwoSum(v.hi, t.lo + v.lo);
}
inline DoubleFloat operator-(DoubleFloat a, DoubleFloat b) { return a + -b; }
inline DoubleFloat operator*(DoubleFloat a, DoubleFloat b) {
  const DoubleFloat p = twoProduct(a.hi, b.hi);
  return quickTwoSum(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}
inline DoubleFloat operator/(DoubleFloat a, DoubleFloat b) {
  const float q = a.hi / b.hi;
  DoubleFloat r = a - b * DoubleFloat{q, 0};
  const float c = r.hi / b.hi;
  const DoubleFloat s = quickTwoSum(q, c);
  r = r - b * DoubleFloat{c, 0};
  return s + DoubleFloat{r.hi / b.hi, 0};
}
inline DoubleFloat sqrt(DoubleFloat a) {
  const float x = std::sqrt(a.hi);
  if (a.hi == 0) return {};
  const DoubleFloat r = a - twoProduct(x, x);
  return quickTwoSum(x, r.hi / (2.f * x));
}
inline bool operator<(DoubleFloat a, DoubleFloat b) { return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo); }
inline bool operator>=(DoubleFloat a, DoubleFloat b) { return a.hi > b.hi || (a.hi == b.hi && a.lo >= b.lo); }

// --- what is asked of every number type of the shader -----------------------------------------------------------

template <class Real>
Real roundedTo(__float128 x) {
  return static_cast<Real>(x);
}
template <>
inline DoubleFloat roundedTo<DoubleFloat>(__float128 x) {
  const auto hi = static_cast<float>(x);
  return {hi, static_cast<float>(x - hi)};
}

inline __float128 wide(float x) { return x; }
inline __float128 wide(double x) { return x; }
inline __float128 wide(DoubleFloat x) { return static_cast<__float128>(x.hi) + x.lo; }

inline float toFloat(float x) { return x; }
inline float toFloat(double x) { return static_cast<float>(x); }
inline float toFloat(DoubleFloat x) { return x.hi; }

inline float rootOf(float x) { return std::sqrt(x); }
inline double rootOf(double x) { return std::sqrt(x); }
inline DoubleFloat rootOf(DoubleFloat x) { return sqrt(x); }

}  // namespace solidcast::explain
