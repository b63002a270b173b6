// Sixteen numbers at a time: the operations that the kernels are written in, by AVX-512.
#include <immintrin.h>

#include "host/bench/kernels.h"
#ifdef SOLIDCAST_EMBREE
#include "host/bench/embree_api.h"
#endif

namespace solidcast::bench::avx512 {
namespace {

constexpr int kWide = 16;
using V = __m512;
using M = __mmask16;

V all(float x) { return _mm512_set1_ps(x); }
V load(const float* p) { return _mm512_loadu_ps(p); }
M lanes(int n) { return static_cast<M>((1u << n) - 1); }  // the first n
V load(M m, const float* p) { return _mm512_maskz_loadu_ps(m, p); }
void store(M m, float* p, V v) { _mm512_mask_storeu_ps(p, m, v); }
void store(M m, unsigned* p, unsigned v) { _mm512_mask_storeu_epi32(p, m, _mm512_set1_epi32(static_cast<int>(v))); }
M loadMask(M m, const int* p) {
  return _mm512_mask_cmplt_epi32_mask(m, _mm512_maskz_loadu_epi32(m, p), _mm512_setzero_si512());
}
V root(V v) { return _mm512_sqrt_ps(v); }
V smaller(V a, V b) { return _mm512_min_ps(a, b); }
V larger(V a, V b) { return _mm512_max_ps(a, b); }
V magnitude(V v) { return _mm512_abs_ps(v); }
V signOf(V v) { return _mm512_and_ps(v, _mm512_set1_ps(-0.f)); }
V flip(V v, V sign) { return _mm512_xor_ps(v, sign); }
M less(V a, V b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
M atMost(V a, V b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
M both(M a, M b) { return a & b; }
bool any(M m) { return m != 0; }
V select(M m, V yes, V no) { return _mm512_mask_blend_ps(m, no, yes); }
using W = __m512i;
W whole(V v) { return _mm512_cvttps_epi32(v); }
W words(unsigned v) { return _mm512_set1_epi32(static_cast<int>(v)); }
W times(W a, W b) { return _mm512_mullo_epi32(a, b); }
W either(W a, W b) { return _mm512_or_si512(a, b); }
template <int N>
W up(W a) {
  return _mm512_slli_epi32(a, N);
}
void store(std::uint32_t* p, W v) { _mm512_storeu_si512(p, v); }

#include "host/bench/wide_kernels.h"

}  // namespace
}  // namespace solidcast::bench::avx512

constinit const solidcast::bench::Kernels solidcast::bench::kAvx512 = solidcast::bench::avx512::table("avx512");
