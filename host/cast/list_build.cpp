#include "host/cast/list_build.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <optional>

namespace solidcast {

ListBuilder::ListBuilder() {
  for (unsigned t = 0; t < workers_.threads(); ++t) parts_.push_back(std::make_unique<ListPart>());
}
ListBuilder::~ListBuilder() = default;

/// What threads have together.
struct ListBuilder::Shared {
  const ListPacks& packs;
  const DepthSlices& slices;
  std::size_t threads;
  Meeting together{threads};
  std::atomic<std::size_t> solid = 0;  // the next to look at
  std::atomic<std::size_t> next = 0;   // wide tile, of all rounds
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

/// What the wide tile hides, for all of the picture.
void ListBuilder::note(std::size_t patch, const DepthBounds& depths) {
  const Crop& area = depths.area();
  wideLimits_.row(0)[patch] = depths.deepest();
  if (patches_.empty()) return;  // one round
  for (int y = 0; y < area.height / ListGrid::tile; ++y)
    std::copy_n(depths.tiles().row(static_cast<std::size_t>(y)), area.width / ListGrid::tile,
                tileLimits_.row(static_cast<std::size_t>(area.y / ListGrid::tile + y)) + area.x / ListGrid::tile);
}

/// Whether some solid may be listed in the wide tile as a whole.
bool ListBuilder::someWide(const Crop& area, DepthCode deepest, std::size_t threads) const {
  for (std::size_t t = 0; t < threads; ++t)
    for (const ListHead& head : parts_[t]->wides)
      if (head.seen.nearest <= deepest && overlap(head.seen, area)) return true;
  return false;
}

/// A round's solids are looked at a few at a time, then what is seen of them by wide tiles, so that each of the threads writes
/// what is its own, and none waits for another. Few solids are one round; of many those of later rounds are dropped at once
/// where the earlier hide them. In the last round what is kept of a wide tile is listed at once.
void ListBuilder::sift(std::size_t thread, Shared& shared, Footprints& footprints) {
  const Solids& solids = shared.packs.world.solids;
  ListPart& part = *parts_[thread];
  ListLayout::Share& share = layout_.share(thread);
  Sieve sieve(solids, footprints);
  std::vector<const std::vector<SeenWithin>*> narrowOnes(shared.threads);
  std::vector<std::span<const ListHead>> wideOnes(shared.threads);
  ListPatch own, *patch = &own;
  auto packing =
      packingOf<SeenWithin>(shared.packs, part.flags, [&](std::size_t kind, std::size_t bytes, const SeenWithin& seen) {
        return part.record(seen.solid, bytes,
                           [&](const std::byte* at) { return share.add(kind, at, seen, patch->depths.tiles()); });
      });
  const std::size_t patches = wideLimits_.size();
  std::size_t before = 0;  // what `next` had come to when the round began
  for (std::size_t from = 0, to; from < solids.size(); from = to) {
    to = roundEnd(from, solids.size());
    const bool last = to == solids.size();
    part.newWides = part.wides.size();
    for (std::size_t at; (at = shared.solid.fetch_add(few)) < to;)
      part.lookForSieve(solids, at, std::min(at + few, to), footprints, shared.slices,
                        from == 0 ? nullptr : &tileLimits_, discs_.get() + (at - from));
    shared.together.wait();
    for (std::size_t i = shared.next++; i < before + patches; i = shared.next++) {
      const std::size_t at = i - before;
      if (!patches_.empty()) patch = &patches_[at];
      if (from == 0) {
        const int across = grid_.wideAcross(), x = static_cast<int>(at) % across, y = static_cast<int>(at) / across;
        patch->kept.clear();
        patch->depths.start(grid_.wideArea(x, y), grid_.region.width, grid_.region.height);
      }
      const DepthBounds& depths = patch->depths;
      for (std::size_t t = 0; t < shared.threads; ++t)
        wideOnes[t] = std::span(parts_[t]->wides).subspan(parts_[t]->newWides);
      for (std::size_t slice = 0; slice < DepthSlices::count; ++slice) {
        const std::size_t bin = slice * patches + at;
        for (std::size_t t = 0; t < shared.threads; ++t) narrowOnes[t] = &parts_[t]->seenIn[bin];
        if (shared.slices.from[slice] <= depths.deepest())
          sieve.sift(*patch, narrowOnes, wideOnes, shared.slices, slice, {discs_.get(), from});
        for (std::size_t t = 0; t < shared.threads; ++t) parts_[t]->seenIn[bin].clear();
      }
      note(at, depths);
      if (!last) continue;
      sieve.siftKept(*patch);
      share.begin(at);
      packing.add(patch->kept);
      packing.finish();
      share.finish(someWide(depths.area(), depths.deepest(), shared.threads));
    }
    shared.together.wait();
    before += patches + shared.threads;  // each thread took one too many
    if (last) break;
    if (thread == 0) tileLimits_.widen(), shared.solid = to;
    shared.together.wait();
  }
}

/// Where nothing hides.
void ListBuilder::listAll(std::size_t thread, Shared& shared, Footprints& footprints) {
  const std::size_t solids = shared.packs.world.solids.size(), threads = shared.threads;
  ListLayout::Share& share = layout_.share(thread);
  parts_[thread]->look(solids * thread / threads, solids * (thread + 1) / threads, footprints, shared.packs, share);
  shared.together.wait();
  for (std::size_t at; (at = shared.next++) < wideLimits_.size();) {
    const int across = grid_.wideAcross(), x = static_cast<int>(at) % across, y = static_cast<int>(at) / across;
    share.gather(at, someWide(grid_.wideArea(x, y), DepthScale::none, threads));
  }
  shared.together.wait();
}

void ListBuilder::listWides(std::size_t thread, const Shared& shared) {
  ListPart& part = *parts_[thread];
  const auto wideTile = [&](int pixel) { return static_cast<std::uint32_t>(pixel / (grid_.wide * ListGrid::tile)); };
  std::erase_if(part.wides, [&](const ListHead& head) {
    const Footprint& f = head.seen;
    return !wideLimits_.some(wideTile(f.x0), wideTile(f.y0), wideTile(f.x1), wideTile(f.y1), f.nearest);
  });
  auto packing =
      packingOf<ListHead>(shared.packs, part.flags, [&](std::size_t kind, std::size_t bytes, const ListHead& head) {
        return part.record(head.solid, bytes, [&](const std::byte* at) {
          return layout_.share(thread).addWide(kind, at, head.seen, wideLimits_);
        });
      });
  packing.add(part.wides);
  packing.finish();
}

void ListBuilder::collect(const Scene& scene, const EyeFrame& frame, RealType type, bool eyeForms,
                          const Silhouette& silhouette, const ListGrid& grid, const std::function<ListRoom()>& room) {
  grid_ = grid;
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
  wideLimits_.start(static_cast<std::size_t>(grid_.wideAcross()), static_cast<std::size_t>(grid_.wideDown()));
  const std::size_t most = hiding ? mostInRound(solids) : 0;
  const bool oneRound = most == solids;
  patches_.resize(hiding && !oneRound ? wideLimits_.size() : 0);
  if (hiding && !oneRound)
    tileLimits_.start(static_cast<std::size_t>(grid_.across), static_cast<std::size_t>(grid_.down));
  if (most > discRoom_) discs_ = std::make_unique_for_overwrite<SmallDisc[]>(most), discRoom_ = most;
  const ListPacks packs{world, type, eyeForms, eye};
  const DepthSlices slices = slicesOf(sample);
  Shared shared{packs, slices, threads};
  layout_.start(grid_, threads, eyeForms);
  std::optional<ListRoom> to;
  std::exception_ptr failure;
  workers_.run(static_cast<int>(threads), [&](int at) {
    const auto t = static_cast<std::size_t>(at);
    for (std::size_t k = t; k < parts_.size(); k += threads) parts_[k]->start(grid_);
    layout_.share(t).start(layout_);
    auto own = footprints();
    if (hiding) sift(t, shared, own);
    else listAll(t, shared, own);
    listWides(t, shared);
    shared.together.wait();
    if (t == 0) layOut();
    if (t + 1 == threads) layout_.order();
    try {
      if (t == 0) to = room();
    } catch (...) { failure = std::current_exception(); }
    shared.together.wait();
    if (to) layout_.write(*to, rowBytes(type), t, threads);
  });
  if (failure) std::rethrow_exception(failure);
}

void ListBuilder::layOut() {
  grazing_ = farSphere_ = boxOnFace_ = false;
  for (const auto& part : parts_) {
    grazing_ = grazing_ || part->flags.grazing, boxOnFace_ = boxOnFace_ || part->flags.boxOnFace;
    farSphere_ = farSphere_ || part->farSphere;
  }
  layout_.layOut();
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

}  // namespace solidcast
