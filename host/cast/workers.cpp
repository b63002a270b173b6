#include "host/cast/workers.h"

#include <algorithm>

namespace solidcast {
namespace {

/// For some 50 us at most; whether it has come to be.
bool soon(const auto& condition) {
  for (int i = 0; i < 2000; ++i) {
    if (condition()) return true;
#ifdef __x86_64__
    __builtin_ia32_pause();
#endif
  }
  return false;
}

}  // namespace

void Meeting::wait() {
  const int round = round_;
  if (--missing_ == 0) {
    missing_ = threads_;
    ++round_;
    round_.notify_all();
    return;
  }
  if (!soon([&] { return round_ != round; })) round_.wait(round);
}

Workers::Workers() {
  const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  for (unsigned i = 1; i < threads; ++i) helpers_.emplace_back([this] { help(); });
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  start_.notify_all();
  for (std::thread& helper : helpers_) helper.join();
}

void Workers::run(int count, const std::function<void(int)>& work) {
  if (count == 1) return work(0);
  {
    const std::lock_guard lock(mutex_);
    work_ = &work, count_ = count, next_ = 0, busy_ = static_cast<int>(helpers_.size()), ++round_;
  }
  start_.notify_all();
  take();
  if (soon([&] { return busy_ == 0; })) return;
  std::unique_lock lock(mutex_);
  end_.wait(lock, [this] { return busy_ == 0; });
}

void Workers::wake() {
  {
    const std::lock_guard lock(mutex_);
    ++called_;
  }
  start_.notify_all();
}

void Workers::take() {
  for (int i = next_++; i < count_; i = next_++) (*work_)(i);
}

void Workers::help() {
  for (int seen = 0, heard = 0;;) {
    {
      std::unique_lock lock(mutex_);
      start_.wait(lock, [&] { return over_ || round_ != seen || called_ != heard; });
      if (over_) return;
      heard = called_;
    }
    if (!soon([&] { return round_ != seen; })) continue;
    seen = round_;
    take();
    if (--busy_ > 0) continue;
    const std::lock_guard lock(mutex_);
    end_.notify_one();
  }
}

}  // namespace solidcast
