#include "host/cast/list_build.h"

#include <algorithm>
#include <barrier>
#include <cstring>

#include "host/cast/list_part.h"

namespace solidcast {

ListBuilder::ListBuilder() {
  for (unsigned t = 0; t < workers_.threads(); ++t) parts_.push_back(std::make_unique<Part>());
}
ListBuilder::~ListBuilder() = default;

void ListBuilder::collect(const Scene& scene, const EyeFrame& frame, RealType type, bool eyeForms,
                          const Silhouette& silhouette, const ListGrid& grid) {
  grid_ = grid, type_ = type, eyeForms_ = eyeForms;
  const EyeFrames eye(frame);
  const World& world = scene.world;
  const std::size_t solids = world.solids.size(), threads = solids < 256 ? 1 : parts_.size();
  const bool canHide = silhouette.centresAlone() && solids > 64 && grid.region.width < (1 << 14);
  const bool hasUnit = eyeForms && type == RealType::f32;
  const DepthScale scale(canHide ? static_cast<float>(hasUnit ? frame.unit : eyeFrame(scene, RealType::f32).unit)
                                 : 1.f);
  const auto footprints = [&] { return Footprints(silhouette, grid.region, eye.plain, type, scale); };
  Crowd crowd;
  if (canHide) {
    auto sample = footprints();
    crowd = Crowd(world.solids, grid.region, type, sample);
  }
  const bool hiding = crowd.worthLooking();
  std::vector<DepthBounds*> depths;
  for (std::size_t t = 0; t < threads; ++t) depths.push_back(&parts_[t]->depths);
  for (auto& part : parts_) part->start(grid, false);
  std::barrier together(static_cast<std::ptrdiff_t>(threads));
  workers_.run(static_cast<int>(threads), [&](int at) {
    const auto t = static_cast<std::size_t>(at);
    Part& part = *parts_[t];
    auto own = footprints();
    const auto tell = [&] {
      together.arrive_and_wait();
      DepthBounds::merge(depths, depths[0]->rows() * t / threads, depths[0]->rows() * (t + 1) / threads);
      together.arrive_and_wait();
    };
    part.start(grid, hiding);
    part.look(world.solids, solids * t / threads, solids * (t + 1) / threads, own, crowd);
    if (hiding) {
      tell();
      part.lookBehind(world.solids, own);
      tell();
    }
    part.pack(world, type, eyeForms, eye);
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
  const auto value = [](const std::vector<std::uint32_t>& of, std::size_t i) { return of.empty() ? 0 : of[i]; };
  const std::size_t threads = rows_ < 4096 ? 1 : parts_.size();
  workers_.run(static_cast<int>(threads), [&](int at) {
    const auto t = static_cast<std::size_t>(at);
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
        const std::uint32_t wideCount = value(count_[wide][kind], wideTile);
        const ListSpan span{value(first_[wide][kind], wideTile), wideCount, value(first_[narrow][kind], tile),
                            wideCount + value(count_[narrow][kind], tile)};
        std::memcpy(to, &span, sizeof span);
        to += sizeof span;
      }
    }
    for (std::size_t part = t; part < parts_.size(); part += threads)
      parts_[part]->write(rows.data(), rowBytes(type_), eyeForms_);
  });
}

}  // namespace solidcast
