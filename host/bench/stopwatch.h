// Wall time, and the processor time of all threads: on a machine with other work the second still tells what a way costs.
#pragma once
#include <sys/resource.h>

#include <chrono>

namespace solidcast::bench {

struct Span {
  double wall_ms = 0, cpu_ms = 0;
};
inline Span operator+(const Span& a, const Span& b) { return {a.wall_ms + b.wall_ms, a.cpu_ms + b.cpu_ms}; }

class Stopwatch {
 public:
  /// Since the making, or the last lap().
  Span lap() {
    const Clock::time_point now = Clock::now();
    const double cpu = cpuMs();
    const Span span{std::chrono::duration<double, std::milli>(now - wall_).count(), cpu - cpu_};
    wall_ = now, cpu_ = cpu;
    return span;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static double cpuMs() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) * 1e3 + static_cast<double>(t.tv_usec) / 1e3;
    };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
  }
  Clock::time_point wall_ = Clock::now();
  double cpu_ = cpuMs();
};

}  // namespace solidcast::bench
