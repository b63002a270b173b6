// Operands for tests of arithmetic: exponents drawn uniformly, significands of few and of many bits.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "host/oracle/random.h"

namespace solidcast::glsl_test {

using Pair = std::array<float, 2>;  // a double-float: hi, lo

inline __float128 valueOf(const Pair& p) { return __float128(p[0]) + p[1]; }

class Operands {
 public:
  explicit Operands(std::uint64_t seed) : random_(seed) {}

  /// Exponent in [-range, range]; significand full, of few bits, or next to a power of two.
  template <class Real>
  Real real(int range) {
    constexpr int digits = std::numeric_limits<Real>::digits;
    double significand = random_.uniform(1, 2);
    const int form = random_.integer(0, 3);
    if (form == 0) significand = 1 + std::ldexp(random_.integer(0, 15), -random_.integer(4, 23));
    if (form == 1) significand = 2 - std::ldexp(random_.integer(1, 15), -random_.integer(4, digits - 1));
    return static_cast<Real>(random_.sign() * std::ldexp(significand, random_.integer(-range, range)));
  }
  /// Normalised: |lo| is at most half a unit of hi's last place, often just that, often far smaller.
  Pair pair(int range) {
    const float hi = real<float>(range);
    int exponent = 0;
    std::frexp(hi, &exponent);
    double lo = std::ldexp(random_.uniform(-1, 1), exponent - 25);
    const int form = random_.integer(0, 4);
    if (form == 0) lo = std::ldexp(random_.sign() * (1 - std::ldexp(random_.integer(1, 7), -22)), exponent - 25);
    if (form == 1) lo = std::ldexp(lo, -random_.integer(0, 24));
    if (form == 2) lo = 0;
    // At a power of two the unit below is half as large.
    const float rounded = static_cast<float>(lo);
    return hi + rounded == hi ? Pair{hi, rounded} : Pair{hi, 0};
  }
  /// Near -p or p, so that sums cancel.
  Pair near(const Pair& p) {
    const float sign = random_.chance(0.8) ? -1.f : 1.f;
    const float hi = p[0] * (1 + std::ldexp(static_cast<float>(random_.integer(-3, 3)), -random_.integer(3, 23)));
    const Pair other = pair(0);
    const float lo = std::ldexp(other[0], std::ilogb(hi) - 25 - random_.integer(0, 10));
    return hi + lo == hi ? Pair{sign * hi, sign * lo} : Pair{sign * hi, 0};
  }
  bool chance(double p) { return random_.chance(p); }

 private:
  oracle::Random random_;
};

}  // namespace solidcast::glsl_test
