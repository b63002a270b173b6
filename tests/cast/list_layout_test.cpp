// Rows and lanes of lists (host/cast/list_layout.h): read back as the shader does, they are each tile's solids in order, whether
// the threads took them by wide tiles or wherever they are.
#include "host/cast/list_layout.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace solidcast {
namespace {

struct Listed {
  std::size_t kind;
  Footprint seen;
  bool wide;
};

class Layout : public testing::Test {
 protected:
  static constexpr int across = 52, down = 36, threads = 3;  // the last wide tiles are a part of one
  static constexpr std::size_t kindsThere[] = {kinds::sphere, kinds::triangle};

  Layout() {
    grid_.region = {0, 0, across * 4, down * 4};
    grid_.across = across, grid_.down = down;
    std::mt19937 bits(5);
    const auto below = [&](std::uint32_t n) { return static_cast<int>(bits() % n); };
    limits_.start(across, down);
    for (std::size_t y = 0; y < down; ++y)
      for (std::size_t x = 0; x < across; ++x) limits_.row(y)[x] = static_cast<DepthCode>(300 + below(700));
    wideLimits_.start(static_cast<std::size_t>(grid_.wideAcross()), static_cast<std::size_t>(grid_.wideDown()));
    for (std::size_t y = 0; y < 3; ++y)
      for (std::size_t x = 0; x < 4; ++x) wideLimits_.row(y)[x] = static_cast<DepthCode>(300 + below(700));
    for (int i = 0; i < 500; ++i) {
      const int most = i % 5 == 0 ? 100 : 7;
      Footprint f{below(across * 4), below(down * 4), 0, 0, static_cast<DepthCode>(below(1100)), DepthScale::none, 0};
      f.x1 = std::min(across * 4 - 1, f.x0 + below(static_cast<std::uint32_t>(most)));
      f.y1 = std::min(down * 4 - 1, f.y0 + below(static_cast<std::uint32_t>(most)));
      if (i % 2 && f.x1 / 4 - f.x0 / 4 < 2 && f.y1 / 4 - f.y0 / 4 < 2) f.misses = static_cast<std::uint8_t>(below(16));
      solids_.push_back({kindsThere[below(2)], f, i % 50 == 0});
      auto& record = records_.emplace_back();
      for (int k = 0; k < 16; ++k) record[k] = static_cast<float>(100 * i + k);
    }
  }

  const std::byte* record(std::size_t i) const { return reinterpret_cast<const std::byte*>(records_[i].data()); }

  /// By kind: the solids that the tile is to have, the wide tile's first.
  std::map<std::size_t, std::vector<std::size_t>> expected(int x, int y) const {
    std::map<std::size_t, std::vector<std::size_t>> of;
    for (const bool wide : {true, false})
      for (std::size_t i = 0; i < solids_.size(); ++i) {
        const Listed& s = solids_[i];
        const int side = wide ? 64 : 4, tx = x * 4 / side, ty = y * 4 / side;
        const int fx = s.seen.x0 / side, fy = s.seen.y0 / side;
        const TileLimits& limits = wide ? wideLimits_ : limits_;
        if (s.wide != wide || tx < fx || ty < fy || tx > s.seen.x1 / side || ty > s.seen.y1 / side) continue;
        if (s.seen.nearest > limits.row(static_cast<std::size_t>(ty))[tx]) continue;
        if (!wide && s.seen.misses != 0 && s.seen.misses >> ((ty - fy) * 2 + tx - fx) & 1) continue;
        of[s.kind].push_back(i);
      }
    return of;
  }

  /// Each thread's stretch of the solids.
  void forEachOf(int thread, auto&& solid) const {
    for (std::size_t i = solids_.size() * static_cast<std::size_t>(thread) / threads;
         i < solids_.size() * static_cast<std::size_t>(thread + 1) / threads; ++i)
      solid(i, solids_[i]);
  }
  bool someWide(const Crop& area) const {
    return std::any_of(solids_.begin(), solids_.end(), [&](const Listed& s) {
      const std::size_t x = static_cast<std::size_t>(area.x) / 64, y = static_cast<std::size_t>(area.y) / 64;
      return s.wide && overlap(s.seen, area) && s.seen.nearest <= wideLimits_.row(y)[x];
    });
  }
  Crop areaOf(std::size_t patch) const {
    return grid_.wideArea(static_cast<int>(patch) % grid_.wideAcross(), static_cast<int>(patch) / grid_.wideAcross());
  }
  void start() {
    layout_.start(grid_, threads, true);
    for (int t = 0; t < threads; ++t) layout_.share(static_cast<std::size_t>(t)).start(layout_);
  }
  void addWides() {
    for (int t = 0; t < threads; ++t)
      forEachOf(t, [&](std::size_t i, const Listed& s) {
        if (s.wide) layout_.share(static_cast<std::size_t>(t)).addWide(s.kind, record(i), s.seen, wideLimits_);
      });
  }

  void check() {
    layout_.layOut();
    layout_.order();
    ListRoom room;
    std::vector<std::byte> rows(layout_.rows() * 16), lanes(layout_.listedTiles() * 48);
    room = {rows, lanes, layout_.listedTiles(), layout_.kinds()};
    EXPECT_EQ(std::count(room.slots.begin(), room.slots.end(), true), 2);
    EXPECT_TRUE(layout_.wideOnes());
    for (std::size_t t = 0; t < threads; ++t) layout_.write(room, 16, t, threads);

    std::vector<int> times(across * down);
    std::size_t longest = 0, entries = 0;
    for (const std::uint32_t tile : layout_.tiles()) ++times.at(tile);
    EXPECT_EQ(times, std::vector<int>(across * down, 1));
    for (std::size_t lane = 0; lane < room.laneCount; ++lane) {
      ListLane head;
      ListSpan spans[2];
      std::memcpy(&head, &lanes[lane * 48], sizeof head);
      std::memcpy(spans, &lanes[lane * 48 + 16], sizeof spans);
      EXPECT_EQ(layout_.tiles()[lane], head.y / 4 * across + head.x / 4);
      auto of = expected(static_cast<int>(head.x / 4), static_cast<int>(head.y / 4));
      std::size_t length = 0;
      for (int k = 0; k < 2; ++k) {
        const std::size_t each = rowsOf(kindsThere[k], true);
        std::vector<std::size_t> found;
        for (std::uint32_t i = 0; i < spans[k].count; ++i) {
          const std::size_t row =
              i < spans[k].wideCount ? spans[k].wideFirst + i * each : spans[k].first + (i - spans[k].wideCount) * each;
          std::vector<float> numbers(4 * each);
          std::memcpy(numbers.data(), &rows.at(row * 16), each * 16);
          found.push_back(static_cast<std::size_t>(numbers[0]) / 100);
          for (std::size_t n = 0; n < numbers.size(); ++n) ASSERT_EQ(numbers[n], 100.f * found.back() + n);
        }
        EXPECT_EQ(found, of[kindsThere[k]]) << head.x << " " << head.y;
        length += found.size();
      }
      longest = std::max(longest, length), entries += length;
    }
    EXPECT_EQ(layout_.longest(), longest);
    EXPECT_GT(entries, 4000u);
    EXPECT_GT(layout_.tiles().size() - layout_.listedTiles(), 50u);
    for (const std::uint32_t tile : layout_.tiles().subspan(layout_.listedTiles()))
      EXPECT_TRUE(expected(static_cast<int>(tile % across), static_cast<int>(tile / across)).empty());
  }

  ListGrid grid_;
  TileLimits limits_, wideLimits_;
  std::vector<Listed> solids_;
  std::vector<std::array<float, 16>> records_;
  ListLayout layout_;
};

TEST_F(Layout, ByWideTilesEachTileHasItsSolidsInOrder) {
  for (int again = 0; again < 2; ++again) {  // with what the picture before has left
    start();
    for (std::size_t patch = 0; patch < 12; ++patch) {
      auto& share = layout_.share(patch * 7 % threads);
      const Crop area = areaOf(patch);
      TileLimits own;
      own.start(static_cast<std::size_t>(area.width) / 4, static_cast<std::size_t>(area.height) / 4);
      for (int y = 0; y < area.height / 4; ++y)
        std::copy_n(limits_.row(static_cast<std::size_t>(area.y / 4 + y)) + area.x / 4, area.width / 4,
                    own.row(static_cast<std::size_t>(y)));
      share.begin(patch);
      for (std::size_t i = 0; i < solids_.size(); ++i)
        if (const Listed& s = solids_[i]; !s.wide && overlap(s.seen, area))
          share.add(s.kind, record(i), within(s.seen, 0, area), own);
      share.finish(someWide(area));
    }
    addWides();
    check();
  }
}

TEST_F(Layout, WhereverTheyAreEachTileHasItsSolidsInOrder) {
  limits_.start(across, down);  // nothing is hidden
  for (int again = 0; again < 2; ++again) {
    start();
    for (int t = 0; t < threads; ++t)
      forEachOf(t, [&](std::size_t i, const Listed& s) {
        if (!s.wide) layout_.share(static_cast<std::size_t>(t)).addAnywhere(s.kind, record(i), s.seen);
      });
    for (std::size_t patch = 0; patch < 12; ++patch)
      layout_.share(patch % threads).gather(patch, someWide(areaOf(patch)));
    addWides();
    check();
  }
}

}  // namespace
}  // namespace solidcast
