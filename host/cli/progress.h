// Progress bar on standard error, only when that is a terminal and the work is long.
#pragma once
#include <chrono>

namespace solidcast::cli {

class Progress {
 public:
  Progress();
  ~Progress();                 // wipes the bar
  void show(double fraction);  // 0..1; draws at most ten times a second, first after half a second

 private:
  bool terminal_ = false, drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace solidcast::cli
