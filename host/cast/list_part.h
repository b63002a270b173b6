// A thread's share of list building: the solids of one stretch of the scene, in their order.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "host/cast/depth_bounds.h"
#include "host/cast/list_build.h"

namespace solidcast {

enum ListLevel : std::size_t { narrow, wide };

/// Rows of a kind's record: for one eye, or of the solid itself, for rays that are free.
std::uint32_t rowsOf(std::size_t kind, bool eyeForms);

/// Of the tiles of a level, `side` pixels each, the depth beyond which nothing is seen of each; none: no limits.
struct ListLimits {
  const DepthCode* byTile = nullptr;
  std::size_t across = 0;
  int side = 0;
};

/// Of a few hundred solids from all over the scene: how many layers of rectangles it has, and how deep they lie.
class Crowd {
 public:
  Crowd() = default;
  Crowd(std::span<const SolidEntry> solids, const Crop& region, RealType type, Footprints& footprints);

  /// Looking for what is hidden costs a pass over the pixels and, by solid, a few rows of them: it pays from some 3 layers
  /// of spheres on, 10 of polygons (each covers half of its rectangle and is drawn by its edges), 5 where a polygon's record
  /// takes extended precision.
  bool worthLooking() const { return worth_ > 1; }
  /// The depth that so many layers reach to.
  DepthCode depthOf(double layers) const;

 private:
  double worth_ = 0;
  std::vector<std::pair<DepthCode, double>> some_;  // depth, and layers up to it
};

/// Bytes at the end of which more are put, without being cleared first.
class Arena {
 public:
  /// Room at the end, of which so much is kept as is taken.
  std::byte* room(std::size_t bytes) {
    if (used_ + bytes > room_) {
      room_ = std::max<std::size_t>({2 * room_, used_ + bytes, std::size_t{1} << 16});
      auto bigger = std::make_unique_for_overwrite<std::byte[]>(room_);
      std::memcpy(bigger.get(), data_.get(), used_);
      data_ = std::move(bigger);
    }
    return data_.get() + used_;
  }
  void take(std::size_t bytes) { used_ += bytes; }
  void clear() { used_ = 0; }
  std::span<const std::byte> bytes() const { return {data_.get(), used_}; }

 private:
  std::unique_ptr<std::byte[]> data_ = std::make_unique_for_overwrite<std::byte[]>(16);
  std::size_t room_ = 16, used_ = 0;
};

struct ListBuilder::Part {
  struct Head {
    Footprint seen;
    std::uint32_t solid;
  };
  DepthBounds depths;
  std::array<std::vector<Head>, 2> heads;  // of all that is seen
  // By solid: how many tiles are to have it, these tiles, its record.
  std::array<std::array<Arena, kindCount>, 2> found;
  std::array<std::array<std::vector<std::uint32_t>, kindCount>, 2> tiles;  // entries by tile; then where the next goes
  bool grazing = false, farSphere = false, boxOnFace = false;
  std::size_t seen = 0;

  /// `hiding`: solids that are hidden are left out.
  void start(const ListGrid& grid, bool hiding);
  /// Where each solid is seen, and what the nearest hide; `crowd` tells how near that is.
  void look(std::span<const SolidEntry> solids, std::size_t from, std::size_t to, Footprints& footprints,
            const Crowd& crowd);
  /// When all depths are known so far: what the others hide that are not known to be hidden.
  void lookBehind(std::span<const SolidEntry> solids, Footprints& footprints);
  /// Records of the solids that are in front of the depth limit of one of their tiles, and not hidden in every pixel.
  void pack(const World& world, RealType type, bool eyeForms, const EyeFrames& eye);
  /// Copies every record to its tiles; tiles[][] says where each tile's next one goes.
  void write(std::byte* rows, std::size_t rowSize, bool eyeForms);

 private:
  class Packing;
  /// Room for a record of so many bytes, noted in the tiles that may see the solid.
  std::byte* add(std::size_t kind, std::size_t bytes, const Head& head, ListLevel level);
  void dropHidden();
  ListLimits limits(ListLevel level) const;

  ListGrid grid_;
  bool hiding_ = false;
};

}  // namespace solidcast
