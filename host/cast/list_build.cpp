#include "host/cast/list_build.h"

#include <algorithm>
#include <barrier>
#include <cstring>
#include <thread>

#include "host/cast/list_part.h"

namespace solidcast {
namespace {

/// Of a few solids from all over the scene: what they are, and how many layers of rectangles the scene has.
struct Crowd {
  bool spheres = false, polygons = false;
  double layers = 0;

  bool layered() const { return layers > 8; }
  /// Looking for what is hidden costs a pass over the pixels and, by polygon, more than it saves where they are few.
  bool worthLooking() const { return layered() ? spheres || polygons : spheres && layers > 1; }
};
Crowd crowd(const World& world, const Silhouette& silhouette, const Crop& region, const Frame<double>& eye) {
  Footprints footprints(silhouette, region, eye);
  Crowd found;
  std::vector<SolidEntry> some;
  const std::size_t step = world.solids.size() / Footprints::block + 1;
  for (std::size_t i = 0; i < world.solids.size(); i += step) {
    some.push_back({"", world.solids[i].shape, 0});
    const bool sphere = std::holds_alternative<Sphere>(some.back().shape);
    found.spheres = found.spheres || sphere;
    found.polygons = found.polygons || (DepthBounds::knows(some.back().shape) && !sphere);
  }
  footprints.find(some);
  double pixels = 0;
  for (std::size_t i = 0; i < some.size(); ++i) {
    const Footprint& f = footprints[i];
    // A plane is one layer and not, as a sample would have it, a share of the scene.
    if (f.seen() && !std::holds_alternative<InfinitePlane>(some[i].shape))
      pixels += double(f.x1 - f.x0 + 1) * (f.y1 - f.y0 + 1);
  }
  found.layers = pixels / some.size() * world.solids.size() / region.width / region.height;
  return found;
}

void onAllThreads(std::size_t threads, const auto& work) {
  std::vector<std::thread> helpers;
  for (std::size_t t = 1; t < threads; ++t) helpers.emplace_back([&work, t] { work(t); });
  work(std::size_t{0});
  for (std::thread& helper : helpers) helper.join();
}

}  // namespace

ListBuilder::ListBuilder() {
  for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t)
    parts_.push_back(std::make_unique<Part>());
}
ListBuilder::~ListBuilder() = default;

void ListBuilder::collect(const Scene& scene, RealType type, bool eyeForms, const Silhouette& silhouette,
                          const ListGrid& grid) {
  grid_ = grid, type_ = type, eyeForms_ = eyeForms;
  const EyeFrames eye(eyeFrame(scene, eyeForms ? type : RealType::f64));
  const std::size_t solids = scene.world.solids.size(), threads = solids < 256 ? 1 : parts_.size();
  for (auto& part : parts_) part->start();
  const std::size_t pixels = static_cast<std::size_t>(grid.region.width) * static_cast<std::size_t>(grid.region.height);
  const Crowd crowded = silhouette.centresAlone() && solids > 1000 && solids > pixels / 64
                            ? crowd(scene.world, silhouette, grid.region, eye.plain)
                            : Crowd{};
  hiding_ = crowded.worthLooking();
  limits_.resize(hiding_ ? static_cast<std::size_t>(grid.across) * static_cast<std::size_t>(grid.down) : 0);
  wideLimits_.resize(hiding_ ? static_cast<std::size_t>(grid.wideAcross()) * static_cast<std::size_t>(grid.wideDown())
                             : 0);
  std::barrier together(static_cast<std::ptrdiff_t>(threads));
  onAllThreads(threads, [&](std::size_t t) {
    Part& part = *parts_[t];
    if (hiding_)
      part.depths.start(silhouette, grid.region, grid.across * ListGrid::tile, grid.down * ListGrid::tile, type,
                        crowded.layered());
    part.look(scene.world, solids * t / threads, solids * (t + 1) / threads, silhouette, eye, grid, hiding_);
    if (hiding_) {
      together.arrive_and_wait();
      const auto down = static_cast<std::size_t>(grid.down), wideDown = static_cast<std::size_t>(grid.wideDown());
      for (std::size_t y = down * t / threads; y < down * (t + 1) / threads; ++y) limitTiles(y, threads);
      together.arrive_and_wait();
      for (std::size_t y = wideDown * t / threads; y < wideDown * (t + 1) / threads; ++y) limitWide(y);
      together.arrive_and_wait();
    }
    part.pack(scene.world, type, eyeForms, eye, grid, limits(), hiding_ ? &parts_[0]->depths : nullptr);
  });
  grazing_ = farSphere_ = boxOnFace_ = false;
  seen_ = 0;
  for (const auto& part : parts_) {
    grazing_ = grazing_ || part->grazing, farSphere_ = farSphere_ || part->farSphere;
    boxOnFace_ = boxOnFace_ || part->boxOnFace, seen_ += part->seen;
  }
  layOut();
  sortTiles();
}

std::array<ListLimits, 2> ListBuilder::limits() const {
  std::array<ListLimits, 2> both;
  both[narrow] = {hiding_ ? limits_.data() : nullptr, static_cast<std::size_t>(grid_.across), ListGrid::tile};
  both[wide] = {hiding_ ? wideLimits_.data() : nullptr, static_cast<std::size_t>(grid_.wideAcross()),
                grid_.wide * ListGrid::tile};
  return both;
}

/// What all threads know of each pixel, into the first one's depths, and the deepest of each tile's pixels.
void ListBuilder::limitTiles(std::size_t tileRow, std::size_t threads) {
  constexpr std::size_t side = ListGrid::tile;
  const std::size_t across = static_cast<std::size_t>(grid_.across), pixels = across * side;
  std::vector<float> deepest(pixels, 0.f);
  for (std::size_t y = tileRow * side; y < (tileRow + 1) * side; ++y) {
    float* nearest = parts_[0]->depths.row(y);
    for (std::size_t t = 1; t < threads; ++t) {
      const float* other = parts_[t]->depths.row(y);
      for (std::size_t x = 0; x < pixels; ++x) nearest[x] = other[x] < nearest[x] ? other[x] : nearest[x];
    }
    for (std::size_t x = 0; x < pixels; ++x) deepest[x] = deepest[x] < nearest[x] ? nearest[x] : deepest[x];
  }
  float* limit = limits_.data() + tileRow * across;
  for (std::size_t x = 0; x < across; ++x)
    limit[x] = *std::max_element(deepest.data() + x * side, deepest.data() + (x + 1) * side);
}

void ListBuilder::limitWide(std::size_t wideRow) {
  const std::size_t across = static_cast<std::size_t>(grid_.across), down = static_cast<std::size_t>(grid_.down);
  const std::size_t side = static_cast<std::size_t>(grid_.wide);
  float* limit = wideLimits_.data() + wideRow * static_cast<std::size_t>(grid_.wideAcross());
  std::fill_n(limit, grid_.wideAcross(), 0.f);
  for (std::size_t y = wideRow * side; y < std::min(down, (wideRow + 1) * side); ++y)
    for (std::size_t x = 0; x < across; ++x) limit[x / side] = std::max(limit[x / side], limits_[y * across + x]);
}

/// Kind by kind and tile by tile, each tile's entries in the order of the solids.
void ListBuilder::layOut() {
  kinds_ = {};
  wideOnes_ = false;
  std::size_t row = 0;
  const std::size_t tiles = static_cast<std::size_t>(grid_.across) * static_cast<std::size_t>(grid_.down);
  total_.assign(tiles, 0);
  for (const ListLevel level : {wide, narrow})
    for (std::size_t kind = 0; kind < kindCount; ++kind) {
      auto& first = first_[level][kind];
      auto& count = count_[level][kind];
      first.clear(), count.clear();
      std::vector<std::uint32_t*> counts;
      std::size_t size = 0;
      for (const auto& part : parts_)
        if (auto& of = part->tiles[level][kind]; !of.empty()) counts.push_back(of.data()), size = of.size();
      if (counts.empty()) continue;
      kinds_[kind] = true;
      wideOnes_ = wideOnes_ || level == wide;
      first.resize(size), count.resize(size);
      for (std::size_t tile = 0; tile < size; ++tile) {
        first[tile] = static_cast<std::uint32_t>(row);
        std::uint32_t here = 0;
        for (std::uint32_t* of : counts) {
          const std::uint32_t entries = of[tile];
          of[tile] = static_cast<std::uint32_t>(row);
          row += std::size_t{entries} * rowsOf(kind, eyeForms_);
          here += entries;
        }
        count[tile] = here;
        if (level == narrow) total_[tile] += here;
      }
      if (level == wide)
        for (std::size_t tile = 0, y = 0; y < static_cast<std::size_t>(grid_.down); ++y)
          for (std::size_t x = 0; x < static_cast<std::size_t>(grid_.across); ++x, ++tile)
            total_[tile] += count[y / grid_.wide * grid_.wideAcross() + x / grid_.wide];
    }
  rows_ = row;
}

/// Longest first, so that the lanes of a vector end together and the last workgroups are short.
void ListBuilder::sortTiles() {
  constexpr std::uint32_t most = 4095;
  std::vector<std::uint32_t> start(most + 2, 0);
  for (const std::uint32_t entries : total_) ++start[most - std::min(entries, most) + 1];
  for (std::size_t i = 0; i <= most; ++i) start[i + 1] += start[i];
  listed_ = start[most];
  order_.resize(total_.size());
  for (std::uint32_t tile = 0; tile < total_.size(); ++tile)
    order_[start[most - std::min(total_[tile], most)]++] = tile;
  const auto longer = [&](std::uint32_t a, std::uint32_t b) { return total_[a] > total_[b]; };
  std::stable_sort(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(start[0]), longer);
}

std::uint32_t ListBuilder::longest() const { return order_.empty() ? 0 : total_[order_[0]]; }

std::size_t ListBuilder::tilesLongerThan(std::uint32_t entries) const {
  const auto longer = [&](std::uint32_t tile, std::uint32_t n) { return total_[tile] > n; };
  return static_cast<std::size_t>(std::lower_bound(order_.begin(), order_.end(), entries, longer) - order_.begin());
}

void ListBuilder::write(std::span<std::byte> rows, std::span<std::byte> lanes, std::size_t laneCount,
                        const std::array<bool, kindCount>& slots) {
  std::size_t laneBytes = sizeof(ListLane);
  for (const bool slot : slots) laneBytes += slot ? sizeof(ListSpan) : 0;
  const auto at = [](const std::vector<std::uint32_t>& of, std::size_t i) { return of.empty() ? 0 : of[i]; };
  const std::size_t threads = rows_ < 4096 ? 1 : parts_.size();
  onAllThreads(threads, [&](std::size_t t) {
    for (std::size_t lane = laneCount * t / threads; lane < laneCount * (t + 1) / threads; ++lane) {
      const std::size_t tile = order_[lane], x = tile % grid_.across, y = tile / grid_.across;
      const std::size_t wideTile = y / grid_.wide * grid_.wideAcross() + x / grid_.wide;
      std::byte* to = lanes.data() + lane * laneBytes;
      const ListLane head{
          static_cast<std::uint32_t>(x * ListGrid::tile), static_cast<std::uint32_t>(y * ListGrid::tile), {}};
      std::memcpy(to, &head, sizeof head);
      to += sizeof head;
      for (std::size_t kind = 0; kind < kindCount; ++kind) {
        if (!slots[kind]) continue;
        const std::uint32_t wideCount = at(count_[wide][kind], wideTile);
        const ListSpan span{at(first_[wide][kind], wideTile), wideCount, at(first_[narrow][kind], tile),
                            wideCount + at(count_[narrow][kind], tile)};
        std::memcpy(to, &span, sizeof span);
        to += sizeof span;
      }
    }
    for (std::size_t part = t; part < parts_.size(); part += threads)
      parts_[part]->write(rows.data(), rowBytes(type_), eyeForms_, limits());
  });
}

}  // namespace solidcast
