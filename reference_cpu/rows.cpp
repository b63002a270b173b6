#include "reference_cpu/rows.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace solidcast::reference {

void forEachRow(int rows, int threads, const std::function<void(int row)>& work) {
  if (threads <= 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  std::atomic<int> next = 0;
  std::exception_ptr failure;
  std::mutex failureGuard;
  const auto worker = [&] {
    try {
      for (int row = next++; row < rows; row = next++) work(row);
    } catch (...) {
      next = rows;
      const std::lock_guard lock(failureGuard);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> helpers;
    for (int i = 1; i < std::min(threads, rows); ++i) helpers.emplace_back(worker);
    worker();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace solidcast::reference
