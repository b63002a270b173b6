// Threads that stay (host/cast/workers.h): where they meet, and what happens when what they work for fails.
#include "host/cast/workers.h"

#include <gtest/gtest.h>

#include <chrono>
#include <stdexcept>
#include <thread>

#include "host/cast/list_build.h"
#include "host/scene/random.h"

namespace solidcast {
namespace {

/// One of them comes late, now by less than the others stay awake for, now by more.
TEST(Workers, NobodyLeavesAMeetingBeforeAllHaveCome) {
  Workers workers;
  const int threads = static_cast<int>(workers.threads());
  Meeting meeting(workers.threads());
  std::atomic<int> come = 0, early = 0;
  workers.run(threads, [&](int thread) {
    for (int round = 1; round <= 200; ++round) {
      if (round % threads == thread && round % 10 == 0)
        std::this_thread::sleep_for(std::chrono::microseconds(round % 20 == 0 ? 20 : 2000));
      ++come;
      meeting.wait();
      early += come < round * threads;
      meeting.wait();
    }
  });
  EXPECT_EQ(early, 0);
  EXPECT_EQ(come, 200 * threads);
}

/// The caller's own pieces are done before those of the others.
TEST(Workers, AllPiecesAreDoneWhenRunReturns) {
  Workers workers;
  const auto caller = std::this_thread::get_id();
  std::atomic<int> others = 0;
  for (int round = 0; round < 50; ++round) {
    std::atomic<int> done = 0;
    const int pieces = 2 * static_cast<int>(workers.threads());
    workers.run(pieces, [&](int) {
      const bool other = std::this_thread::get_id() != caller;
      others += other;
      std::this_thread::sleep_for(std::chrono::microseconds(other ? 2000 : 300));
      ++done;
    });
    EXPECT_EQ(done, pieces);
  }
  EXPECT_GT(others + (workers.threads() == 1), 0);
}

/// Whether work comes at once, later than they stay awake for, or not at all before they are woken again.
TEST(Workers, WhoHasBeenWokenTakesWhatComes) {
  Workers workers;
  const int threads = static_cast<int>(workers.threads());
  for (int round = 0; round < 60; ++round) {
    workers.wake();
    if (round % 3 == 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (round % 3 == 2) workers.wake();
    Meeting meeting(workers.threads());
    std::atomic<int> come = 0;
    workers.run(threads, [&](int) { ++come, meeting.wait(); });  // needs all of them
    EXPECT_EQ(come, threads);
  }
}

TEST(ListBuilder, PassesOnWhatTheRoomThrowsAndServesAgain) {
  for (const std::size_t solids : {std::size_t{20}, std::size_t{5000}}) {  // one thread, and all
    const Scene scene = randomScene("sphere", solids, 1);
    const Silhouette silhouette(scene, 64, 48, 1);
    ListGrid grid;
    grid.region = {0, 0, 64, 48};
    grid.across = 16, grid.down = 12;
    ListBuilder builder;
    const auto collect = [&](const std::function<ListRoom()>& room) {
      builder.collect(scene, eyeFrame(scene, RealType::f32), RealType::f32, true, silhouette, grid, room);
    };
    EXPECT_THROW(collect([]() -> ListRoom { throw std::runtime_error("no room"); }), std::runtime_error);
    std::vector<std::byte> rows, lanes;
    collect([&] {
      rows.resize(builder.rows() * rowBytes(RealType::f32));
      lanes.resize(builder.listedTiles() * 32);
      return ListRoom{rows, lanes, builder.listedTiles(), builder.kinds()};
    });
    EXPECT_GT(builder.listedTiles(), 0u);
    EXPECT_NE(rows, std::vector<std::byte>(rows.size()));
  }
}

}  // namespace
}  // namespace solidcast
