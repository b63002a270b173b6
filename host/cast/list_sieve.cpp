#include "host/cast/list_sieve.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "host/cast/wide.h"

namespace solidcast {
namespace {

bool overlap(const Footprint& f, const Crop& area) {
  return f.x0 < area.x + area.width && f.x1 >= area.x && f.y0 < area.y + area.height && f.y1 >= area.y;
}

WIDE std::array<int, 2> nearestOf(std::span<const SeenWithin> solids) {
  std::uint32_t least = DepthScale::none, most = 0;
  for (const SeenWithin& s : solids) {
    const std::uint32_t nearest = s.more & 0xffff;
    least = nearest < least ? nearest : least, most = nearest > most ? nearest : most;
  }
  return {static_cast<int>(least), static_cast<int>(most)};
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

void Sieve::sort(std::span<const std::vector<SeenWithin>* const> narrow) {
  all_.clear();
  for (const auto* solids : narrow) all_.insert(all_.end(), solids->begin(), solids->end());
  all_.insert(all_.end(), wides_.begin(), wides_.end());
  const auto [least, most] = nearestOf(all_);
  least_ = least;
  const auto bits = static_cast<int>(std::bit_width(static_cast<unsigned>(most - least)));
  shift_ = std::max(0, bits - std::countr_zero(buckets));
  start_.fill(0);
  for (const SeenWithin& s : all_) ++start_[static_cast<std::size_t>((s.nearest() - least_) >> shift_) + 1];
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  order_.resize(all_.size());
  for (std::uint32_t i = 0; i < all_.size(); ++i)
    order_[start_[static_cast<std::size_t>((all_[i].nearest() - least_) >> shift_)]++] = i;
}

void Sieve::sift(ListPatch& patch, std::span<const std::vector<SeenWithin>* const> narrow,
                 std::span<const std::span<const ListHead>> wides, const SmallDiscs& discs) {
  DepthBounds& depths = patch.depths;
  wides_.clear();
  for (const auto& heads : wides)
    for (const ListHead& head : heads)
      if (head.seen.hides != DepthScale::none && overlap(head.seen, depths.area()))
        wides_.push_back(within(head.seen, head.solid, depths.area()));
  sort(narrow);
  if (all_.empty()) return;
  kept_.assign(all_.size() / 64 + 1, 0);
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
      kept_[at / 64] |= std::uint64_t{1} << at % 64;
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
  std::size_t first = 0, list = 0, own = patch.kept.size();
  const auto begin = static_cast<std::ptrdiff_t>(own);
  const auto merge = [&] {
    const auto at = [&](std::size_t place) { return patch.kept.begin() + static_cast<std::ptrdiff_t>(place); };
    std::inplace_merge(patch.kept.begin() + begin, at(own), patch.kept.end(),
                       [](const SeenWithin& a, const SeenWithin& b) { return a.solid < b.solid; });
    own = patch.kept.size();
  };
  for (std::size_t word = 0; word < kept_.size(); ++word)
    for (std::uint64_t bits = kept_[word]; bits != 0; bits &= bits - 1) {
      const std::size_t place = 64 * word + static_cast<std::size_t>(std::countr_zero(bits));
      while (list < narrow.size() && place - first >= narrow[list]->size()) first += narrow[list++]->size(), merge();
      if (list == narrow.size()) return;  // the rest are wide ones
      patch.kept.push_back(all_[place]);
    }
  merge();
}

void Sieve::siftKept(ListPatch& patch) {
  places_.resize(patch.kept.size());
  order_.resize(patch.kept.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::size_t looked = 0;
  const std::size_t seen = patch.depths.visible(patch.kept, order_, order_.size() + 1, places_, looked);
  for (std::size_t i = 0; i < seen; ++i) patch.kept[i] = patch.kept[places_[i]];
  patch.kept.resize(seen);
}

}  // namespace solidcast
