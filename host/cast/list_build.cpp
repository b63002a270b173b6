#include "host/cast/list_build.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstring>
#include <exception>
#include <optional>
#include <utility>

#include "host/cast/list_packing.h"
#include "host/cast/list_part.h"
#include "host/cast/wide.h"

namespace solidcast {
namespace {

// Of all tiles, one after the other.
WIDE void addTo(std::uint32_t* sums, const std::uint32_t* counts, std::size_t tiles) {
  for (std::size_t i = 0; i < tiles; ++i) sums[i] += counts[i];
}
/// A part's counts become where its rows begin, after `next`, which goes on to where they end.
WIDE void place(std::uint32_t* counts, std::uint32_t* next, std::uint32_t rows, std::size_t tiles) {
  for (std::size_t i = 0; i < tiles; ++i) {
    const std::uint32_t entries = counts[i];
    counts[i] = next[i];
    next[i] += entries * rows;
  }
}

}  // namespace

ListBuilder::ListBuilder() {
  for (unsigned t = 0; t < workers_.threads(); ++t) parts_.push_back(std::make_unique<Part>());
}
ListBuilder::~ListBuilder() = default;

/// What the patch hides, for all of the picture.
void ListBuilder::note(std::size_t patch) {
  const DepthBounds& depths = patches_[patch].depths;
  const Crop& area = depths.area();
  for (int y = 0; y < area.height / ListGrid::tile; ++y)
    std::copy_n(depths.tiles().row(static_cast<std::size_t>(y)), area.width / ListGrid::tile,
                tileLimits_.row(static_cast<std::size_t>(area.y / ListGrid::tile + y)) + area.x / ListGrid::tile);
  wideLimits_.row(0)[patch] = depths.deepest();
}

/// What threads have together while they sift.
struct ListBuilder::Rounds {
  explicit Rounds(std::size_t threads) : together(threads) {}
  Meeting together;
  std::atomic<std::size_t> solid = 0;  // the next to look at
  std::atomic<std::size_t> next = 0;   // patch, of all rounds
};

namespace {
constexpr std::size_t firstRound = 131072, few = 16 * Footprints::block;
/// Where the round that begins there ends.
std::size_t roundEnd(std::size_t from, std::size_t solids) { return std::min(solids, std::max(firstRound, 4 * from)); }
std::size_t mostInRound(std::size_t solids) {
  std::size_t most = 0;
  for (std::size_t from = 0, to; from < solids; from = to)
    to = roundEnd(from, solids), most = std::max(most, to - from);
  return most;
}
}  // namespace

/// A round's solids are looked at a few at a time, then what is seen of them by patches, so that each of the threads writes
/// what is its own, and none waits for another. Few solids are one round; of many those of later rounds are dropped at once
/// where the earlier hide them.
void ListBuilder::sift(std::size_t thread, std::size_t threads, const Packs& packs, const DepthSlices& slices,
                       Rounds& rounds, Footprints& footprints) {
  const Solids& solids = packs.world.solids;
  Part& part = *parts_[thread];
  Sieve sieve(solids, footprints);
  std::vector<const std::vector<SeenWithin>*> narrowOnes(threads);
  std::vector<std::span<const ListHead>> wideOnes(threads);
  std::vector<ListHead> heads;
  ListPacking packing(part, narrow, tileLimits_, packs);
  std::size_t before = 0;  // what `next` had come to when the round began
  for (std::size_t from = 0, to; from < solids.size(); from = to) {
    to = roundEnd(from, solids.size());
    part.newWides = part.wides.size();
    for (std::size_t at; (at = rounds.solid.fetch_add(few)) < to;)
      part.lookForSieve(solids, at, std::min(at + few, to), footprints, slices, from == 0 ? nullptr : &tileLimits_,
                        discs_.get() + (at - from));
    rounds.together.wait();
    for (std::size_t i = rounds.next++; i < before + patches_.size(); i = rounds.next++) {
      const std::size_t at = i - before;
      ListPatch& patch = patches_[at];
      if (from == 0) {
        const int across = grid_.wideAcross(), x = static_cast<int>(at) % across, y = static_cast<int>(at) / across;
        patch.kept.clear();
        patch.depths.start(grid_.wideArea(x, y), grid_.region.width, grid_.region.height);
      }
      for (std::size_t t = 0; t < threads; ++t) wideOnes[t] = std::span(parts_[t]->wides).subspan(parts_[t]->newWides);
      for (std::size_t slice = 0; slice < DepthSlices::count; ++slice) {
        const std::size_t bin = slice * patches_.size() + at;
        for (std::size_t t = 0; t < threads; ++t) narrowOnes[t] = &parts_[t]->seenIn[bin];
        if (slices.from[slice] <= patch.depths.deepest())
          sieve.sift(patch, narrowOnes, wideOnes, slices, slice, {discs_.get(), from});
        for (std::size_t t = 0; t < threads; ++t) parts_[t]->seenIn[bin].clear();
      }
      note(at);
      if (to < solids.size()) continue;
      sieve.siftKept(patch);
      heads.clear();
      const Crop& area = patch.depths.area();
      for (const SeenWithin& s : patch.kept)
        heads.push_back(
            {{s.x0() + area.x, s.y0() + area.y, s.x1() + area.x, s.y1() + area.y, s.nearest(), 0, s.misses()},
             s.solid});
      packing.add(heads);
    }
    if (to == solids.size()) packing.finish();
    rounds.together.wait();
    before += patches_.size() + threads;  // each thread took one too many
    if (to == solids.size()) break;
    if (thread == 0) tileLimits_.widen(), rounds.solid = to;
    rounds.together.wait();
  }
}

void ListBuilder::collect(const Scene& scene, const EyeFrame& frame, RealType type, bool eyeForms,
                          const Silhouette& silhouette, const ListGrid& grid, const std::function<ListRoom()>& room) {
  grid_ = grid, type_ = type, eyeForms_ = eyeForms;
  const EyeFrames eye(frame);
  const World& world = scene.world;
  const std::size_t solids = world.solids.size(), threads = solids < 256 ? 1 : parts_.size();
  const bool canHide = silhouette.centresAlone() && solids > 64 && grid.region.width < (1 << 14);
  const bool hasUnit = eyeForms && type == RealType::f32;
  const DepthScale scale(canHide ? static_cast<float>(hasUnit ? frame.unit : eyeFrame(scene, RealType::f32).unit)
                                 : 1.f);
  const auto footprints = [&] { return Footprints(silhouette, grid.region, eye.plain, type, scale); };
  auto some = footprints();
  const ListSample sample(world.solids, some);
  const double left = canHide ? partLeft(sample, grid.region, type) : 1;
  const bool hiding = left < 1;
  chooseWide(grid_, sample, left);
  tileLimits_.start(static_cast<std::size_t>(grid_.across), static_cast<std::size_t>(grid_.down));
  wideLimits_.start(static_cast<std::size_t>(grid_.wideAcross()), static_cast<std::size_t>(grid_.wideDown()));
  patches_.resize(hiding ? static_cast<std::size_t>(grid_.wideAcross() * grid_.wideDown()) : 0);
  if (const std::size_t most = hiding ? mostInRound(solids) : 0; most > discRoom_)
    discs_ = std::make_unique_for_overwrite<SmallDisc[]>(most), discRoom_ = most;
  const Packs packs{world, type, eyeForms, eye};
  const DepthSlices slices = slicesOf(sample);
  Rounds rounds(threads);
  std::optional<ListRoom> to;
  std::exception_ptr failure;
  workers_.run(static_cast<int>(threads), [&](int at) {
    const auto t = static_cast<std::size_t>(at);
    Part& part = *parts_[t];
    for (std::size_t k = t; k < parts_.size(); k += threads) parts_[k]->start(grid_);
    auto own = footprints();
    if (hiding) sift(t, threads, packs, slices, rounds, own);
    else part.look(solids * t / threads, solids * (t + 1) / threads, own, tileLimits_, packs);
    const auto wideTile = [&](int pixel) { return static_cast<std::uint32_t>(pixel / (grid_.wide * ListGrid::tile)); };
    std::erase_if(part.wides, [&](const ListHead& head) {
      const Footprint& f = head.seen;
      return !wideLimits_.some(wideTile(f.x0), wideTile(f.y0), wideTile(f.x1), wideTile(f.y1), f.nearest);
    });
    ListPacking packing(part, wide, wideLimits_, packs);
    packing.add(part.wides);
    packing.finish();
    rounds.together.wait();
    if (t == 0) sumUp();
    rounds.together.wait();
    if (t == 0) layOut();
    if (t + 1 == threads) sortTiles();
    rounds.together.wait();
    try {
      if (t == 0) to = room();
    } catch (...) { failure = std::current_exception(); }
    rounds.together.wait();
    if (to) write(*to, t, threads);
  });
  if (failure) std::rethrow_exception(failure);
}

std::size_t ListBuilder::seen() const {
  std::vector<bool> is;
  std::size_t count = 0;
  for (const auto& part : parts_)
    for (const std::uint32_t solid : part->listed) {
      if (solid >= is.size()) is.resize(solid + std::size_t{1});
      count += !is[solid];
      is[solid] = true;
    }
  return count;
}

/// How many entries each tile has.
void ListBuilder::sumUp() {
  grazing_ = farSphere_ = boxOnFace_ = wideOnes_ = false;
  kinds_ = {};
  for (const auto& part : parts_) {
    grazing_ = grazing_ || part->grazing, farSphere_ = farSphere_ || part->farSphere;
    boxOnFace_ = boxOnFace_ || part->boxOnFace;
  }
  total_.assign(static_cast<std::size_t>(grid_.across) * static_cast<std::size_t>(grid_.down), 0);
  for (const ListLevel level : {wide, narrow})
    for (std::size_t kind = 0; kind < kindCount; ++kind) {
      auto& count = count_[level][kind];
      count.clear();
      for (const auto& part : parts_) {
        const auto& of = part->tiles[level][kind];
        if (of.empty()) continue;
        if (count.empty()) count = of;
        else addTo(count.data(), of.data(), of.size());
      }
      if (count.empty()) continue;
      kinds_[kind] = true;
      wideOnes_ = wideOnes_ || level == wide;
      if (level == narrow) addTo(total_.data(), count.data(), count.size());
      if (level == wide)
        for (std::size_t tile = 0, y = 0; y < static_cast<std::size_t>(grid_.down); ++y)
          for (std::size_t x = 0; x < static_cast<std::size_t>(grid_.across); ++x, ++tile)
            total_[tile] += count[y / grid_.wide * grid_.wideAcross() + x / grid_.wide];
    }
}

/// Kind by kind and tile by tile, each tile's entries in the order of the solids.
void ListBuilder::layOut() {
  rows_ = 0;
  for (const ListLevel level : {wide, narrow})
    for (std::size_t kind = 0; kind < kindCount; ++kind) {
      auto& first = first_[level][kind];
      const auto& count = count_[level][kind];
      const std::uint32_t rows = rowsOf(kind, eyeForms_);
      first.resize(count.size());
      for (std::size_t tile = 0; tile < count.size(); ++tile) {
        first[tile] = static_cast<std::uint32_t>(rows_);
        rows_ += std::size_t{count[tile]} * rows;
      }
      next_ = first;
      for (const auto& part : parts_)
        if (auto& of = part->tiles[level][kind]; !of.empty()) place(of.data(), next_.data(), rows, of.size());
    }
}

/// By blocks of 16x16 tiles, in which the longest come first: lanes of a vector end together, and what neighbours read and
/// write is near. llvmpipe deals a dispatch to its threads in as many stretches as these are: so every stretch gets blocks
/// from all over the picture.
void ListBuilder::sortTiles() {
  constexpr std::size_t side = 16, stretches = 16, most = 64;
  const auto across = static_cast<std::size_t>(grid_.across), down = static_cast<std::size_t>(grid_.down);
  const std::size_t blocksAcross = (across + side - 1) / side, blocks = blocksAcross * ((down + side - 1) / side);
  order_.resize(total_.size());
  std::uint32_t* to = order_.data();
  longest_ = 0;
  for (std::size_t stretch = 0; stretch < stretches; ++stretch)
    for (std::size_t block = stretch; block < blocks; block += stretches) {
      const std::size_t x0 = block % blocksAcross * side, y0 = block / blocksAcross * side;
      const std::size_t x1 = std::min(x0 + side, across), y1 = std::min(y0 + side, down);
      std::array<std::uint32_t, most + 1> start{};
      const auto place = [&](std::size_t at) { return most - std::min<std::size_t>(total_[at], most); };
      for (std::size_t y = y0; y < y1; ++y)
        for (std::size_t x = x0; x < x1; ++x) {
          ++start[place(y * across + x)];
          longest_ = std::max(longest_, total_[y * across + x]);
        }
      std::uint32_t before = 0;
      for (std::uint32_t& of : start) before += std::exchange(of, before);
      const std::uint32_t listed = start[most], large = start[1];
      for (std::size_t y = y0; y < y1; ++y)
        for (std::size_t x = x0; x < x1; ++x) {
          const std::size_t at = y * across + x;
          to[start[place(at)]++] = static_cast<std::uint32_t>(at);
        }
      std::sort(to, to + large, [&](std::uint32_t a, std::uint32_t b) { return total_[a] > total_[b]; });
      to += listed;  // the others are overwritten
    }
  listed_ = static_cast<std::size_t>(to - order_.data());
  for (std::uint32_t tile = 0; tile < total_.size() && to != order_.data() + order_.size(); ++tile) {
    *to = tile;
    to += total_[tile] == 0;
  }
}

/// A thread's share.
void ListBuilder::write(const ListRoom& room, std::size_t thread, std::size_t threads) {
  std::size_t laneBytes = sizeof(ListLane);
  for (const bool slot : room.slots) laneBytes += slot ? sizeof(ListSpan) : 0;
  const auto value = [](const std::vector<std::uint32_t>& of, std::size_t i) { return of.empty() ? 0 : of[i]; };
  const std::uint32_t across = grid_.across, wideAcross = grid_.wideAcross();
  const int wideShift = std::countr_zero(static_cast<std::uint32_t>(grid_.wide));
  for (std::size_t lane = room.laneCount * thread / threads; lane < room.laneCount * (thread + 1) / threads; ++lane) {
    const std::uint32_t tile = order_[lane], x = tile % across, y = tile / across;
    const std::uint32_t wideTile = (y >> wideShift) * wideAcross + (x >> wideShift);
    std::byte* to = room.lanes.data() + lane * laneBytes;
    const ListLane head{x * ListGrid::tile, y * ListGrid::tile, {}};
    std::memcpy(to, &head, sizeof head);
    to += sizeof head;
    for (std::size_t kind = 0; kind < kindCount; ++kind) {
      if (!room.slots[kind]) continue;
      const std::uint32_t wideCount = value(count_[wide][kind], wideTile);
      const ListSpan span{value(first_[wide][kind], wideTile), wideCount, value(first_[narrow][kind], tile),
                          wideCount + value(count_[narrow][kind], tile)};
      std::memcpy(to, &span, sizeof span);
      to += sizeof span;
    }
  }
  for (std::size_t part = thread; part < parts_.size(); part += threads)
    parts_[part]->write(room.rows.data(), rowBytes(type_), eyeForms_);
}

}  // namespace solidcast
