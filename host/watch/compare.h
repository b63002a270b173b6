// The CPU reference's picture of what the watch shows, made in the background while somebody looks at it.
#pragma once
#include <thread>

#include "host/watch/board.h"
#include "reference_cpu/reference.h"

namespace solidcast::watch {

/// One thread of low priority. A frame that is outdated before its last row is dropped.
class BackgroundReference {
 public:
  BackgroundReference(Board& board, reference::Precision precision);
  ~BackgroundReference();  // ends the board
  BackgroundReference(const BackgroundReference&) = delete;

 private:
  Board& board_;
  std::jthread thread_;
};

}  // namespace solidcast::watch
