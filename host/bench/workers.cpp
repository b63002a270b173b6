#include "host/bench/workers.h"

#include <immintrin.h>

#include <algorithm>

namespace solidcast::bench {
namespace {

/// Embree asks for this in every thread; denormal numbers would cost every peer alike.
void flushDenormals() {
  _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
  _mm_setcsr(_mm_getcsr() | 0x0040);  // denormals are zero
}

}  // namespace

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
  const unsigned before = _mm_getcsr();
  {
    const std::lock_guard lock(mutex_);
    work_ = &work, count_ = count, next_ = 0, busy_ = static_cast<int>(helpers_.size()), ++round_;
  }
  start_.notify_all();
  flushDenormals();
  take();
  _mm_setcsr(before);
  std::unique_lock lock(mutex_);
  end_.wait(lock, [this] { return busy_ == 0; });
}

void Workers::take() {
  for (int i = next_++; i < count_; i = next_++) (*work_)(i);
}

void Workers::help() {
  flushDenormals();
  for (int seen = 0;;) {
    {
      std::unique_lock lock(mutex_);
      start_.wait(lock, [&] { return over_ || round_ != seen; });
      if (over_) return;
      seen = round_;
    }
    take();
    const std::lock_guard lock(mutex_);
    if (--busy_ == 0) end_.notify_one();
  }
}

}  // namespace solidcast::bench
