// Threads that stay, for work of a millisecond or so, of which starting them would be a part: all cores take the next piece
// until none is left.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace solidcast {

class Workers {
 public:
  Workers();
  ~Workers();
  Workers(const Workers&) = delete;
  /// work(i) for all i below `count`, on all threads, the caller's among them. `work` must not throw. Up to threads() pieces
  /// are under way at the same time, so that they may wait for each other.
  void run(int count, const std::function<void(int)>& work);
  unsigned threads() const { return static_cast<unsigned>(helpers_.size()) + 1; }

 private:
  void help();
  void take();

  std::mutex mutex_;
  std::condition_variable start_, end_;
  const std::function<void(int)>* work_ = nullptr;
  std::atomic<int> next_ = 0;
  int count_ = 0, busy_ = 0, round_ = 0;
  bool over_ = false;
  std::vector<std::thread> helpers_;
};

}  // namespace solidcast
