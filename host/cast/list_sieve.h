// Which solids of a wide tile are hidden: looked at from the nearest on, each that covers something lowers the depths, and what
// begins behind all depths where it is seen is not listed. In a crowd a few layers are gone through, and the rest is dropped
// unseen when no pixel is left that is deep enough.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/cast/depth_bounds.h"
#include "host/scene/world.h"

namespace solidcast {

/// Into the caches, for soon.
inline void fetch(ShapeRef shape) {
  shape.visit([](const auto& solid) {
    const auto* at = reinterpret_cast<const char*>(&solid);
    for (std::size_t line = 0; line < sizeof solid; line += 64) __builtin_prefetch(at + line);
    __builtin_prefetch(at + sizeof solid - 1);
  });
}

/// A solid where it is seen in the region.
struct ListHead {
  Footprint seen;
  std::uint32_t solid;
};

/// A few hundred solids from all over a scene, those of them that are seen.
struct ListSample {
  ListSample(const Solids& solids, Footprints& footprints);

  struct One {
    Footprint seen;
    ShapeRef shape;
  };
  std::vector<One> all;
  double each = 1;  // so many solids are there for one of these
};

/// The part of the solids that is left where looking for what is hidden pays, about; 1: it does not.
double partLeft(const ListSample& sample, const Crop& region, RealType type);

/// Of depths where solids begin: a few slices with about as many solids each, nearest first. Those of a slice are gone through
/// together, and what the slices before hide of them is dropped before it is sorted.
struct DepthSlices {
  static constexpr std::size_t count = 3;
  std::array<DepthCode, count> from{};  // 0 for the first
  std::size_t of(DepthCode nearest) const {
    std::size_t slice = 0;
    for (std::size_t i = 1; i < count; ++i) slice += nearest >= from[i];
    return slice;
  }
};
DepthSlices slicesOf(const ListSample& sample);

/// A wide tile's part of the picture.
struct ListPatch {
  DepthBounds depths;
  std::vector<SeenWithin> kept;
};

class Sieve {
 public:
  Sieve(const Solids& solids, Footprints& footprints) : solids_(solids), footprints_(footprints) {}

  /// Adds to the patch, which has been started, what is not hidden of `narrow`: solids of one slice, after the slices before
  /// it. `wides` hide as well, where they are seen.
  void sift(ListPatch& patch, std::span<const std::vector<SeenWithin>* const> narrow,
            std::span<const std::span<const ListHead>> wides, const DepthSlices& slices, std::size_t slice,
            const SmallDiscs& discs);
  /// Removes what has been hidden since it was kept; the others are then in the order of the solids.
  void siftKept(ListPatch& patch);

 private:
  /// order_ by key, about: by buckets of keys.
  void sort(std::span<const SeenWithin> solids, auto&& key);
  /// Where the depths of its bucket begin.
  DepthCode bucketOf(DepthCode nearest) const {
    return static_cast<DepthCode>(least_ + ((nearest - least_) >> shift_ << shift_));
  }

  const Solids& solids_;
  Footprints& footprints_;
  Pile<SeenWithin> all_;              // the wide ones last
  std::vector<std::uint32_t> order_;  // places of what was sorted
  std::uint32_t least_ = 0;           // of its keys
  int shift_ = 0;                     // how many bits of their differences are left out
  std::vector<std::uint32_t> places_;
  std::vector<std::uint32_t> start_;  // of the buckets, then where they end
};

}  // namespace solidcast
