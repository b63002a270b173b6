#include "host/cast/pixel_candidates.h"

#include <algorithm>

#include "host/cast/footprints.h"
#include "host/cast/second_pass.h"

namespace solidcast {

PixelCandidates::PixelCandidates(const Scene& scene, const Silhouette& silhouette, const Crop& region,
                                 std::span<const std::uint32_t> pixels)
    : solids_(pixels.size()) {
  constexpr std::int32_t side = 8;
  const std::int32_t across = (region.width + side - 1) / side, down = (region.height + side - 1) / side;
  const auto width = static_cast<std::uint32_t>(region.width);
  std::vector<std::vector<std::uint32_t>> tiles(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  const auto tileOf = [&](std::int32_t x, std::int32_t y) {
    return static_cast<std::size_t>(y / side) * static_cast<std::size_t>(across) + static_cast<std::size_t>(x / side);
  };
  for (std::uint32_t i = 0; i < pixels.size(); ++i)
    tiles[tileOf(static_cast<std::int32_t>(pixels[i] % width), static_cast<std::int32_t>(pixels[i] / width))].push_back(
        i);

  // Each share of the solids notes what it finds by itself, in order; the shares are then put together in theirs.
  const Solids& solids = scene.world.solids;
  constexpr std::size_t share = 64 * Footprints::block;
  std::vector<std::vector<std::array<std::uint32_t, 2>>> found((solids.size() + share - 1) / share);  // pixel, solid
  const Frame<double> eye(eyeFrame(scene, RealType::f64));
  const auto look = [&](std::size_t part) {
    const std::size_t from = part * share, to = std::min(from + share, solids.size());
    Footprints footprints(silhouette, region, eye, RealType::f64);
    for (std::size_t first = from; first < to; first += Footprints::block) {
      const Stretch block{solids, static_cast<std::uint32_t>(first),
                          static_cast<std::uint32_t>(std::min(Footprints::block, to - first))};
      footprints.find(block, [&](std::size_t k, const Footprint& f) {
        if (!f.seen()) return;
        for (std::int32_t y = f.y0 / side; y <= f.y1 / side; ++y)
          for (std::int32_t x = f.x0 / side; x <= f.x1 / side; ++x)
            for (const std::uint32_t i : tiles[tileOf(x * side, y * side)]) {
              const auto column = static_cast<std::int32_t>(pixels[i] % width);
              const auto row = static_cast<std::int32_t>(pixels[i] / width);
              if (column >= f.x0 && column <= f.x1 && row >= f.y0 && row <= f.y1)
                found[part].push_back({i, static_cast<std::uint32_t>(first + k)});
            }
      });
    }
  };
  inParallel(found.size(), look, 1);
  for (const auto& of : found)
    for (const auto& [pixel, solid] : of) solids_[pixel].push_back(solid);
  for (auto& of : solids_) std::sort(of.begin(), of.end());
}

}  // namespace solidcast
