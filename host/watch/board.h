// Where the watch and its viewers meet: the watch puts up what there is to see, viewers wait for news and leave wishes. No
// viewer can hold up the watch: everything here is bounded, and nobody waits under the lock.
#pragma once
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host/watch/session.h"

namespace solidcast::watch {

/// The CPU reference's picture of a frame, and how the frame differs from it.
struct Comparison {
  int frame = 0;
  int width = 0, height = 0;
  std::vector<std::uint8_t> cpu, heat;   // 3 bytes a pixel
  std::int64_t differing = 0;            // pixels
  double largest = 0, milliseconds = 0;  // in levels; of the reference
  int worstX = -1, worstY = -1;
  std::string fault;  // why there is none; "": there is
};

/// What there is to see at a moment.
struct News {
  std::int64_t version = 0;
  std::shared_ptr<const Frame> frame;
  View view;
  std::vector<Problem> problems;
  std::vector<std::string> warnings;
  std::shared_ptr<const Comparison> comparison;  // perhaps of an older frame
  bool operator==(const News&) const = default;
};

/// What a viewer is told: JSON, or what is wrong with the wish.
struct Reply {
  bool good = false;
  std::string text;
};

class Board {
 public:
  Board();
  ~Board();
  Board(const Board&) = delete;

  // --- the watch's side
  /// Puts up what is new, if anything is.
  void put(const Session& session);
  /// Can be read when there are wishes.
  int readable() const { return event_; }
  /// Fulfils the wishes that are there.
  void serve(Session& session);

  // --- the viewers' side
  News news() const;
  /// Waits until there is something newer than `version`, at most so long.
  News newer(std::int64_t version, std::chrono::milliseconds most) const;
  /// Asks the watch's thread; nullopt: it is too busy, or the end has come.
  std::optional<Reply> ask(std::function<std::string(Session&)> wish);
  /// Somebody looks at the comparison.
  void wantComparison();

  // --- the comparison's side
  /// Waits for a frame that somebody wants compared, and is not yet; none: the end.
  std::shared_ptr<const Frame> toCompare() const;
  /// Nobody wants this one any more.
  bool outdated(const Frame& frame) const;
  void put(std::shared_ptr<const Comparison> comparison);

  /// Wakes everybody who waits; nobody will again.
  void end();

 private:
  struct Wish {
    std::function<std::string(Session&)> act;
    std::promise<Reply> reply;
  };
  bool compareWanted() const;

  int event_ = -1;
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  News news_;
  std::deque<Wish> wishes_;
  std::chrono::steady_clock::time_point comparisonWanted_{};
  bool ended_ = false;
};

}  // namespace solidcast::watch
