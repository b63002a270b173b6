#include "host/cast/list_sieve.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "host/cast/wide.h"

namespace solidcast {
namespace {

constexpr auto nearestOf = [](const SeenWithin& s) { return s.more & 0xffff; };
constexpr auto solidOf = [](const SeenWithin& s) { return s.solid; };

inline __attribute__((always_inline)) std::array<std::uint32_t, 2> range(std::span<const SeenWithin> solids,
                                                                         auto&& key) {
  std::uint32_t least = ~0u, most = 0;
  for (const SeenWithin& s : solids) {
    const std::uint32_t k = key(s);
    least = k < least ? k : least, most = k > most ? k : most;
  }
  return {least, most};
}
WIDE std::array<std::uint32_t, 2> rangeOf(std::span<const SeenWithin> solids, decltype(nearestOf)) {
  return range(solids, nearestOf);
}
WIDE std::array<std::uint32_t, 2> rangeOf(std::span<const SeenWithin> solids, decltype(solidOf)) {
  return range(solids, solidOf);
}

}  // namespace

ListSample::ListSample(const Solids& solids, Footprints& footprints) {
  const std::size_t step = solids.size() / 256 + 1;
  std::array<ShapeRef, Footprints::block> shapes;
  for (std::size_t i = 0, count = 0; i < solids.size(); i += step) {
    shapes[count++] = solids.shape(i);
    if (count < shapes.size() && i + step < solids.size()) continue;
    footprints.find(std::span<const ShapeRef>(shapes).first(count), [&](std::size_t at, const Footprint& f) {
      if (f.seen()) all.push_back({f, shapes[at]});
    });
    count = 0;
  }
  each = double(step);
}

/// With L layers of what hides, of all solids a part (1 - exp -L) / L is seen. Of a polygon, seen at all angles and drawn
/// without its rim, an eighth of the rectangle counts; of a sphere, as much of it as a circle fills.
/// ns of all threads, measured (docs/performance-notes.md): what looking takes, and what one that is left out saves.
double partLeft(const ListSample& sample, const Crop& region, RealType type) {
  constexpr double ofSphere = 0.78, ofPolygon = 0.12;
  constexpr double lookingAtSphere = 55, lookingAtPolygon = 110, lookingAtOther = 25;
  const bool single = type == RealType::f32;
  const double ofTile = single ? 22 : 50, ofRecord = single ? 20 : 1000, ofOtherRecord = single ? 200 : 1000;
  double layers = 0, looking = 0, listing = 0;
  for (const auto& [f, shape] : sample.all) {
    constexpr double side = Footprints::tile;
    const double width = f.x1 - f.x0 + 1, height = f.y1 - f.y0 + 1;
    const bool sphere = shape.getIf<Sphere>() != nullptr;
    const bool polygon = shape.getIf<Triangle>() != nullptr || shape.getIf<Quad>() != nullptr;
    if (f.hides != DepthScale::none) layers += width * height * (sphere ? ofSphere : ofPolygon);
    looking += sphere ? lookingAtSphere : polygon ? lookingAtPolygon : lookingAtOther;
    listing += ((width - 1) / side + 1) * ((height - 1) / side + 1) * ofTile;
    listing += sphere || polygon ? ofRecord : ofOtherRecord;
  }
  layers *= sample.each / region.width / region.height;
  if (layers <= 0) return 1;
  const double left = (1 - std::exp(-layers)) / layers;
  return listing * (1 - left) > looking ? left : 1;
}

DepthSlices slicesOf(const ListSample& sample) {
  DepthSlices slices;
  std::vector<DepthCode> begins;
  for (std::size_t i = 0; i < sample.all.size(); i += 4) begins.push_back(sample.all[i].seen.nearest);
  std::ranges::sort(begins);
  constexpr std::size_t count = DepthSlices::count;
  for (std::size_t i = 1; i < count && !begins.empty(); ++i) slices.from[i] = begins[begins.size() * i / count];
  return slices;
}

void Sieve::sort(std::span<const SeenWithin> solids, auto&& key) {
  const auto [least, most] = rangeOf(solids, key);
  least_ = least;
  const int bits = std::clamp(static_cast<int>(std::bit_width(solids.size())) - 1, 6, 12);  // as many buckets
  shift_ = std::max(0, static_cast<int>(std::bit_width(most - least)) - bits);
  start_.assign((std::size_t{1} << bits) + 1, 0);
  for (const SeenWithin& s : solids) ++start_[((key(s) - least) >> shift_) + 1];
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  order_.resize(solids.size());
  for (std::uint32_t i = 0; i < solids.size(); ++i) order_[start_[(key(solids[i]) - least) >> shift_]++] = i;
}

void Sieve::sift(ListPatch& patch, std::span<const std::vector<SeenWithin>* const> narrow,
                 std::span<const std::span<const ListHead>> wides, const DepthSlices& slices, std::size_t slice,
                 const SmallDiscs& discs) {
  DepthBounds& depths = patch.depths;
  all_.clear();
  for (const auto* solids : narrow) depths.addNotBehind(*solids, all_);
  const std::size_t narrowOnes = all_.size();
  for (const auto& heads : wides)
    for (const ListHead& head : heads)
      if (head.seen.hides != DepthScale::none && slices.of(head.seen.nearest) == slice &&
          overlap(head.seen, depths.area()))
        all_.add(within(head.seen, head.solid, depths.area()));
  if (all_.size() == 0) return;
  sort(all_, nearestOf);
  constexpr std::size_t together = Footprints::block;
  std::array<std::uint32_t, 4 * together> places, round;
  std::array<ShapeRef, together> shapes;
  std::array<std::uint32_t, together> covering;
  for (std::size_t looked = 0; looked < order_.size();) {
    if (bucketOf(all_[order_[looked]].nearest()) > depths.deepest()) break;  // and so are all others
    const std::size_t seen = depths.visible(all_, order_, together, places, looked);
    std::size_t count = 0, rounds = 0;
    const auto addShapes = [&] {
      footprints_.findCovers(std::span(shapes).first(count),
                             [&](std::size_t i, const Footprint& f, const Cover& cover) {
                               depths.add(all_[covering[i]], f.hides, cover);
                             });
      count = 0;
    };
    for (const std::uint32_t at : std::span(places).first(seen)) {
      const SeenWithin& s = all_[at];
      if (at < narrowOnes) patch.kept.push_back(s);
      if (s.isDisc()) {
        round[rounds++] = at;
        __builtin_prefetch(discs.of + (s.solid - discs.first));
      } else if (s.covers()) {
        covering[count] = at;
        fetch(shapes[count++] = solids_.shape(s.solid));
        if (count == shapes.size()) addShapes();
      }
    }
    depths.add(all_, std::span(round).first(rounds), discs);
    addShapes();
    depths.noteTiles();
  }
}

void Sieve::siftKept(ListPatch& patch) {
  if (patch.kept.empty()) return;
  sort(patch.kept, solidOf);
  for (std::size_t bucket = 0, first = 0; first < order_.size(); first = start_[bucket++])
    if (start_[bucket] > first + 1)
      std::sort(order_.begin() + static_cast<std::ptrdiff_t>(first), order_.begin() + start_[bucket],
                [&](std::uint32_t a, std::uint32_t b) { return patch.kept[a].solid < patch.kept[b].solid; });
  places_.resize(order_.size());
  std::size_t looked = 0;
  const std::size_t seen = patch.depths.visible(patch.kept, order_, order_.size() + 1, places_, looked);
  all_.clear();
  for (const std::uint32_t at : std::span(places_).first(seen)) all_.add(patch.kept[at]);
  patch.kept.assign(all_.data(), all_.data() + seen);
}

}  // namespace solidcast
