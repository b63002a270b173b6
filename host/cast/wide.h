// Functions whose loops are vectors: compiled for several instruction sets, the processor chooses. None of them fuses
// products and sums (-ffp-contract), so that all give the same numbers. The sanitizers are not ready yet when such a choice
// is made.
#pragma once

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define WIDE __attribute__((target_clones("default", "avx2", "avx512f")))
#else
#define WIDE
#endif
