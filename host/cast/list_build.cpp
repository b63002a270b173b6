#include "host/cast/list_build.h"

#include <algorithm>
#include <barrier>
#include <cstring>
#include <thread>

#include "host/cast/depth_bounds.h"
#include "host/cast/solids/all.h"

namespace solidcast {
namespace {

#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  static_assert(EYE_ROWS == 2 || EYE_ROWS == 4 || EYE_ROWS == 5, "Part::write knows these");
#include "shaders/solids.def"
#undef SOLID
constexpr std::uint32_t eyeRowsOf[kindCount] = {
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) EYE_ROWS,
#include "shaders/solids.def"
#undef SOLID
};

/// Solids in more tiles than this go to the wide ones.
constexpr int mostTiles = 256;
enum Level : std::size_t { narrow, wide };

/// Among a few from all over the scene: spheres hide others (depth_bounds.h).
bool someSphere(const World& world) {
  for (std::size_t i = 0; i < world.solids.size(); i += world.solids.size() / 64 + 1)
    if (std::holds_alternative<Sphere>(world.solids[i].shape)) return true;
  return false;
}

void onAllThreads(std::size_t threads, const auto& work) {
  std::vector<std::thread> helpers;
  for (std::size_t t = 1; t < threads; ++t) helpers.emplace_back([&work, t] { work(t); });
  work(std::size_t{0});
  for (std::thread& helper : helpers) helper.join();
}

/// Bytes at the end of which more are put, without being cleared first.
class Arena {
 public:
  std::byte* add(std::size_t bytes) {
    if (used_ + bytes > room_) {
      room_ = std::max<std::size_t>({2 * room_, used_ + bytes, std::size_t{1} << 16});
      auto bigger = std::make_unique_for_overwrite<std::byte[]>(room_);
      std::memcpy(bigger.get(), data_.get(), used_);
      data_ = std::move(bigger);
    }
    std::byte* to = data_.get() + used_;
    used_ += bytes;
    return to;
  }
  void clear() { used_ = 0; }
  std::span<const std::byte> bytes() const { return {data_.get(), used_}; }

 private:
  std::unique_ptr<std::byte[]> data_ = std::make_unique_for_overwrite<std::byte[]>(16);
  std::size_t room_ = 16, used_ = 0;
};

struct Place {  // tiles from and to, both included
  std::uint16_t fromX, fromY, toX, toY;
};
struct Head {
  std::uint32_t solid;
  float nearest;  // Rectangle::nearest, rounded down
  Place place;
};

/// By tile, the depth beyond which nothing of it is seen; none: no limits.
struct Limits {
  static constexpr std::size_t window = 4;
  const float* byTile = nullptr;
  const float* byWindow = nullptr;  // the deepest of the tiles from x to x + 3 and y to y + 3
  std::size_t across = 0;

  bool reached(const Head& head) const {
    if (!byTile) return true;
    const bool within =
        head.place.toX - head.place.fromX < int(window) && head.place.toY - head.place.fromY < int(window);
    if (within && head.nearest > byWindow[head.place.fromY * across + head.place.fromX]) return false;
    for (std::size_t y = head.place.fromY; y <= head.place.toY; ++y)
      for (std::size_t tile = y * across + head.place.fromX; tile <= y * across + head.place.toX; ++tile)
        if (head.nearest <= byTile[tile]) return true;
    return false;
  }
};

}  // namespace

/// What one thread found in its share of the solids, in their order.
struct ListBuilder::Part {
  DepthBounds depths;
  std::vector<Head> reached;
  std::array<Arena, 2> heads;                                              // Head, of all that is seen
  std::array<std::array<Arena, kindCount>, 2> found;                       // Head and record, one after the other
  std::array<std::array<std::vector<std::uint32_t>, kindCount>, 2> tiles;  // entries by tile; then where the next goes
  bool grazing = false, farSphere = false, boxOnFace = false;
  std::size_t seen = 0;

  void start() {
    grazing = farSphere = boxOnFace = false;
    seen = 0;
    for (Arena& arena : heads) arena.clear();
    for (auto& level : found)
      for (Arena& arena : level) arena.clear();
    for (auto& level : tiles)
      for (auto& counts : level) counts.clear();
  }

  /// Where each solid is seen, and what it hides.
  void look(const World& world, std::size_t from, std::size_t to, const Silhouette& silhouette, const EyeFrames& eye,
            const ListGrid& grid, bool hiding) {
    constexpr std::size_t ahead = 16;
    for (std::size_t i = from; i < to; ++i) {
      if (i + ahead < to) fetch(world.solids[i + ahead]);
      std::visit(
          [&](const auto& solid) {
            // Of the whole scene, seen or not: so that fast has the same bits in every plan.
            if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, Sphere>)
              farSphere = farSphere || isFar(solid, eye.plain);
            Head head;
            Level level;
            const Rectangle rectangle = silhouette.rectangle(solid);
            if (!findPlace(rectangle, grid, head.place, level)) return;
            head.solid = static_cast<std::uint32_t>(i);
            head.nearest = static_cast<float>(rectangle.nearest * (1 - 1e-6));
            std::memcpy(heads[level].add(sizeof head), &head, sizeof head);
            if (hiding && level == narrow && !depths.hidden(rectangle)) depths.add(solid);
          },
          world.solids[i].shape);
    }
  }

  /// Records of the solids that are in front of the depth limit of one of their tiles.
  void pack(const World& world, RealType type, const EyeFrames& eye, const ListGrid& grid, const Limits& limits) {
    // Those that are left lie far apart in memory: they are fetched a few ahead.
    constexpr std::size_t ahead = 8;
    for (const Level level : {wide, narrow}) {
      reached.clear();
      const auto bytes = heads[level].bytes();
      for (const std::byte* at = bytes.data(); at != bytes.data() + bytes.size(); at += sizeof(Head)) {
        Head head;
        std::memcpy(&head, at, sizeof head);
        if (level == wide || limits.reached(head)) reached.push_back(head);
      }
      for (std::size_t i = 0; i < reached.size(); ++i) {
        const Head& head = reached[i];
        if (i + ahead < reached.size()) fetch(world.solids[reached[i + ahead].solid]);
        std::visit(
            [&](const auto& solid) {
              packed(solid, eye, head.solid, type, [&](const auto& record) { add(record, head, level, grid, limits); });
              if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, AABox>)
                boxOnFace = boxOnFace || eyeOnFacePlane(solid, eye.extended);
            },
            world.solids[head.solid].shape);
      }
    }
  }

  static void fetch(const SolidEntry& solid) {
    const auto* at = reinterpret_cast<const char*>(&solid);
    for (std::size_t line = 0; line < sizeof solid; line += 64) __builtin_prefetch(at + line);
  }

  template <class T>
  void add(const EyeRecord<T>& record, const Head& head, Level level, const ListGrid& grid, const Limits& limits) {
    if (record.kind < 0) return;
    const auto kind = static_cast<std::size_t>(record.kind);
    ++seen;
    grazing = grazing || record.grazing;
    const std::size_t rowSize = rowBytes(record.type);
    std::byte* to = found[level][kind].add(sizeof head + rowSize * eyeRowsOf[kind]);
    std::memcpy(to, &head, sizeof head);
    for (int r = 0; r < record.rows; ++r) writeRow(to + sizeof head + rowSize * r, record.type, record.row[r]);
    auto& counts = tiles[level][kind];
    if (counts.empty())
      counts.assign(level == wide ? std::size_t{1} * grid.wideAcross() * grid.wideDown()
                                  : std::size_t{1} * grid.across * grid.down,
                    0);
    if (level == wide) eachTile(head, grid.wideAcross(), nullptr, [&](std::size_t tile) { ++counts[tile]; });
    else eachTile(head, grid.across, limits.byTile, [&](std::size_t tile) { ++counts[tile]; });
  }

  static void eachTile(const Head& head, std::size_t across, const float* limits, const auto& f) {
    for (std::size_t y = head.place.fromY; y <= head.place.toY; ++y)
      for (std::size_t tile = y * across + head.place.fromX; tile <= y * across + head.place.toX; ++tile)
        if (!limits || head.nearest <= limits[tile]) f(tile);
  }

  /// Pixel i is seen at i + 0.5, so that [a, b] holds centres from ceil(a - 0.5) to floor(b - 0.5). False: none.
  static bool findPlace(const Rectangle& r, const ListGrid& grid, Place& place, Level& level) {
    int x0 = 0, y0 = 0, x1 = grid.region.width - 1, y1 = grid.region.height - 1;
    if (!r.everywhere) {
      const auto clip = [](const Interval& i, int first, int& low, int& high) {
        // In this order NaN is as far as possible.
        const double from = std::max(0.0, i.from - 0.5 - first), to = std::min(double(high), i.to - 0.5 - first);
        if (to < from) return false;
        low = static_cast<int>(from);
        low += low < from;
        high = static_cast<int>(to);
        return low <= high;
      };
      if (!clip(r.x, grid.region.x, x0, x1) || !clip(r.y, grid.region.y, y0, y1)) return false;
    }
    x0 /= ListGrid::tile, x1 /= ListGrid::tile, y0 /= ListGrid::tile, y1 /= ListGrid::tile;
    level = std::int64_t{x1 - x0 + 1} * (y1 - y0 + 1) > mostTiles ? wide : narrow;
    if (level == wide) x0 /= grid.wide, x1 /= grid.wide, y0 /= grid.wide, y1 /= grid.wide;
    place = {static_cast<std::uint16_t>(x0), static_cast<std::uint16_t>(y0), static_cast<std::uint16_t>(x1),
             static_cast<std::uint16_t>(y1)};
    return true;
  }

  /// Copies every record to its tiles; tiles[][] says where each tile's next one goes.
  void write(std::byte* rows, std::size_t rowSize, const ListGrid& grid, const float* limits) {
    for (const Level level : {narrow, wide})
      for (std::size_t kind = 0; kind < kindCount; ++kind) {
        const auto bytes = found[level][kind].bytes();
        if (bytes.empty()) continue;
        // Of known size, a record is copied by a few vector moves: a sixth of all the time was memcpy's.
        const auto copy = [&]<std::size_t ROWS>() {
          const std::size_t across = level == wide ? grid.wideAcross() : grid.across;
          const float* depths = level == wide ? nullptr : limits;
          if (rowSize == 16) writeAs<16, ROWS>(bytes, rows, tiles[level][kind].data(), across, depths);
          else writeAs<32, ROWS>(bytes, rows, tiles[level][kind].data(), across, depths);
        };
        switch (eyeRowsOf[kind]) {
          case 2:
            copy.template operator()<2>();
            break;
          case 4:
            copy.template operator()<4>();
            break;
          case 5:
            copy.template operator()<5>();
            break;
        }
      }
  }
  template <std::size_t ROW_SIZE, std::size_t ROWS>
  static void writeAs(std::span<const std::byte> from, std::byte* rows, std::uint32_t* next, std::size_t across,
                      const float* limits) {
    constexpr std::size_t record = ROW_SIZE * ROWS;
    for (const std::byte* at = from.data(); at != from.data() + from.size(); at += sizeof(Head) + record) {
      Head head;
      std::memcpy(&head, at, sizeof head);
      eachTile(head, across, limits, [&](std::size_t tile) {
        std::memcpy(rows + next[tile] * ROW_SIZE, at + sizeof head, record);
        next[tile] += ROWS;
      });
    }
  }
};

ListBuilder::ListBuilder() {
  for (unsigned t = 0; t < std::max(1u, std::thread::hardware_concurrency()); ++t)
    parts_.push_back(std::make_unique<Part>());
}
ListBuilder::~ListBuilder() = default;

void ListBuilder::collect(const Scene& scene, RealType type, const Silhouette& silhouette, const ListGrid& grid) {
  grid_ = grid, type_ = type;
  const EyeFrames eye(eyeFrame(scene, type));
  const std::size_t solids = scene.world.solids.size(), threads = solids < 256 ? 1 : parts_.size();
  for (auto& part : parts_) part->start();
  // Looking for what is hidden costs a pass over the pixels, which a few solids do not repay.
  const std::size_t pixels = static_cast<std::size_t>(grid.region.width) * static_cast<std::size_t>(grid.region.height);
  hiding_ = silhouette.centresAlone() && solids > 1000 && solids > pixels / 64 && someSphere(scene.world);
  limits_.resize(hiding_ ? static_cast<std::size_t>(grid.across) * static_cast<std::size_t>(grid.down) : 0);
  windows_.resize(limits_.size());
  const Limits limits{hiding_ ? limits_.data() : nullptr, windows_.data(), static_cast<std::size_t>(grid.across)};
  std::barrier together(static_cast<std::ptrdiff_t>(threads));
  onAllThreads(threads, [&](std::size_t t) {
    Part& part = *parts_[t];
    if (hiding_)
      part.depths.start(silhouette, grid.region, grid.across * ListGrid::tile, grid.down * ListGrid::tile, type);
    part.look(scene.world, solids * t / threads, solids * (t + 1) / threads, silhouette, eye, grid, hiding_);
    if (hiding_) {
      together.arrive_and_wait();
      const auto down = static_cast<std::size_t>(grid.down);
      for (std::size_t y = down * t / threads; y < down * (t + 1) / threads; ++y) limitTiles(y, threads);
      together.arrive_and_wait();
      for (std::size_t y = down * t / threads; y < down * (t + 1) / threads; ++y) limitWindows(y);
      together.arrive_and_wait();
    }
    part.pack(scene.world, type, eye, grid, limits);
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

/// The deepest of each tile's pixels, by what any of the threads knows.
void ListBuilder::limitTiles(std::size_t tileRow, std::size_t threads) {
  const std::size_t across = static_cast<std::size_t>(grid_.across);
  float* limit = limits_.data() + tileRow * across;
  std::fill_n(limit, across, 0.f);
  for (std::size_t y = tileRow * ListGrid::tile; y < (tileRow + 1) * ListGrid::tile; ++y) {
    for (std::size_t x = 0; x < across * ListGrid::tile; ++x) {
      float nearest = parts_[0]->depths.row(y)[x];
      for (std::size_t t = 1; t < threads; ++t) nearest = std::min(nearest, parts_[t]->depths.row(y)[x]);
      limit[x / ListGrid::tile] = std::max(limit[x / ListGrid::tile], nearest);
    }
  }
}

void ListBuilder::limitWindows(std::size_t tileRow) {
  const std::size_t across = static_cast<std::size_t>(grid_.across), down = static_cast<std::size_t>(grid_.down);
  std::vector<float> deepest(across + Limits::window, 0.f);
  for (std::size_t y = tileRow; y < std::min(down, tileRow + Limits::window); ++y)
    for (std::size_t x = 0; x < across; ++x) deepest[x] = std::max(deepest[x], limits_[y * across + x]);
  for (std::size_t x = 0; x < across; ++x)
    windows_[tileRow * across + x] =
        std::max(std::max(deepest[x], deepest[x + 1]), std::max(deepest[x + 2], deepest[x + 3]));
}

/// Kind by kind and tile by tile, each tile's entries in the order of the solids.
void ListBuilder::layOut() {
  kinds_ = {};
  wideOnes_ = false;
  std::size_t row = 0;
  const std::size_t tiles = static_cast<std::size_t>(grid_.across) * static_cast<std::size_t>(grid_.down);
  total_.assign(tiles, 0);
  for (const Level level : {wide, narrow})
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
          row += std::size_t{entries} * eyeRowsOf[kind];
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
      parts_[part]->write(rows.data(), rowBytes(type_), grid_, hiding_ ? limits_.data() : nullptr);
  });
}

}  // namespace solidcast
