#include "host/watch/board.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <cstdint>
#include <exception>
#include <utility>

namespace solidcast::watch {
namespace {

constexpr std::size_t kMostWishes = 32;
constexpr std::chrono::seconds kPatience{20};         // of who asks
constexpr std::chrono::seconds kComparisonLasts{15};  // after somebody looked

}  // namespace

Board::Board() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {}
Board::~Board() { ::close(event_); }

void Board::put(const Session& session) {
  News next{0, session.frame(), session.view(), session.problems(), session.warnings(), nullptr};
  const std::lock_guard lock(mutex_);
  next.comparison = news_.comparison;
  next.version = news_.version;
  if (next == news_) return;
  news_ = std::move(next);
  ++news_.version;
  changed_.notify_all();
}

void Board::serve(Session& session) {
  std::uint64_t count = 0;
  [[maybe_unused]] const auto got = ::read(event_, &count, sizeof count);
  for (;;) {
    Wish wish;
    {
      const std::lock_guard lock(mutex_);
      if (wishes_.empty()) return;
      wish = std::move(wishes_.front());
      wishes_.pop_front();
    }
    try {
      wish.reply.set_value({true, wish.act(session)});
    } catch (const Error& error) {
      wish.reply.set_value({false, error.what()});
      if (error.code() == Exit::noDevice) throw;
    }
  }
}

News Board::news() const {
  const std::lock_guard lock(mutex_);
  return news_;
}

News Board::newer(std::int64_t version, std::chrono::milliseconds most) const {
  std::unique_lock lock(mutex_);
  changed_.wait_for(lock, most, [&] { return ended_ || news_.version != version; });
  return news_;
}

std::optional<Reply> Board::ask(std::function<std::string(Session&)> wish) {
  std::future<Reply> reply;
  {
    const std::lock_guard lock(mutex_);
    if (ended_ || wishes_.size() >= kMostWishes) return std::nullopt;
    wishes_.push_back({std::move(wish), {}});
    reply = wishes_.back().reply.get_future();
  }
  const std::uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(event_, &one, sizeof one);
  if (reply.wait_for(kPatience) != std::future_status::ready) return std::nullopt;
  try {
    return reply.get();
  } catch (const std::future_error&) { return std::nullopt; }  // the end came first
}

void Board::wantComparison() {
  const std::lock_guard lock(mutex_);
  comparisonWanted_ = std::chrono::steady_clock::now();
  changed_.notify_all();
}

bool Board::compareWanted() const {
  return news_.frame && std::chrono::steady_clock::now() - comparisonWanted_ < kComparisonLasts;
}

std::shared_ptr<const Frame> Board::toCompare() const {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] {
    return ended_ || (compareWanted() && (!news_.comparison || news_.comparison->frame != news_.frame->number));
  });
  return ended_ ? nullptr : news_.frame;
}

bool Board::outdated(const Frame& frame) const {
  const std::lock_guard lock(mutex_);
  return ended_ || !compareWanted() || news_.frame->number != frame.number;
}

void Board::put(std::shared_ptr<const Comparison> comparison) {
  const std::lock_guard lock(mutex_);
  ++news_.version;
  news_.comparison = std::move(comparison);
  changed_.notify_all();
}

void Board::end() {
  const std::lock_guard lock(mutex_);
  ended_ = true;
  wishes_.clear();
  changed_.notify_all();
}

}  // namespace solidcast::watch
