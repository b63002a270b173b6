// The heap in large pages. A run of the program is short: of a quarter of a second a third went into the heap's first
// touch of each page, most of it by the driver's compiler (docs/benchmarks.md: Whole process).
#pragma once

namespace solidcast::cli {

/// Asks the system for large pages behind malloc, and malloc to keep what it has. To be called before the first large
/// allocation. Where there are no large pages, or another malloc, it does nothing.
void useLargePages();

}  // namespace solidcast::cli
