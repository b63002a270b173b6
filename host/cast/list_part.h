// A thread's share of list building: the solids of one stretch of the scene, in their order.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "host/cast/list_build.h"
#include "host/cast/list_sieve.h"

namespace solidcast {

enum ListLevel : std::size_t { narrow, wide };

/// Rows of a kind's record: for one eye, or of the solid itself, for rays that are free.
std::uint32_t rowsOf(std::size_t kind, bool eyeForms);

/// Sets the grid's wide tiles and `most` to what costs least of what takes no more than 128 MiB for copies of records, if that
/// can be. `left`: the part of the solids that is to be listed; 1: none are sifted out.
void chooseWide(ListGrid& grid, const ListSample& sample, double left);

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

/// What a picture's records are made for.
struct ListBuilder::Packs {
  const World& world;
  RealType type;
  bool eyeForms;
  const EyeFrames& eye;
};

struct ListBuilder::Part {
  // Where hidden solids are looked for: of a round's solids what is seen, by slice and wide tile.
  std::vector<std::vector<SeenWithin>> seenIn;
  std::vector<ListHead> wides;  // that are listed in wide tiles
  std::size_t newWides = 0;     // the first of the round
  // By solid: how many tiles are to have it, these tiles, its record.
  std::array<std::array<Arena, kindCount>, 2> found;
  std::array<std::array<std::vector<std::uint32_t>, kindCount>, 2> tiles;  // entries by tile; then where the next goes
  bool grazing = false, farSphere = false, boxOnFace = false;
  std::vector<std::uint32_t> listed;  // solids, some more than once

  void start(const ListGrid& grid);
  /// Records of those that are seen, and of the wide ones where.
  void look(std::size_t from, std::size_t to, Footprints& footprints, const TileLimits& limits, const Packs& packs);
  /// Where each is seen; to seenIn, but for the wide ones, and without those that `limits` hide. `discs`: of the spheres, from `from` on.
  void lookForSieve(const Solids& solids, std::size_t from, std::size_t to, Footprints& footprints,
                    const DepthSlices& slices, const TileLimits* limits, SmallDisc* discs);
  /// Room for a solid's record of so many bytes, noted in those of its tiles that may see it by `limits`.
  std::byte* add(std::size_t kind, std::size_t bytes, const ListHead& head, ListLevel level, const TileLimits& limits);
  /// Copies every record to its tiles; tiles[][] says where each tile's next one goes.
  void write(std::byte* rows, std::size_t rowSize, bool eyeForms);

 private:
  ListGrid grid_;
};

}  // namespace solidcast
