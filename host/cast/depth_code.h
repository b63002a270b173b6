// Depths along the camera's forward axis in 16 bits, for comparing which of two is certainly nearer: sixteen octaves around
// a middle depth, 2^-12 apart, which is the float's own bits without the last eleven. A buffer of them stays in a core's
// own cache, and one vector holds a row of a small solid.
//
// Both sides are rounded down: where the code of one depth is greater than that of another, so is the depth.
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

  /// Of where something begins: before `none`, however far.
  std::int32_t begins(float depth) const { return within(code(depth), none - 1); }
  /// Of where something ends: `none` where the codes do not reach.
  std::int32_t ends(float depth) const { return within(code(depth), none); }

 private:
  std::int32_t code(float depth) const {
    return (__builtin_bit_cast(std::int32_t, depth > 0 ? depth : 0.f) - least_) >> 11;
  }
  static std::int32_t within(std::int32_t code, std::int32_t most) { return code < 0 ? 0 : code > most ? most : code; }

  std::int32_t least_;
};

}  // namespace solidcast
