// Decisions about degenerate input that rounding cannot change: fp64 products are exact in binary128, and sums of
// such products are kept as expansions (J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
// Geometric Predicates", 1997, theorem 10: grow-expansion), so that zero means zero and a sliver stays a sliver.
#pragma once
#include <array>
#include <cmath>
#include <initializer_list>

#include "host/scene/world.h"

namespace solidcast {

using Wide = __float128;
using WideTriple = std::array<Wide, 3>;

/// The sum of the terms with the right sign, and zero only when the exact sum is zero. At most 8 terms.
inline Wide exactSum(std::initializer_list<Wide> terms) {
  Wide parts[8];
  int count = 0;
  for (Wide rest : terms) {
    for (int i = 0; i < count; ++i) {  // TwoSum: rest + parts[i] == sum + error exactly
      const Wide sum = rest + parts[i], shadow = sum - rest;
      parts[i] = (rest - (sum - shadow)) + (parts[i] - shadow);
      rest = sum;
    }
    parts[count++] = rest;
  }
  Wide sum = 0;
  for (int i = 0; i < count; ++i) sum += parts[i];
  return sum;
}

/// a x b; each component is zero only when it is exactly zero.
inline WideTriple exactCross(const Triple& a, const Triple& b) {
  const auto component = [&](int i, int j) { return exactSum({Wide(a[i]) * b[j], -(Wide(a[j]) * b[i])}); };
  return {component(1, 2), component(2, 0), component(0, 1)};
}

/// (q - p) x (r - p); each component is zero only when it is exactly zero.
inline WideTriple exactCross(const Triple& p, const Triple& q, const Triple& r) {
  const auto component = [&](int i, int j) {
    return exactSum({Wide(q[i]) * r[j], -(Wide(q[j]) * r[i]), Wide(r[i]) * p[j], -(Wide(r[j]) * p[i]),
                     Wide(p[i]) * q[j], -(Wide(p[j]) * q[i])});
  };
  return {component(1, 2), component(2, 0), component(0, 1)};
}

inline bool isZero(const WideTriple& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }
inline bool isZero(const Triple& v) { return v[0] == 0 && v[1] == 0 && v[2] == 0; }

/// Rounds to fp64. Numbers whose largest lies outside 2^-100 .. 2^100 are first scaled together by a power of two, for
/// vectors and equations whose length means nothing.
template <std::size_t count>
std::array<double, count> roundScaled(std::array<Wide, count> values) {
  Wide largest = 0;
  for (const Wide value : values) largest = std::max(largest, value < 0 ? -value : value);
  if (largest > 0) {
    while (largest > Wide(0x1p100)) {
      for (Wide& value : values) value *= Wide(0x1p-64);
      largest *= Wide(0x1p-64);
    }
    while (largest < Wide(0x1p-100)) {
      for (Wide& value : values) value *= Wide(0x1p64);
      largest *= Wide(0x1p64);
    }
  }
  std::array<double, count> rounded;
  for (std::size_t i = 0; i < count; ++i) rounded[i] = static_cast<double>(values[i]);
  return rounded;
}

}  // namespace solidcast
