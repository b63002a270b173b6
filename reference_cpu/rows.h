// The reference's only parallelism: rows of an image, or blocks of rays, shared out to threads.
#pragma once
#include <functional>

namespace solidcast::reference {

/// Calls work(row) for every row from 0 to rows - 1, on `threads` threads (0: all cores), in no certain order.
/// The first exception of `work` ends the whole and is thrown here.
void forEachRow(int rows, int threads, const std::function<void(int row)>& work);

}  // namespace solidcast::reference
