// Depths along the camera's forward axis in 16 bits, for comparing which of two is certainly nearer: sixteen octaves around
// a middle depth, 2^-12 apart, which is the float's own bits without the last eleven. A buffer of them stays in a core's
// own cache, and one vector holds a row of a small solid.
#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

namespace solidcast {

using DepthCode = std::uint16_t;

class DepthScale {
 public:
  /// Farther than every depth: nothing is hidden beyond it.
  static constexpr DepthCode none = 0xffff;

  explicit DepthScale(float middle = 1) : least_(std::max(1 << 12, std::bit_cast<std::int32_t>(middle) - (8 << 23))) {}

  /// Not beyond the depth, and never `none`.
  std::int32_t down(float depth) const { return clamped((bits(depth) - least_) >> step, none - 1); }
  /// Not before it.
  std::int32_t up(float depth) const { return clamped((bits(depth) - least_ + ((1 << step) - 1)) >> step, none); }

 private:
  static constexpr int step = 11;
  static std::int32_t bits(float depth) { return __builtin_bit_cast(std::int32_t, depth > 0 ? depth : 0.f); }
  static std::int32_t clamped(std::int32_t code, std::int32_t most) { return code < 0 ? 0 : code > most ? most : code; }

  std::int32_t least_;
};

}  // namespace solidcast
