// The second pass of `exact`: rays that the first pass could not decide in its arithmetic are cast again here, in
// binary128, against the world itself. It also gives a hit's t, normal and local coordinates to full precision when
// the solid is known.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "host/cast/solids/forms.h"
#include "host/scene/world.h"

namespace solidcast {

struct ExactHit {
  std::int32_t index = -1;
  f128 t = 0;
  explicit operator bool() const { return index >= 0; }
};

class SecondPass {
 public:
  explicit SecondPass(const World& world);

  /// Nearest hit with 0 < t < tMax; at equal t (exactly for rational rays, within binary128's rounding for others) the
  /// earlier solid.
  ExactHit cast(const RayQ& ray, std::optional<f128> tMax = std::nullopt) const;

  /// t of a ray known to hit solid `index`; an empty hit if binary128 disagrees.
  ExactHit castAt(const RayQ& ray, std::int32_t index) const;

  Surface surface(const RayQ& ray, const ExactHit& hit) const;

 private:
  const World& world_;
  std::vector<Ball> balls_;  // a ray that passes one by need not be tried
};

/// Runs f(i) for 0 <= i < n on all cores; small n on this thread alone.
void inParallel(std::size_t n, const std::function<void(std::size_t)>& f);

}  // namespace solidcast
