// The three number types in which the oracle evaluates the same polynomials, and what can be said about their signs.
//
// Bounded<T> carries, beside the rounded value, the sum of the magnitudes of all terms that went into it. By the usual
// running analysis (Higham, Accuracy and Stability of Numerical Algorithms, ch. 3) a polynomial whose terms pass
// through at most k roundings is off by at most k u / (1 - k u) times that sum. No form here has more than 40, inputs
// rounded from binary128 included; 64 also covers the rounding of the sums themselves, which are fp64.
// The same sum gives the margin: |value| / sum is the relative change of the inputs that could turn the sign.
#pragma once
#include <quadmath.h>

#include <array>
#include <cmath>
#include <limits>

#include "host/oracle/dyadic.h"

namespace solidcast::oracle {

using Real = __float128;

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline Real magnitude(Real x) { return x < 0 ? -x : x; }
inline long double magnitude(long double x) { return x < 0 ? -x : x; }
inline Real rootOf(Real x) { return sqrtq(x); }
inline long double rootOf(long double x) { return sqrtl(x); }

template <class T>
inline constexpr double kUnit = 0;  // unit roundoff
template <>
inline constexpr double kUnit<long double> = std::numeric_limits<long double>::epsilon() / 2;
template <>
inline constexpr double kUnit<Real> = 0x1p-113;

template <class T>
struct Bounded {
  T value = 0;
  double terms = 0;  // 0 only where the value is exactly 0; infinite where nothing is known

  /// |true value - value| <= kError * terms.
  static constexpr double kError = 64 * kUnit<T>;
  /// Below this a product of sums of magnitudes could lose its meaning by underflow.
  static constexpr double kSmallest = 1e-280;

  static Bounded of(Real x) { return raw(static_cast<T>(x)); }
  static Bounded of(double x) { return raw(static_cast<T>(x)); }
  /// x - y of two numbers that T holds exactly: then a result of 0 is exact.
  static Bounded difference(const Bounded& x, const Bounded& y, bool exactInputs) {
    Bounded result = x - y;
    if (exactInputs && result.value == 0) result.terms = 0;
    return result;
  }

  friend Bounded operator+(const Bounded& a, const Bounded& b) { return {a.value + b.value, a.terms + b.terms}; }
  friend Bounded operator-(const Bounded& a, const Bounded& b) { return {a.value - b.value, a.terms + b.terms}; }
  friend Bounded operator*(const Bounded& a, const Bounded& b) {
    if (a.terms == 0 || b.terms == 0) return {};
    const double terms = a.terms * b.terms;
    return {a.value * b.value, terms < kSmallest ? kInfinity : terms};
  }
  Bounded operator-() const { return {-value, terms}; }

  bool negative() const { return value < 0; }

 private:
  static Bounded raw(T x) {
    const double size = static_cast<double>(magnitude(x));
    return {x, x != 0 && size < kSmallest ? kInfinity : size};
  }
};

/// An exact value; `terms` as above, for the margin only.
struct Exact {
  Dyadic value;
  Real terms = 0;

  static Exact of(Real x) { return {Dyadic(x), magnitude(x)}; }
  static Exact of(double x) { return {Dyadic(x), magnitude(static_cast<Real>(x))}; }
  static Exact difference(const Exact& x, const Exact& y, bool) {
    const Exact result = x - y;
    return result.value.sign() == 0 ? Exact{} : result;
  }

  friend Exact operator+(const Exact& a, const Exact& b) { return {a.value + b.value, a.terms + b.terms}; }
  friend Exact operator-(const Exact& a, const Exact& b) { return {a.value - b.value, a.terms + b.terms}; }
  friend Exact operator*(const Exact& a, const Exact& b) { return {a.value * b.value, a.terms * b.terms}; }
  Exact operator-() const { return {-value, terms}; }

  bool negative() const { return value.sign() < 0; }
};

// --- signs and claims -----------------------------------------------------------------------------

/// -1, 0, 1 where certain; 2: the bound does not decide.
struct Sign {
  int is = 2;
  double margin = 0;
  bool certain() const { return is != 2; }
  Sign operator-() const { return {is == 2 ? 2 : -is, margin}; }
};

template <class T>
Sign signOf(const Bounded<T>& x) {
  if (x.terms == 0) return {0, 0};
  const double size = static_cast<double>(magnitude(x.value));
  if (!(size > Bounded<T>::kError * x.terms)) return {};
  return {x.value > 0 ? 1 : -1, size / x.terms};
}

inline Sign signOf(const Exact& x) {
  const int sign = x.value.sign();
  if (sign == 0) return {0, 0};
  return {sign, static_cast<double>(magnitude(x.value.rounded()) / x.terms)};
}

/// A statement that is true, false or undecided, with the margin by which it is so.
struct Claim {
  enum Answer { no, yes, doubt } answer = doubt;
  double margin = 0;
  bool onEdge = false;  // true only thanks to a closed edge: some form is exactly 0
};

inline Claim positive(const Sign& s) {
  if (!s.certain()) return {};
  return {s.is > 0 ? Claim::yes : Claim::no, s.margin};
}
inline Claim notNegative(const Sign& s) {
  if (!s.certain()) return {};
  return {s.is >= 0 ? Claim::yes : Claim::no, s.margin, s.is == 0};
}
/// Both: true by the weaker, false by the stronger refusal.
inline Claim operator&&(const Claim& a, const Claim& b) {
  if (a.answer == Claim::no && b.answer == Claim::no) return {Claim::no, std::fmax(a.margin, b.margin)};
  if (a.answer == Claim::no) return a;
  if (b.answer == Claim::no) return b;
  if (a.answer == Claim::doubt || b.answer == Claim::doubt) return {};
  return {Claim::yes, std::fmin(a.margin, b.margin), a.onEdge || b.onEdge};
}
/// Either: true by the stronger, false by the weaker refusal.
inline Claim operator||(const Claim& a, const Claim& b) {
  if (a.answer == Claim::yes && b.answer == Claim::yes) {
    return {Claim::yes, std::fmax(a.margin, b.margin), a.onEdge && b.onEdge};
  }
  if (a.answer == Claim::yes) return a;
  if (b.answer == Claim::yes) return b;
  if (a.answer == Claim::doubt || b.answer == Claim::doubt) return {};
  return {Claim::no, std::fmin(a.margin, b.margin)};
}

// --- vectors ----------------------------------------------------------------------------------------

template <class N>
using Vector = std::array<N, 3>;

template <class N>
N dot(const Vector<N>& a, const Vector<N>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class N>
Vector<N> cross(const Vector<N>& a, const Vector<N>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class N>
Vector<N> operator+(const Vector<N>& a, const Vector<N>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class N>
Vector<N> operator-(const Vector<N>& a, const Vector<N>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class N>
Vector<N> operator*(const N& s, const Vector<N>& a) {
  return {s * a[0], s * a[1], s * a[2]};
}

}  // namespace solidcast::oracle
