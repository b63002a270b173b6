// From what is listed where to the rows and lanes that shaders/lists.comp reads. Each wide tile's lists are one thread's from
// its solids to where its rows begin among its own; only where the wide tiles' rows begin is put together at the end.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/cast/list_grid.h"
#include "host/cast/pile.h"

namespace solidcast {

/// A record that a tile, or wide tile, is to have.
struct ListEntry {
  const std::byte* record;
  std::uint32_t tile;
};

/// Records, which stay where they are.
class RecordStore {
 public:
  static constexpr std::size_t most = 5 * 32;  // bytes of one

  std::byte* room() {
    if (used_ + most > chunk) ++at_, used_ = 0;
    if (at_ == chunks_.size()) chunks_.push_back(std::make_unique_for_overwrite<std::byte[]>(chunk));
    return chunks_[at_].get() + used_;
  }
  void take(std::size_t bytes) { used_ += bytes; }
  void clear() { at_ = used_ = 0; }

 private:
  static constexpr std::size_t chunk = 1 << 18;
  std::vector<std::unique_ptr<std::byte[]>> chunks_;
  std::size_t at_ = 0, used_ = 0;
};

/// Rows of a kind's record: for one eye, or of the solid itself, for rays that are free.
std::uint32_t rowsOf(std::size_t kind, bool eyeForms);

class ListLayout {
 public:
  /// What a thread lists. Either wide tile by wide tile, each of them one thread's (begin, add, finish), or its solids wherever
  /// they are (addAnywhere), and then the wide tiles are put together from all threads' (gather).
  class Share {
   public:
    void start(ListLayout& layout);
    /// What is added is of this wide tile.
    void begin(std::size_t patch);
    /// In those of the tiles that may see it by `limits`, which are the wide tile's; whether there are any.
    bool add(std::size_t kind, const std::byte* record, const SeenWithin& seen, const TileLimits& limits);
    /// `wideOnes`: some solid is listed for the wide tile as a whole.
    void finish(bool wideOnes);

    /// In all its tiles: nothing hides.
    bool addAnywhere(std::size_t kind, const std::byte* record, const Footprint& seen);
    void gather(std::size_t patch, bool wideOnes);

    /// One that is listed for wide tiles as a whole; `limits`: of all of these.
    bool addWide(std::size_t kind, const std::byte* record, const Footprint& seen, const TileLimits& limits);

   private:
    friend ListLayout;
    struct Patch {
      std::size_t number;
      std::array<std::size_t, kindCount> end;  // of its entries
    };
    /// Of all tiles, or of all wide tiles, row by row.
    struct Spread {
      std::array<Pile<ListEntry>, kindCount> entries;
      // By tile: how many; then where the next goes. Empty: the kind is not there.
      std::array<std::vector<std::uint32_t>, kindCount> tiles;
      void clear();
      bool add(std::size_t kind, const std::byte* record, const Footprint& seen, int shift, std::size_t across,
               std::size_t down, const TileLimits* limits);
    };
    void layOut(bool wideOnes);
    void sortBlock(std::size_t x0, std::size_t y0, const std::uint32_t* total, bool wideOnes);

    ListLayout* layout_ = nullptr;
    std::array<Pile<ListEntry>, kindCount> entries_;  // wide tile by wide tile
    std::vector<Patch> patches_;
    Spread anywhere_, wide_;
    std::size_t patch_ = 0;
    std::uint32_t kinds_ = 0;  // of the wide tile, bits
    std::vector<std::uint32_t> next_;
  };

  void start(const ListGrid& grid, std::size_t threads, bool eyeForms);
  Share& share(std::size_t thread) { return *shares_[thread]; }

  /// When all wide tiles are finished, by one thread; then order() and the rest.
  void layOut();
  /// May be called by another thread while this one goes on.
  void order();
  void write(const ListRoom& room, std::size_t rowSize, std::size_t thread, std::size_t threads);

  std::array<bool, kindCount> kinds() const { return kinds_; }
  bool wideOnes() const { return wideOnes_; }
  std::size_t rows() const { return rows_; }
  std::size_t listedTiles() const { return listed_; }
  std::uint32_t longest() const { return longest_; }
  std::span<const std::uint32_t> tiles() const { return order_; }

 private:
  static constexpr std::size_t blockSide = 16, blockTiles = blockSide * blockSide;
  std::size_t blocksAcross() const { return (static_cast<std::size_t>(grid_.across) + blockSide - 1) / blockSide; }
  std::size_t blocks() const {
    return blocksAcross() * ((static_cast<std::size_t>(grid_.down) + blockSide - 1) / blockSide);
  }
  void layOutWide();
  void forEachBlock(auto&& block) const;
  void forEachRow(std::size_t patch, auto&& row) const;
  void writeLanes(const ListRoom& room, std::size_t from, std::size_t to) const;

  ListGrid grid_;
  bool eyeForms_ = true;
  int shift_ = 0;  // of wide tiles' sides in tiles
  std::vector<std::unique_ptr<Share>> shares_;
  // By tile, wide tile by wide tile, where the kind is in it: entries, and rows before them among the wide tile's.
  std::array<Pile<std::uint32_t>, kindCount> counts_, firsts_;
  std::vector<std::uint32_t> patchKinds_, patchLongest_;
  std::vector<std::size_t> patchRows_;  // how many; then where they begin
  std::array<std::vector<std::uint32_t>, kindCount> wideCount_, wideFirst_;
  std::vector<std::uint8_t> isListed_;   // by tile, row by row
  Pile<std::uint32_t> ordered_;          // block by block, the listed ones
  std::vector<std::uint32_t> listedIn_;  // blocks
  std::array<bool, kindCount> kinds_{};
  bool wideOnes_ = false;
  std::size_t rows_ = 0, listed_ = 0;
  std::uint32_t longest_ = 0;
  std::vector<std::uint32_t> order_;
};

}  // namespace solidcast
