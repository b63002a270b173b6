#include "host/cast/list_layout.h"

#include <bit>
#include <utility>

#include "host/cast/wide.h"

namespace solidcast {
namespace {

constexpr std::uint32_t rowsOfKind[kindCount][2] = {
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) {WORLD_ROWS, EYE_ROWS},
#include "shaders/solids.def"
#undef SOLID
};
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  static_assert(EYE_ROWS >= 2 && EYE_ROWS <= 5 && WORLD_ROWS >= 2 && WORLD_ROWS <= 5, "copy() knows these");
#include "shaders/solids.def"
#undef SOLID

// Of known size, a record is copied by a few vector moves: a sixth of all the time was memcpy's.
template <std::size_t ROW_SIZE, std::size_t ROWS>
void copyAs(std::span<const ListEntry> entries, std::byte* rows, std::uint32_t* next, bool scattered) {
  constexpr std::size_t ahead = 16;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (scattered && i + ahead < entries.size()) {
      const ListEntry& later = entries[i + ahead];
      __builtin_prefetch(later.record);
      __builtin_prefetch(rows + std::size_t{next[later.tile]} * ROW_SIZE, 1);
    }
    const ListEntry& entry = entries[i];
    std::uint32_t& to = next[entry.tile];
    std::memcpy(rows + std::size_t{to} * ROW_SIZE, entry.record, ROW_SIZE * ROWS);
    to += ROWS;
  }
}

template <std::size_t ROW_SIZE>
void copyRows(std::span<const ListEntry> entries, std::uint32_t rowCount, std::byte* rows, std::uint32_t* next,
              bool scattered) {
  if (rowCount == 2) copyAs<ROW_SIZE, 2>(entries, rows, next, scattered);
  else if (rowCount == 3) copyAs<ROW_SIZE, 3>(entries, rows, next, scattered);
  else if (rowCount == 4) copyAs<ROW_SIZE, 4>(entries, rows, next, scattered);
  else copyAs<ROW_SIZE, 5>(entries, rows, next, scattered);
}

/// Each record to the row that `next` says of its tile, which goes on. `scattered`: the tiles are all over the picture, so that
/// places and records are in no cache, and worth fetching ahead.
void copy(std::span<const ListEntry> entries, std::size_t rowSize, std::uint32_t rowCount, std::byte* rows,
          std::uint32_t* next, bool scattered) {
  if (rowSize == 16) copyRows<16>(entries, rowCount, rows, next, scattered);
  else copyRows<32>(entries, rowCount, rows, next, scattered);
}

WIDE void addTo(std::uint32_t* sums, const std::uint32_t* counts, std::size_t tiles) {
  for (std::size_t i = 0; i < tiles; ++i) sums[i] += counts[i];
}

}  // namespace

std::uint32_t rowsOf(std::size_t kind, bool eyeForms) { return rowsOfKind[kind][eyeForms]; }

void ListLayout::start(const ListGrid& grid, std::size_t threads, bool eyeForms) {
  grid_ = grid, eyeForms_ = eyeForms;
  shift_ = std::countr_zero(static_cast<unsigned>(grid.wide));
  while (shares_.size() < threads) shares_.push_back(std::make_unique<Share>());
  shares_.resize(threads);
  const auto patches = static_cast<std::size_t>(grid.wideAcross() * grid.wideDown()), tiles = patches << 2 * shift_;
  for (std::size_t kind = 0; kind < kindCount; ++kind) counts_[kind].room(tiles), firsts_[kind].room(tiles);
  patchKinds_.resize(patches), patchLongest_.resize(patches), patchRows_.resize(patches);
  isListed_.resize(static_cast<std::size_t>(grid.across) * static_cast<std::size_t>(grid.down));
  ordered_.room(blocks() * blockTiles);
  listedIn_.resize(blocks());
}

/// Rows of a wide tile within the picture: row(tile of all, row by row, tile of the wide one, how many).
void ListLayout::forEachRow(std::size_t patch, auto&& row) const {
  const auto wideAcross = static_cast<std::size_t>(grid_.wideAcross()), side = std::size_t{1} << shift_;
  const auto across = static_cast<std::size_t>(grid_.across), down = static_cast<std::size_t>(grid_.down);
  const std::size_t x = patch % wideAcross * side, y = patch / wideAcross * side;
  for (std::size_t k = 0; k < std::min(side, down - y); ++k)
    row((y + k) * across + x, k * side, std::min(side, across - x));
}

void ListLayout::Share::Spread::clear() {
  for (std::size_t kind = 0; kind < kindCount; ++kind) entries[kind].clear(), tiles[kind].clear();
}

void ListLayout::Share::start(ListLayout& layout) {
  layout_ = &layout;
  for (auto& of : entries_) of.clear();
  patches_.clear(), anywhere_.clear(), wide_.clear();
}

void ListLayout::Share::begin(std::size_t patch) { patch_ = patch, kinds_ = 0; }

namespace {

/// A rectangle's tiles that may see what begins at `nearest`; `misses` as in Footprint. In rows of `across`.
struct Tiles {
  std::uint32_t x0, y0, x1, y1;
  DepthCode nearest;
  std::uint32_t misses;
};
/// A null `limits`: all of them may.
inline __attribute__((always_inline)) bool list(const Tiles& t, std::size_t across, const TileLimits* limits,
                                                const std::byte* record, Pile<ListEntry>& entries,
                                                std::uint32_t* counts) {
  const std::uint32_t moreX = t.x1 - t.x0, moreY = t.y1 - t.y0;
  ListEntry* const start = entries.room(std::max<std::size_t>(4, std::size_t{moreX + 1} * (moreY + 1)));
  ListEntry* to = start;
  const auto rowOf = [&](std::size_t y) { return limits ? limits->row(y) : nullptr; };
  const auto mayIn = [&](const DepthCode* row, std::size_t x) { return !limits || t.nearest <= row[x]; };
  // No branches: a third of the tiles see nothing of what they lie beside.
  const auto tile = [&](std::size_t at, std::uint32_t sees) {
    *to = {record, static_cast<std::uint32_t>(at)};
    to += sees;
    counts[at] += sees;
  };
  if ((moreX | moreY) <= 1) {
    const DepthCode *upper = rowOf(t.y0), *lower = rowOf(t.y1);
    const std::size_t first = t.y0 * across + t.x0, below = first + (moreY ? across : 0);
    tile(first, ~t.misses & mayIn(upper, t.x0));
    tile(first + moreX, ~t.misses >> 1 & moreX & mayIn(upper, t.x1));
    tile(below, ~t.misses >> 2 & moreY & mayIn(lower, t.x0));
    tile(below + moreX, ~t.misses >> 3 & moreX & moreY & mayIn(lower, t.x1));
  } else {
    for (std::size_t y = t.y0; y <= t.y1; ++y)
      for (std::size_t x = t.x0; x <= t.x1; ++x) tile(y * across + x, mayIn(rowOf(y), x));
  }
  entries.take(static_cast<std::size_t>(to - start));
  return to != start;
}

}  // namespace

bool ListLayout::Share::add(std::size_t kind, const std::byte* record, const SeenWithin& s, const TileLimits& limits) {
  const int shift = layout_->shift_;
  std::uint32_t* const counts = layout_->counts_[kind].room(0) + (patch_ << 2 * shift);
  if (!(kinds_ >> kind & 1)) kinds_ |= 1u << kind, std::fill_n(counts, std::size_t{1} << 2 * shift, 0);
  constexpr std::uint32_t side = ListGrid::tile;
  const Tiles tiles{(s.first & 0xffff) / side,
                    (s.first >> 16) / side,
                    (s.last & 0xffff) / side,
                    (s.last >> 16) / side,
                    s.nearest(),
                    s.misses()};
  return list(tiles, std::size_t{1} << shift, &limits, record, entries_[kind], counts);
}

inline __attribute__((always_inline)) bool ListLayout::Share::Spread::add(std::size_t kind, const std::byte* record,
                                                                          const Footprint& f, int shift,
                                                                          std::size_t across, std::size_t down,
                                                                          const TileLimits* limits) {
  if (tiles[kind].empty()) tiles[kind].assign(across * down, 0);
  const auto of = [shift](std::int32_t pixel) { return static_cast<std::uint32_t>(pixel) >> shift; };
  return list({of(f.x0), of(f.y0), of(f.x1), of(f.y1), f.nearest, f.misses}, across, limits, record, entries[kind],
              tiles[kind].data());
}

constexpr int tileShift = std::countr_zero(static_cast<unsigned>(ListGrid::tile));
bool ListLayout::Share::addAnywhere(std::size_t kind, const std::byte* record, const Footprint& seen) {
  const ListGrid& grid = layout_->grid_;
  return anywhere_.add(kind, record, seen, tileShift, static_cast<std::size_t>(grid.across),
                       static_cast<std::size_t>(grid.down), nullptr);
}
bool ListLayout::Share::addWide(std::size_t kind, const std::byte* record, const Footprint& seen,
                                const TileLimits& limits) {
  const ListGrid& grid = layout_->grid_;
  return wide_.add(kind, record, seen, tileShift + layout_->shift_, static_cast<std::size_t>(grid.wideAcross()),
                   static_cast<std::size_t>(grid.wideDown()), &limits);
}

void ListLayout::Share::finish(bool wideOnes) {
  Patch patch{patch_, {}};
  for (std::size_t kind = 0; kind < kindCount; ++kind) patch.end[kind] = entries_[kind].size();
  patches_.push_back(patch);
  layOut(wideOnes);
}

void ListLayout::Share::gather(std::size_t patch, bool wideOnes) {
  ListLayout& of = *layout_;
  begin(patch);
  const std::size_t tiles = std::size_t{1} << 2 * of.shift_, begin = patch * tiles;
  for (std::size_t kind = 0; kind < kindCount; ++kind) {
    std::uint32_t* const counts = of.counts_[kind].room(0) + begin;
    for (const auto& share : of.shares_) {
      const auto& from = share->anywhere_.tiles[kind];
      if (from.empty()) continue;
      if (!(kinds_ >> kind & 1)) kinds_ |= 1u << kind, std::fill_n(counts, tiles, 0);
      of.forEachRow(patch, [&](std::size_t at, std::size_t own, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) counts[own + i] += from[at + i];
      });
    }
  }
  layOut(wideOnes);
  for (std::size_t kind = 0; kind < kindCount; ++kind) {
    if (!(kinds_ >> kind & 1)) continue;
    const std::uint32_t each = rowsOf(kind, of.eyeForms_);
    next_.assign(of.firsts_[kind].data() + begin, of.firsts_[kind].data() + begin + tiles);
    for (const auto& share : of.shares_) {
      auto& from = share->anywhere_.tiles[kind];
      if (from.empty()) continue;
      of.forEachRow(patch, [&](std::size_t at, std::size_t own, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) next_[own + i] += each * std::exchange(from[at + i], next_[own + i]);
      });
    }
  }
}

/// Where the wide tile's rows begin among its own, and the order of its tiles.
void ListLayout::Share::layOut(bool wideOnes) {
  ListLayout& of = *layout_;
  const std::size_t side = std::size_t{1} << of.shift_, tiles = side * side, at = patch_ * tiles;
  std::uint32_t rows = 0;
  next_.assign(tiles, 0);  // entries of all kinds
  for (std::size_t kind = 0; kind < kindCount; ++kind) {
    if (!(kinds_ >> kind & 1)) continue;
    const std::uint32_t* counts = of.counts_[kind].data() + at;
    std::uint32_t* first = of.firsts_[kind].room(0) + at;
    const std::uint32_t each = rowsOf(kind, of.eyeForms_);
    for (std::size_t i = 0; i < tiles; ++i) first[i] = rows, rows += counts[i] * each;
    addTo(next_.data(), counts, tiles);
  }
  of.patchKinds_[patch_] = kinds_;
  of.patchRows_[patch_] = rows;
  of.patchLongest_[patch_] = *std::max_element(next_.begin(), next_.end());
  const auto wideAcross = static_cast<std::size_t>(of.grid_.wideAcross());
  const std::size_t x0 = patch_ % wideAcross * side, y0 = patch_ / wideAcross * side;
  const std::size_t x1 = std::min<std::size_t>(x0 + side, static_cast<std::size_t>(of.grid_.across));
  const std::size_t y1 = std::min<std::size_t>(y0 + side, static_cast<std::size_t>(of.grid_.down));
  for (std::size_t y = y0; y < y1; y += blockSide)
    for (std::size_t x = x0; x < x1; x += blockSide)
      sortBlock(x, y, next_.data() + (y - y0) * side + (x - x0), wideOnes);
}

/// The longest lists first: lanes of a vector end together. `total`: of the block's first tile.
void ListLayout::Share::sortBlock(std::size_t x0, std::size_t y0, const std::uint32_t* total, bool wideOnes) {
  ListLayout& of = *layout_;
  constexpr std::size_t most = 64;
  const auto across = static_cast<std::size_t>(of.grid_.across), down = static_cast<std::size_t>(of.grid_.down);
  const std::size_t side = std::size_t{1} << of.shift_, block = y0 / blockSide * of.blocksAcross() + x0 / blockSide;
  const std::size_t width = std::min(blockSide, across - x0), height = std::min(blockSide, down - y0);
  std::array<std::uint32_t, most + 1> start{};
  const auto place = [&](std::uint32_t entries) { return most - std::min<std::size_t>(entries, most); };
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) ++start[place(total[y * side + x])];
  std::uint32_t before = 0;
  for (std::uint32_t& one : start) before += std::exchange(one, before);
  std::uint32_t* const to = of.ordered_.room(0) + block * blockTiles;
  const std::uint32_t large = start[1];
  of.listedIn_[block] = wideOnes ? before : start[most];
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::uint32_t entries = total[y * side + x];
      const std::size_t tile = (y0 + y) * across + x0 + x;
      of.isListed_[tile] = wideOnes | (entries > 0);
      to[start[place(entries)]++] = static_cast<std::uint32_t>(tile);
    }
  const auto entriesOf = [&](std::uint32_t tile) { return total[(tile / across - y0) * side + tile % across - x0]; };
  std::sort(to, to + large, [&](std::uint32_t a, std::uint32_t b) { return entriesOf(a) > entriesOf(b); });
}

/// Kind by kind and wide tile by wide tile, each one's entries in the order of the solids: thread by thread.
void ListLayout::layOutWide() {
  for (std::size_t kind = 0; kind < kindCount; ++kind) {
    auto& count = wideCount_[kind];
    count.clear();
    for (const auto& share : shares_) {
      const auto& of = share->wide_.tiles[kind];
      if (of.empty()) continue;
      kinds_[kind] = wideOnes_ = true;
      count.resize(of.size());
      addTo(count.data(), of.data(), of.size());
    }
    wideFirst_[kind].resize(count.size());
    for (std::size_t patch = 0; patch < count.size(); ++patch) {
      wideFirst_[kind][patch] = static_cast<std::uint32_t>(rows_);
      for (const auto& share : shares_)
        if (auto& next = share->wide_.tiles[kind]; !next.empty())
          rows_ += std::exchange(next[patch], static_cast<std::uint32_t>(rows_)) * rowsOf(kind, eyeForms_);
      patchLongest_[patch] += count[patch];
    }
  }
}

/// llvmpipe deals a dispatch to its threads in as many stretches as these are: so every stretch gets blocks from all over the
/// picture.
void ListLayout::forEachBlock(auto&& block) const {
  constexpr std::size_t stretches = 16;
  for (std::size_t stretch = 0; stretch < stretches; ++stretch)
    for (std::size_t at = stretch; at < blocks(); at += stretches) block(at);
}

void ListLayout::layOut() {
  rows_ = listed_ = 0;
  kinds_ = {}, wideOnes_ = false;
  layOutWide();
  std::uint32_t kinds = 0;
  for (std::size_t patch = 0; patch < patchRows_.size(); ++patch) {
    kinds |= patchKinds_[patch];
    rows_ += std::exchange(patchRows_[patch], rows_);
  }
  for (std::size_t kind = 0; kind < kindCount; ++kind) kinds_[kind] = kinds_[kind] || kinds >> kind & 1;
  longest_ = *std::max_element(patchLongest_.begin(), patchLongest_.end());
  for (const std::uint32_t listed : listedIn_) listed_ += listed;
}

void ListLayout::order() {
  order_.resize(isListed_.size());
  std::uint32_t* to = order_.data();
  forEachBlock([&](std::size_t at) { to = std::copy_n(ordered_.data() + at * blockTiles, listedIn_[at], to); });
  for (std::uint32_t tile = 0; to != order_.data() + order_.size(); ++tile) {
    *to = tile;
    to += !isListed_[tile];
  }
}

void ListLayout::writeLanes(const ListRoom& room, std::size_t from, std::size_t to) const {
  std::size_t laneBytes = sizeof(ListLane);
  for (const bool slot : room.slots) laneBytes += slot ? sizeof(ListSpan) : 0;
  const auto across = static_cast<std::uint32_t>(grid_.across),
             wideAcross = static_cast<std::uint32_t>(grid_.wideAcross());
  const std::uint32_t inside = (1u << shift_) - 1;
  std::byte* at = room.lanes.data() + from * laneBytes;
  for (std::size_t lane = from; lane < to; ++lane) {
    const std::uint32_t tile = order_[lane], x = tile % across, y = tile / across;
    const std::size_t patch = (y >> shift_) * wideAcross + (x >> shift_);
    const std::size_t number = patch << 2 * shift_ | (y & inside) << shift_ | (x & inside);
    const ListLane head{x * ListGrid::tile, y * ListGrid::tile, {}};
    std::memcpy(at, &head, sizeof head);
    at += sizeof head;
    for (std::size_t kind = 0; kind < kindCount; ++kind) {
      if (!room.slots[kind]) continue;
      ListSpan span{};
      if (!wideCount_[kind].empty())
        span = {wideFirst_[kind][patch], wideCount_[kind][patch], 0, wideCount_[kind][patch]};
      if (patchKinds_[patch] >> kind & 1) {
        span.first = static_cast<std::uint32_t>(patchRows_[patch]) + firsts_[kind].data()[number];
        span.count += counts_[kind].data()[number];
      }
      std::memcpy(at, &span, sizeof span);
      at += sizeof span;
    }
  }
}

/// A thread's share.
void ListLayout::write(const ListRoom& room, std::size_t rowSize, std::size_t thread, std::size_t threads) {
  writeLanes(room, room.laneCount * thread / threads, room.laneCount * (thread + 1) / threads);
  Share& share = *shares_[thread];
  const std::size_t tiles = std::size_t{1} << 2 * shift_;
  share.next_.resize(tiles);
  for (std::size_t kind = 0; kind < kindCount; ++kind) {
    const auto copyOf = [&](const Pile<ListEntry>& entries, std::size_t from, std::size_t to, std::uint32_t* next,
                            bool scattered) {
      copy({entries.data() + from, to - from}, rowSize, rowsOf(kind, eyeForms_), room.rows.data(), next, scattered);
    };
    std::size_t from = 0;
    for (const Share::Patch& patch : share.patches_) {
      if (from == patch.end[kind]) continue;
      const std::uint32_t *first = firsts_[kind].data() + patch.number * tiles,
                          before = static_cast<std::uint32_t>(patchRows_[patch.number]);
      for (std::size_t i = 0; i < tiles; ++i) share.next_[i] = first[i] + before;
      copyOf(share.entries_[kind], from, patch.end[kind], share.next_.data(), false);
      from = patch.end[kind];
    }
    if (auto& next = share.anywhere_.tiles[kind]; !next.empty()) {
      for (std::size_t patch = 0; patch < patchRows_.size(); ++patch)
        forEachRow(patch, [&](std::size_t at, std::size_t, std::size_t count) {
          for (std::size_t i = 0; i < count; ++i) next[at + i] += static_cast<std::uint32_t>(patchRows_[patch]);
        });
    }
    for (Share::Spread* spread : {&share.anywhere_, &share.wide_})
      copyOf(spread->entries[kind], 0, spread->entries[kind].size(), spread->tiles[kind].data(), true);
  }
}

}  // namespace solidcast
