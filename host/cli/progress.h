// Progress bar on standard error, only when that is a terminal and the work is long.
#pragma once
#include <chrono>
#include <string>

namespace solidcast::cli {

class Progress {
 public:
  Progress();
  ~Progress();  // wipes the bar
  /// 0..1, and what is being worked at. Draws at most ten times a second, first after half a second.
  void show(double fraction, const std::string& what = "");

 private:
  bool terminal_ = false, drawn_ = false;
  std::chrono::steady_clock::time_point start_, last_;
};

}  // namespace solidcast::cli
