// A free ray and what it hits, as `query` reads and prints them.
#pragma once
#include <array>
#include <cstdint>
#include <limits>

namespace solidcast {

/// p(t) = origin + t direction; the direction has any length but zero. Hits need 0 < t < tMax.
struct QueryRay {
  std::array<float, 3> origin{}, direction{};
  float tMax = std::numeric_limits<float>::infinity();
};

/// What fp32 can hold is the far limit: a hit whose t rounds to infinity counts as none.
struct QueryHit {
  std::int32_t index = -1;  // of the solid, depth first; -1: no hit
  float t = 0;
  std::array<float, 3> normal{}, local{}, position{};
  explicit operator bool() const { return index >= 0; }
};

}  // namespace solidcast
