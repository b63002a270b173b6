// Embree asks for this in every thread; denormal numbers would cost every peer alike.
#pragma once
#include <immintrin.h>

namespace solidcast::bench {

/// Until its end, denormal results and operands are zero.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | _MM_FLUSH_ZERO_ON | 0x0040); }
  ~FlushDenormals() { _mm_setcsr(before_); }
  FlushDenormals(const FlushDenormals&) = delete;

 private:
  unsigned before_;
};

}  // namespace solidcast::bench
