// A number of the shader, followed through its formula five times over: as the shader rounds it, and in binary128 from
// true or rounded inputs. So an error can be told apart by where it comes from:
//
//   error = (shader - rounded)            arithmetic: roundings of the shader's own operations
//         + (rounded - ideal)             inputs, which alone would give (first order)
//             ray - ideal                   the ray's direction or origin, rounded or calculated by the shader
//             records - ideal               the solid's rows, rounded once by the host
//
// Beside them runs a bound of |shader - ideal| (running error analysis: Higham, Accuracy and Stability of Numerical
// Algorithms, 3.3), with the inputs' true errors and u for each operation.
#pragma once
#include <cmath>
#include <cstdint>

#include "host/cast/solids/forms.h"
#include "host/explain/double_float.h"

namespace solidcast::explain {

template <class Real>
inline constexpr RealType kTypeOf = RealType::f32;
template <>
inline constexpr RealType kTypeOf<double> = RealType::f64;
template <>
inline constexpr RealType kTypeOf<DoubleFloat> = RealType::df32;

template <class Real>
inline constexpr double kUnit = 0x1p-24;  // u, as numeric.glsl states it
template <>
inline constexpr double kUnit<double> = 0x1p-53;
template <>
inline constexpr double kUnit<DoubleFloat> = 0x1p-44;

template <class Real>
struct Traced {
  Real shader{};
  f128 rounded = 0, ray = 0, records = 0, ideal = 0;
  double bound = 0;          // of |shader - ideal|
  std::uint64_t stages = 0;  // bits: of the log, those that it was made of since

  Traced() = default;
  /// Exactly x.
  Traced(double x) : shader(roundedTo<Real>(x)), rounded(x), ray(x), records(x), ideal(x) {}  // NOLINT: as in GLSL

  double size() const { return std::fabs(static_cast<double>(wide(shader))); }
};

template <class Real>
Traced<Real> fromRay(Real shader, f128 ideal) {
  Traced<Real> x;
  x.shader = shader;
  x.rounded = x.ray = wide(shader);
  x.records = x.ideal = ideal;
  x.bound = std::fabs(static_cast<double>(wide(shader) - ideal));
  return x;
}
template <class Real>
Traced<Real> fromRecord(f128 ideal) {
  Traced<Real> x;
  x.shader = roundedTo<Real>(ideal);
  x.rounded = x.records = wide(x.shader);
  x.ray = x.ideal = ideal;
  x.bound = std::fabs(static_cast<double>(wide(x.shader) - ideal));
  return x;
}

namespace detail {
/// One operation on all five; `bound` is that of the shader's own rounding, 0 where it had none.
template <class Real, class F>
Traced<Real> combined(const Traced<Real>& a, const Traced<Real>& b, F operation) {
  constexpr double tiny = kTypeOf<Real> == RealType::f64 ? 0 : 0x1p-149;  // fp32's least: what underflow may take
  Traced<Real> r;
  r.shader = operation(a.shader, b.shader);
  r.rounded = operation(a.rounded, b.rounded);
  r.ray = operation(a.ray, b.ray);
  r.records = operation(a.records, b.records);
  r.ideal = operation(a.ideal, b.ideal);
  r.stages = a.stages | b.stages;
  const bool exact = operation(wide(a.shader), wide(b.shader)) == wide(r.shader);
  r.bound = exact ? 0 : kUnit<Real> * r.size() + tiny;
  return r;
}
}  // namespace detail

template <class Real>
Traced<Real> operator+(const Traced<Real>& a, const Traced<Real>& b) {
  Traced<Real> r = detail::combined(a, b, [](auto x, auto y) { return x + y; });
  r.bound += a.bound + b.bound;
  return r;
}
template <class Real>
Traced<Real> operator-(const Traced<Real>& a) {
  Traced<Real> r = detail::combined(a, a, [](auto x, auto) { return -x; });
  r.bound = a.bound;
  return r;
}
template <class Real>
Traced<Real> operator-(const Traced<Real>& a, const Traced<Real>& b) {
  Traced<Real> r = detail::combined(a, b, [](auto x, auto y) { return x - y; });
  r.bound += a.bound + b.bound;
  return r;
}
template <class Real>
Traced<Real> operator*(const Traced<Real>& a, const Traced<Real>& b) {
  Traced<Real> r = detail::combined(a, b, [](auto x, auto y) { return x * y; });
  r.bound += a.size() * b.bound + b.size() * a.bound + a.bound * b.bound;
  return r;
}
template <class Real>
Traced<Real> operator/(const Traced<Real>& a, const Traced<Real>& b) {
  Traced<Real> r = detail::combined(a, b, [](auto x, auto y) { return x / y; });
  const double room = b.size() - b.bound;
  r.bound = room > 0 ? r.bound + (a.bound + r.size() * b.bound) / room : INFINITY;
  return r;
}
template <class Real>
Traced<Real> root(const Traced<Real>& a) {
  Traced<Real> r = a;
  r.shader = rootOf(a.shader);
  for (f128* x : {&r.rounded, &r.ray, &r.records, &r.ideal}) *x = sqrtq(*x);
  r.bound =
      (a.size() > a.bound ? a.bound / std::sqrt(a.size()) : std::sqrt(a.size() + a.bound)) + kUnit<Real> * r.size();
  return r;
}

// Comparisons are the shader's: what it takes for true decides which formula is followed.
template <class Real>
bool operator<(const Traced<Real>& a, const Traced<Real>& b) {
  return a.shader < b.shader;
}
template <class Real>
bool operator>=(const Traced<Real>& a, const Traced<Real>& b) {
  return a.shader >= b.shader;
}
template <class Real>
Traced<Real> smaller(const Traced<Real>& a, const Traced<Real>& b) {
  return a < b ? a : b;
}
template <class Real>
Traced<Real> larger(const Traced<Real>& a, const Traced<Real>& b) {
  return b < a ? a : b;
}
template <class Real>
Traced<Real> magnitude(const Traced<Real>& a) {
  return wide(a.shader) < 0 ? -a : a;
}

template <class Real>
struct TracedVector {
  Traced<Real> x, y, z;
  const Traced<Real>& operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  Traced<Real>& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
};
template <class Real>
TracedVector<Real> operator+(const TracedVector<Real>& a, const TracedVector<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
TracedVector<Real> operator-(const TracedVector<Real>& a, const TracedVector<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
TracedVector<Real> operator*(const TracedVector<Real>& a, const Traced<Real>& k) {
  return {a.x * k, a.y * k, a.z * k};
}
template <class Real>
TracedVector<Real> operator/(const TracedVector<Real>& a, const Traced<Real>& k) {
  return {a.x / k, a.y / k, a.z / k};
}

// numeric.glsl's and hit.glsl's, in their order of operations.
template <class Real>
Traced<Real> linear(const TracedVector<Real>& g, const TracedVector<Real>& d) {
  return g.x * d.x + (g.y * d.y + g.z * d.z);
}
template <class Real>
Traced<Real> length(const TracedVector<Real>& a) {
  return root(linear(a, a));
}
template <class Real>
TracedVector<Real> cross(const TracedVector<Real>& a, const TracedVector<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class Real>
TracedVector<Real> unit(const TracedVector<Real>& a) {
  const Traced<Real> big = larger(larger(magnitude(a.x), magnitude(a.y)), magnitude(a.z));
  if (wide(big.shader) == 0) return a;
  const TracedVector<Real> v = a / big;
  return v / length(v);
}

}  // namespace solidcast::explain
