#include "host/cli/clock.h"

#include <ctime>

namespace solidcast::cli {
namespace {

double milliseconds(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return now.tv_sec * 1e3 + now.tv_nsec * 1e-6;
}

const double start = milliseconds(CLOCK_MONOTONIC) - milliseconds(CLOCK_PROCESS_CPUTIME_ID);

}  // namespace

double sinceProcessStart() { return milliseconds(CLOCK_MONOTONIC) - start; }

}  // namespace solidcast::cli
