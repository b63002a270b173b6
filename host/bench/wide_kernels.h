// All kernels of an instruction set, and their table. Included inside its namespace.

#include "host/bench/simd_kernel.h"
#ifdef SOLIDCAST_EMBREE
#include "host/bench/embree_kernel.h"
#endif

constexpr Kernels table(const char* name) {
  Kernels kernels{name, kWide, simdRows<false>, simdRows<true>};
#ifdef SOLIDCAST_EMBREE
  kernels.embree16 = embree16, kernels.embree1 = embree1;
  kernels.embreePlanes = planes, kernels.embreeBoxes = boxes, kernels.embreeQuadrics = quadrics;
#endif
  return kernels;
}
