#include "host/cast/list_part.h"

#include <algorithm>
#include <optional>

#include "host/cast/record_batch.h"

namespace solidcast {
namespace {

constexpr std::uint32_t rowsOfKind[kindCount][2] = {
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) {WORLD_ROWS, EYE_ROWS},
#include "shaders/solids.def"
#undef SOLID
};
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  static_assert(EYE_ROWS >= 2 && EYE_ROWS <= 5 && WORLD_ROWS >= 2 && WORLD_ROWS <= 5, "writeRows knows these");
#include "shaders/solids.def"
#undef SOLID

/// Solids in more tiles than this go to the wide ones.
constexpr int mostTiles = 256;

void fetch(const SolidEntry& solid) {
  const auto* at = reinterpret_cast<const char*>(&solid.shape);
  for (std::size_t line = 0; line < sizeof solid.shape; line += 64) __builtin_prefetch(at + line);
}

ListLevel levelOf(const Footprint& f) {
  const auto tiles = [](std::int32_t first, std::int32_t last) {
    constexpr std::uint32_t side = ListGrid::tile;
    return std::uint64_t{static_cast<std::uint32_t>(last) / side - static_cast<std::uint32_t>(first) / side + 1};
  };
  return tiles(f.x0, f.x1) * tiles(f.y0, f.y1) > mostTiles ? wide : narrow;
}

/// Tiles of a level, first and last, that a solid's rectangle lies in.
struct TileRange {
  std::uint32_t x0, y0, x1, y1;
  TileRange(const Footprint& f, int side) {
    const auto tile = [&](std::int32_t pixel) {
      return side == ListGrid::tile ? unsigned(pixel) / ListGrid::tile : unsigned(pixel) / unsigned(side);
    };
    x0 = tile(f.x0), y0 = tile(f.y0), x1 = tile(f.x1), y1 = tile(f.y1);
  }
  std::size_t count() const { return std::size_t{x1 - x0 + 1} * (y1 - y0 + 1); }
};

bool reaches(const Footprint& f, const ListLimits& limits) {
  const TileRange range(f, limits.side);
  for (std::size_t y = range.y0; y <= range.y1; ++y)
    for (std::size_t x = range.x0; x <= range.x1; ++x)
      if (f.nearest <= limits.byTile[y * limits.across + x]) return true;
  return false;
}

std::uint32_t numberAt(const std::byte* at) {
  std::uint32_t number;
  std::memcpy(&number, at, sizeof number);
  return number;
}

// Of known size, a record is copied by a few vector moves: a sixth of all the time was memcpy's.
template <std::size_t ROW_SIZE, std::size_t ROWS>
void writeAs(std::span<const std::byte> from, std::byte* rows, std::uint32_t* next) {
  constexpr std::size_t record = ROW_SIZE * ROWS;
  for (const std::byte *at = from.data(), *end = at + from.size(); at != end;) {
    const std::byte* tile = at + sizeof(std::uint32_t);
    const std::byte* const solid = tile + numberAt(at) * sizeof(std::uint32_t);
    for (; tile != solid; tile += sizeof(std::uint32_t)) {
      std::uint32_t& to = next[numberAt(tile)];
      std::memcpy(rows + to * ROW_SIZE, solid, record);
      to += ROWS;
    }
    at = solid + record;
  }
}

template <std::size_t ROW_SIZE>
void writeRows(std::span<const std::byte> from, std::uint32_t rowCount, std::byte* rows, std::uint32_t* next) {
  if (rowCount == 2) writeAs<ROW_SIZE, 2>(from, rows, next);
  else if (rowCount == 3) writeAs<ROW_SIZE, 3>(from, rows, next);
  else if (rowCount == 4) writeAs<ROW_SIZE, 4>(from, rows, next);
  else writeAs<ROW_SIZE, 5>(from, rows, next);
}

}  // namespace

std::uint32_t rowsOf(std::size_t kind, bool eyeForms) { return rowsOfKind[kind][eyeForms]; }

Crowd::Crowd(std::span<const SolidEntry> solids, const Crop& region, RealType type, Footprints& footprints) {
  const std::size_t step = solids.size() / 256 + 1, looked = (solids.size() + step - 1) / step;
  const double share = 1.0 / looked * solids.size() / region.width / region.height;
  std::array<const Shape*, Footprints::block> shapes;
  for (std::size_t i = 0, count = 0; i < solids.size(); i += step) {
    shapes[count++] = &solids[i].shape;
    if (count < shapes.size() && i + step < solids.size()) continue;
    footprints.find(std::span(shapes).first(count));
    for (std::size_t k = 0; k < count; ++k) {
      const Footprint& f = footprints[k];
      if (!f.seen() || f.hides == DepthScale::none) continue;
      const double layers = (f.x1 - f.x0 + 1.0) * (f.y1 - f.y0 + 1) * share;
      some_.push_back({f.hides, layers});
      worth_ += layers / (footprints.cover(k).corners == 0 ? 3 : type == RealType::f32 ? 10 : 5);
    }
    count = 0;
  }
  std::sort(some_.begin(), some_.end());
  double sum = 0;
  for (auto& [depth, layers] : some_) layers = sum += layers;
}

DepthCode Crowd::depthOf(double layers) const {
  const auto beyond =
      std::partition_point(some_.begin(), some_.end(), [&](const auto& s) { return s.second < layers; });
  return beyond == some_.end() ? DepthScale::none - 1 : beyond->first;
}

void ListBuilder::Part::start(const ListGrid& grid, bool hiding) {
  grid_ = grid, hiding_ = hiding;
  grazing = farSphere = boxOnFace = false;
  seen = 0;
  for (auto& of : heads) of.clear();
  for (auto& level : found)
    for (Arena& arena : level) arena.clear();
  for (auto& level : tiles)
    for (auto& counts : level) counts.clear();
  if (hiding) depths.start(grid.region, grid.across * ListGrid::tile, grid.down * ListGrid::tile, grid.wide);
}

ListLimits ListBuilder::Part::limits(ListLevel level) const {
  if (level == wide)
    return {hiding_ ? depths.wideTiles() : nullptr, static_cast<std::size_t>(grid_.wideAcross()),
            grid_.wide * ListGrid::tile};
  return {hiding_ ? depths.tiles() : nullptr, static_cast<std::size_t>(grid_.across), ListGrid::tile};
}

/// At first all are drawn, since nothing is known; the more have been looked at, the fewer layers of all are enough for some
/// in front of each pixel, and what is behind those is dropped at once.
void ListBuilder::Part::look(std::span<const SolidEntry> solids, std::size_t from, std::size_t to,
                             Footprints& footprints, const Crowd& crowd) {
  constexpr double firstLayers = 3;
  constexpr std::size_t fewest = 12000;  // what a note costs is little beside so many solids
  const auto frontAt = [&](std::size_t at) { return crowd.depthOf(firstLayers * solids.size() / (at - from)); };
  std::size_t note = from + fewest;
  while (hiding_ && note - from < (to - from) / 16) note = from + 2 * (note - from);
  DepthCode front = hiding_ ? frontAt(note) : 0;
  std::array<const Shape*, Footprints::block> shapes;
  for (std::size_t first = from; first < to; first += Footprints::block) {
    const std::size_t count = std::min(Footprints::block, to - first);
    for (std::size_t i = 0; i < count; ++i) {
      shapes[i] = &solids[first + i].shape;
      // The next block's, in time.
      const auto* next = reinterpret_cast<const char*>(solids.data() + first + i + Footprints::block);
      __builtin_prefetch(next), __builtin_prefetch(next + 64);
    }
    footprints.find(std::span(shapes).first(count));
    if (hiding_ && first >= note) {
      depths.noteTiles();
      note = from + 2 * (note - from);
      front = frontAt(note);
    }
    const bool noted = hiding_ && depths.noted();
    for (std::size_t i = 0; i < count; ++i) {
      const Footprint& f = footprints[i];
      if (!f.seen() || (noted && depths.behindTiles(f))) continue;
      if (hiding_ && f.hides <= front && depths.worthIt(f)) depths.add(f, footprints.cover(i));
      heads[levelOf(f)].push_back({f, static_cast<std::uint32_t>(first + i)});
    }
  }
  // Of the whole scene, seen or not: so that fast has the same bits in every plan.
  farSphere = footprints.farSphere();
}

/// No branches: half of the solids are hidden.
void ListBuilder::Part::dropHidden() {
  for (std::vector<Head>& all : heads) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool hidden = depths.behindTiles(all[i].seen);
      all[left] = all[i];
      left += !hidden;
    }
    all.resize(left);
  }
}

void ListBuilder::Part::lookBehind(std::span<const SolidEntry> solids, Footprints& footprints) {
  depths.noteTiles();
  dropHidden();
  std::array<const Shape*, Footprints::block> shapes;
  std::size_t count = 0;
  const auto draw = [&] {
    footprints.find(std::span(shapes).first(count));
    for (std::size_t i = 0; i < count; ++i)
      if (depths.worthIt(footprints[i])) depths.add(footprints[i], footprints.cover(i));
    count = 0;
  };
  for (const std::vector<Head>& all : heads)
    for (const Head& head : all) {
      if (head.seen.hides == DepthScale::none || !depths.worthIt(head.seen)) continue;
      shapes[count++] = &solids[head.solid].shape;
      if (count == Footprints::block) draw();
    }
  draw();
}

/// Records of one level's solids, kind by kind in the order of the solids.
class ListBuilder::Part::Packing {
 public:
  Packing(Part& part, ListLevel level, const World& world, RealType type, bool eyeForms, const EyeFrames& eye)
      : part_(part), level_(level), world_(world), type_(type), eyeForms_(eyeForms), eye_(eye) {}

  void add(const Head& head) {
    std::visit([&](const auto& solid) { put(solid, head); }, world_.solids[head.solid].shape);
  }
  void finish() { flush(spheres_), flush(triangles_), flush(quads_); }

 private:
  struct Many {
    RecordBatch records;
    std::array<const Head*, RecordBatch::block> heads;
  };

  void put(const auto& solid, const Head& head) { alone(solid, head); }
  void put(const Sphere& solid, const Head& head) { together(solid, head, spheres_); }
  void put(const Triangle& solid, const Head& head) { together(solid, head, triangles_); }
  void put(const Quad& solid, const Head& head) { together(solid, head, quads_); }

  void together(const auto& solid, const Head& head, std::optional<Many>& many) {
    if (!eyeForms_ || type_ != RealType::f32) return alone(solid, head);
    if (!many) many.emplace(Many{RecordBatch(kindNumber(solid)), {}});
    many->heads[many->records.size()] = &head;
    if (!many->records.add(solid, head.solid, eye_.plain)) return alone(solid, head);
    if (many->records.full()) flush(many);
  }

  void flush(std::optional<Many>& many) {
    if (!many) return;
    const RecordBatch& records = many->records;
    const std::uint32_t rows = rowsOf(static_cast<std::size_t>(records.kind()), true);
    for (std::size_t i = 0, count = many->records.pack(eye_.plain); i < count; ++i) {
      const Head& head = *many->heads[i];
      if (records.poor(i)) {
        std::visit([&](const auto& solid) { alone(solid, head); }, world_.solids[head.solid].shape);
        continue;
      }
      part_.grazing = part_.grazing || records.grazing(i);
      records.copy(i, part_.add(static_cast<std::size_t>(records.kind()), 16 * rows, head, level_), 4 * rows);
    }
  }

  void alone(const auto& solid, const Head& head) {
    if (!eyeForms_) {
      RowWriter rows(type_);
      packWorld(solid, eye_.exact.origin, head.solid, rows);
      const auto kind = static_cast<std::size_t>(kindNumber(solid));
      std::ranges::copy(rows.bytes(), part_.add(kind, rows.bytes().size(), head, level_));
      return;
    }
    packed(solid, eye_, head.solid, type_, [&](const auto& record) {
      if (record.kind < 0) return;
      part_.grazing = part_.grazing || record.grazing;
      const std::size_t rowSize = rowBytes(type_);
      std::byte* to = part_.add(static_cast<std::size_t>(record.kind), rowSize * static_cast<std::size_t>(record.rows),
                                head, level_);
      for (int r = 0; r < record.rows; ++r, to += rowSize) writeRow(to, type_, record.row[r]);
    });
    if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, AABox>)
      part_.boxOnFace = part_.boxOnFace || eyeOnFacePlane(solid, eye_.extended);
  }

  Part& part_;
  const ListLevel level_;
  const World& world_;
  const RealType type_;
  const bool eyeForms_;
  const EyeFrames& eye_;
  std::optional<Many> spheres_, triangles_, quads_;
};

void ListBuilder::Part::pack(const World& world, RealType type, bool eyeForms, const EyeFrames& eye) {
  // Those that are left lie far apart in memory: they are fetched a few ahead.
  constexpr std::size_t ahead = 8;
  if (hiding_) {
    depths.noteTiles();
    dropHidden();
  }
  for (const ListLevel level : {wide, narrow}) {
    std::vector<Head>& all = heads[level];
    if (hiding_)
      std::erase_if(all, [&, limits = limits(level)](const Head& head) {
        return !reaches(head.seen, limits) || (level == narrow && depths.hides(head.seen));
      });
    Packing packing(*this, level, world, type, eyeForms, eye);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i + ahead < all.size()) fetch(world.solids[all[i + ahead].solid]);
      packing.add(all[i]);
    }
    packing.finish();
  }
}

std::byte* ListBuilder::Part::add(std::size_t kind, std::size_t bytes, const Head& head, ListLevel level) {
  const ListLimits limit = limits(level);
  const TileRange range(head.seen, limit.side);
  auto& counts = tiles[level][kind];
  if (counts.empty())
    counts.assign(level == wide ? std::size_t{1} * grid_.wideAcross() * grid_.wideDown()
                                : std::size_t{1} * grid_.across * grid_.down,
                  0);
  Arena& arena = found[level][kind];
  std::byte* const start = arena.room((1 + range.count()) * sizeof(std::uint32_t) + bytes);
  std::byte* to = start + sizeof(std::uint32_t);
  // No branches: a third of the tiles see nothing of what they lie beside.
  std::uint32_t in = 0, nearest = limit.byTile ? head.seen.nearest : 0;
  for (std::uint32_t y = range.y0; y <= range.y1; ++y)
    for (std::uint32_t x = range.x0; x <= range.x1; ++x) {
      const auto tile = static_cast<std::uint32_t>(y * limit.across + x);
      const std::uint32_t bit = ((y - range.y0) * 2 + (x - range.x0)) & 31;
      const std::uint32_t sees = ~(head.seen.misses >> bit) & (nearest <= (limit.byTile ? limit.byTile[tile] : 0)) & 1;
      std::memcpy(to, &tile, sizeof tile);
      to += sees * sizeof tile;
      counts[tile] += sees, in += sees;
    }
  std::memcpy(start, &in, sizeof in);
  if (in > 0) arena.take(static_cast<std::size_t>(to - start) + bytes), ++seen;
  return to;
}

void ListBuilder::Part::write(std::byte* rows, std::size_t rowSize, bool eyeForms) {
  for (const ListLevel level : {narrow, wide})
    for (std::size_t kind = 0; kind < kindCount; ++kind) {
      const auto bytes = found[level][kind].bytes();
      if (bytes.empty()) continue;
      std::uint32_t* next = tiles[level][kind].data();
      if (rowSize == 16) writeRows<16>(bytes, rowsOf(kind, eyeForms), rows, next);
      else writeRows<32>(bytes, rowsOf(kind, eyeForms), rows, next);
    }
}

}  // namespace solidcast
