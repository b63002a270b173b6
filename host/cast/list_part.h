// A thread's share of list building: of the solids that it looks at what is seen, and where.
#pragma once
#include <cstdint>
#include <vector>

#include "host/cast/list_grid.h"
#include "host/cast/list_layout.h"
#include "host/cast/list_packing.h"
#include "host/cast/list_sieve.h"

namespace solidcast {

/// Sets the grid's wide tiles and `most` to what costs least of what takes no more than 128 MiB for copies of records, if that
/// can be. `left`: the part of the solids that is to be listed; 1: none are sifted out.
void chooseWide(ListGrid& grid, const ListSample& sample, double left);

struct ListPart {
  // Where hidden solids are looked for: of a round's solids what is seen, by slice and wide tile.
  std::vector<std::vector<SeenWithin>> seenIn;
  std::vector<ListHead> wides;  // that are listed in wide tiles
  std::size_t newWides = 0;     // the first of the round
  RecordStore records;
  ListFlags flags;
  bool farSphere = false;
  std::vector<std::uint32_t> listed;  // solids, some more than once

  /// Where a solid's record of so many bytes is to be written, which is kept if it is listed: list(record).
  std::byte* record(std::uint32_t solid, std::size_t bytes, auto&& list) {
    std::byte* const at = records.room();
    if (list(at)) records.take(bytes), listed.push_back(solid);
    return at;
  }

  void start(const ListGrid& grid);
  /// Lists those that are seen, and of the wide ones where. `limits`: of all tiles.
  void look(std::size_t from, std::size_t to, Footprints& footprints, const ListPacks& packs, ListLayout::Share& share);
  /// Where each is seen, without those that `limits` hide. `discs`: of the spheres, from `from` on.
  void lookForSieve(const Solids& solids, std::size_t from, std::size_t to, Footprints& footprints,
                    const DepthSlices& slices, const TileLimits* limits, SmallDisc* discs);

 private:
  ListGrid grid_;
};

}  // namespace solidcast
