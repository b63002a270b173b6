// The ray parameter of a hit as an algebraic number, kept unevaluated so that two of them can be compared exactly.
#pragma once
#include "host/oracle/number.h"

namespace solidcast::oracle {

/// rational: a/b.  above: (a + sqrt(d))/b.  below: a/(b + sqrt(d)).  b + sqrt(d) and b are not 0.
template <class N>
struct Root {
  enum Kind { rational, above, below } kind = rational;
  N a, b, d{};
};

/// The value with its error in `terms`; terms is infinite where the value is worthless.
template <class T>
Bounded<T> evaluate(const Root<Bounded<T>>& root) {
  using B = Bounded<T>;
  const auto absolute = [](const B& x) { return B::kError * x.terms; };
  T square = 0;
  double squareError = 0;  // absolute error of the square root
  if (root.kind != Root<B>::rational && root.d.terms != 0) {
    if (!(root.d.value > 0)) return {0, kInfinity};
    square = rootOf(root.d.value);
    const double relative = absolute(root.d) / static_cast<double>(root.d.value);
    if (!(relative < 1)) return {0, kInfinity};
    squareError = static_cast<double>(square) * relative;
  }
  T numerator = root.a.value, denominator = root.b.value;
  double numeratorError = absolute(root.a), denominatorError = absolute(root.b);
  if (root.kind == Root<B>::above) {
    numerator += square;
    numeratorError += squareError;
  } else if (root.kind == Root<B>::below) {
    denominator += square;
    denominatorError += squareError;
  }
  const T value = numerator / denominator;
  const double relative = numeratorError / static_cast<double>(magnitude(numerator)) +
                          denominatorError / static_cast<double>(magnitude(denominator));
  if (!(relative < 0.25)) return {value, kInfinity};
  return {value, static_cast<double>(magnitude(value)) * (1 + 2 * relative / B::kError)};
}

/// To more than 400 bits: after that the surface point can be evaluated as if the root were exact.
inline Exact evaluate(const Root<Exact>& root) {
  constexpr unsigned kBits = 448;
  Dyadic numerator = root.a.value, denominator = root.b.value;
  if (root.kind == Root<Exact>::above) numerator = numerator + squareRoot(root.d.value, kBits);
  if (root.kind == Root<Exact>::below) denominator = denominator + squareRoot(root.d.value, kBits);
  const Dyadic value = quotient(numerator, denominator, kBits);
  return {value, magnitude(value.rounded())};
}

/// Sign of x - y: -1, 0 or 1, decided by squaring, never by rounding.
int compare(const Root<Exact>& x, const Root<Exact>& y);

/// a/b, b not 0 (to 448 bits for exact numbers).
template <class T>
Bounded<T> ratio(const Bounded<T>& a, const Bounded<T>& b) {
  const double size = static_cast<double>(magnitude(b.value));
  const double relative = Bounded<T>::kError * b.terms / size;
  if (!(relative < 0.25)) return {0, kInfinity};
  const T value = a.value / b.value;
  return {value, 2 * (a.terms / size + static_cast<double>(magnitude(value)) * (1 + b.terms / size))};
}
inline Exact ratio(const Exact& a, const Exact& b) {
  const Dyadic value = quotient(a.value, b.value, 448);
  return {value, magnitude(value.rounded())};
}

}  // namespace solidcast::oracle
