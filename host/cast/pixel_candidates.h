// Which solids a few pixels can see: one look at where every solid is seen, instead of an index that takes a thousand rays
// to repay. What exact's second pass asks for when a picture has a few rays in doubt.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "host/cast/silhouette.h"

namespace solidcast {

class PixelCandidates {
 public:
  /// `pixels` of a band of the region, counted row by row, ascending.
  PixelCandidates(const Scene& scene, const Silhouette& silhouette, const Crop& region,
                  std::span<const std::uint32_t> pixels);

  /// Of pixels[i]: every solid that a ray through the pixel can meet, by index.
  std::span<const std::uint32_t> of(std::size_t i) const { return solids_[i]; }

 private:
  std::vector<std::vector<std::uint32_t>> solids_;
};

}  // namespace solidcast
