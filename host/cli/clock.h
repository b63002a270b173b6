// Time since the process began, for `whole_ms`.
#pragma once

namespace solidcast::cli {

/// Milliseconds since the process began: wall time since this program's static initialisation, plus the CPU time
/// that the process had used until then (exec and dynamic linking; /proc/self/stat counts only in steps of 10 ms).
double sinceProcessStart();

}  // namespace solidcast::cli
