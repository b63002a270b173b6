// The lists of shaders/lists.comp: for each tile of the screen the records of the solids that can be seen in it, laid
// out in the order they are walked. Most of a large picture's time is spent here, so the solids are gone over once, on
// all cores: seen or not, record, tiles; and a second time only over what is seen, to copy its record to its tiles.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "host/cast/list_sieve.h"
#include "host/cast/records.h"
#include "host/cast/silhouette.h"
#include "host/cast/workers.h"
#include "host/image/band.h"
#include "host/scene/world.h"

namespace solidcast {

/// Part of the image in tiles, and in wide tiles of `wide` x `wide` of them, for solids that would be in too many.
struct ListGrid {
  static constexpr int tile = Footprints::tile;
  Crop region;               // in pixels of the whole image
  int across = 0, down = 0;  // tiles; the planes' padding is covered as well
  // Chosen by collect():
  int wide = 16;
  std::uint64_t most = 256;  // a solid in more tiles is in wide ones alone
  int wideAcross() const { return (across + wide - 1) / wide; }
  int wideDown() const { return (down + wide - 1) / wide; }
  /// A wide tile's pixels, counted from the region's corner.
  Crop wideArea(int x, int y) const {
    const int side = wide * tile;
    return {x * side, y * side, std::min(side, across * tile - x * side), std::min(side, down * tile - y * side)};
  }
};

/// By lane of a dispatch, as lists.comp reads it.
struct ListLane {
  std::uint32_t x, y, unused[2];
};
struct ListSpan {
  std::uint32_t wideFirst, wideCount, first, count;  // rows; `count` is of both
};

/// The rows, and for the first `laneCount` of tiles() a ListLane and a ListSpan for each of `slots` (kinds in order).
struct ListRoom {
  std::span<std::byte> rows, lanes;
  std::size_t laneCount;
  std::array<bool, kindCount> slots;
};

class ListBuilder {
 public:
  struct Part;  // a thread's share of the solids
  struct Packs;
  ListBuilder();
  ~ListBuilder();

  /// Which solids are seen where, and their records: forms for the camera's one eye, correct to 2^-3 of the type's
  /// rounding (docs/numerics.md), or the solids themselves from the camera's centre, for rays that are free.
  /// `eye` is eyeFrame() of the scene, for forms of `type`, otherwise for f64.
  /// `room` is called when what is found is known; to what it says the lists are then written.
  void collect(const Scene& scene, const EyeFrame& eye, RealType type, bool eyeForms, const Silhouette& silhouette,
               const ListGrid& grid, const std::function<ListRoom()>& room);

  // What collect() found:
  std::array<bool, kindCount> kinds() const { return kinds_; }
  bool wideOnes() const { return wideOnes_; }  // some solids are in wide tiles
  bool grazing() const { return grazing_; }
  bool farSphere() const { return farSphere_; }
  bool boxOnFace() const { return boxOnFace_; }
  std::size_t rows() const { return rows_; }  // that the lists take
  std::size_t seen() const;                   // solids; counts them
  /// Tiles with solids, in the order of the dispatch, then the others in theirs. A dispatch may go beyond listedTiles(), never beyond all.
  std::span<const std::uint32_t> tiles() const { return order_; }
  std::size_t listedTiles() const { return listed_; }
  std::uint32_t longest() const { return longest_; }  // list of a tile

 private:
  struct Rounds;
  /// A thread's part of finding what is not hidden, in rounds of all threads.
  void sift(std::size_t thread, std::size_t threads, const Packs& packs, const DepthSlices& slices, Rounds& rounds,
            Footprints& footprints);
  void note(std::size_t patch);
  void sumUp();
  void layOut();
  void sortTiles();
  void write(const ListRoom& room, std::size_t thread, std::size_t threads);

  ListGrid grid_;
  RealType type_{};
  bool eyeForms_ = true;
  Workers workers_;
  std::vector<std::unique_ptr<Part>> parts_;
  std::vector<ListPatch> patches_;  // by wide tile
  TileLimits tileLimits_, wideLimits_;
  std::unique_ptr<SmallDisc[]> discs_;  // of a round's solids
  std::size_t discRoom_ = 0;
  std::array<bool, kindCount> kinds_{};
  bool grazing_ = false, farSphere_ = false, boxOnFace_ = false, wideOnes_ = false;
  std::size_t rows_ = 0, listed_ = 0;
  // [narrow 0 or wide 1][kind]: by tile, and for the wide ones the count beside
  std::array<std::array<std::vector<std::uint32_t>, kindCount>, 2> first_, count_;
  std::vector<std::uint32_t> next_;           // layOut's
  std::vector<std::uint32_t> total_, order_;  // entries by tile; tiles()
  std::uint32_t longest_ = 0;
};

}  // namespace solidcast
