// The second pass of `exact`: rays that the first pass could not decide in its arithmetic are cast again here, in
// binary128, against the world itself. It also gives a hit's t, normal and local coordinates to full precision when
// the solid is known.
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "host/cast/solids/forms.h"
#include "host/scene/world.h"

namespace solidcast {

struct ExactHit {
  std::int32_t index = -1;
  f128 t = 0;
  explicit operator bool() const { return index >= 0; }
};

struct Index;

class SecondPass {
 public:
  /// `index` is that of the world, not widened; without one, the world gets one once so many rays were cast that it pays.
  /// Both must outlive this.
  explicit SecondPass(const World& world, const Index* index = nullptr);
  ~SecondPass();

  /// Nearest hit with 0 < t < tMax; at equal t (exactly for rational rays, within binary128's rounding for others) the
  /// earlier solid.
  ExactHit cast(const RayQ& ray, std::optional<f128> tMax = std::nullopt) const;

  /// The same among these solids alone, by index, which hold all that the ray can meet.
  ExactHit castAmong(const RayQ& ray, std::span<const std::uint32_t> solids) const;

  /// t of a ray known to hit solid `index`; an empty hit if binary128 disagrees.
  ExactHit castAt(const RayQ& ray, std::int32_t index) const;

  Surface surface(const RayQ& ray, const ExactHit& hit) const;

 private:
  struct Candidate {
    std::uint32_t solid;
    Cut cut;
  };
  /// Every solid that the ray hits within `limit` (in its own lengths) and that may be nearest, by index.
  std::vector<Candidate> candidates(const RayQ& ray, f128 limit) const;
  /// The solid's cut at the end of `all`, if there is one that an earlier solid does not have too.
  const Cut* note(const RayQ& ray, std::uint32_t solid, std::vector<Candidate>& all) const;
  ExactHit nearest(const RayQ& ray, std::span<const Candidate> candidates, std::optional<f128> tMax) const;

  const World& world_;
  const Index* index_;
  mutable std::unique_ptr<Index> own_;
  mutable std::once_flag built_;
  mutable std::atomic<int> cast_ = 0;
};

/// Runs f(i) for 0 <= i < n on all cores, each taking `share` at a time; small n on this thread alone.
void inParallel(std::size_t n, const std::function<void(std::size_t)>& f, std::size_t share = 64);

}  // namespace solidcast
