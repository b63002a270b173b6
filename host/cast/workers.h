// Threads that stay, for work of a millisecond or so, of which starting them would be a part: all cores take the next piece
// until none is left. To wake a thread takes up to 0.1 ms: who waits for work of less looks again and again for a while before
// he sleeps.
#pragma once
#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace solidcast {

/// Where threads wait for each other.
class Meeting {
 public:
  explicit Meeting(std::size_t threads) : threads_(threads), missing_(threads) {}
  /// Until all have come.
  void wait();

 private:
  const std::size_t threads_;
  std::atomic<std::size_t> missing_;
  std::atomic<int> round_ = 0;
};

class Workers {
 public:
  Workers();
  ~Workers();
  Workers(const Workers&) = delete;
  /// work(i) for all i below `count`, on all threads, the caller's among them. `work` must not throw. Up to threads() pieces
  /// are under way at the same time, so that they may wait for each other.
  void run(int count, const std::function<void(int)>& work);
  /// run() is called soon: the others wake meanwhile.
  void wake();
  unsigned threads() const { return static_cast<unsigned>(helpers_.size()) + 1; }

 private:
  void help();
  void take();

  std::mutex mutex_;
  std::condition_variable start_, end_;
  const std::function<void(int)>* work_ = nullptr;
  std::atomic<int> next_ = 0;
  std::atomic<int> busy_ = 0;
  std::atomic<int> round_ = 0;
  int count_ = 0, called_ = 0;
  bool over_ = false;
  std::vector<std::thread> helpers_;
};

}  // namespace solidcast
