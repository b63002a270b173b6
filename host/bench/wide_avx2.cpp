// Eight numbers at a time: the operations that the kernels are written in, by AVX2 and FMA.
#include <immintrin.h>

#include "host/bench/kernels.h"
#ifdef SOLIDCAST_EMBREE
#include "host/bench/embree_api.h"
#endif

namespace solidcast::bench::avx2 {
namespace {

constexpr int kWide = 8;
using V = __m256;
struct M {
  __m256 bits;
};

V all(float x) { return _mm256_set1_ps(x); }
V load(const float* p) { return _mm256_loadu_ps(p); }
M lanes(int n) {
  const __m256i counted = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  return {_mm256_castsi256_ps(_mm256_cmpgt_epi32(_mm256_set1_epi32(n), counted))};
}
V load(M m, const float* p) { return _mm256_maskload_ps(p, _mm256_castps_si256(m.bits)); }
void store(M m, float* p, V v) { _mm256_maskstore_ps(p, _mm256_castps_si256(m.bits), v); }
void store(M m, unsigned* p, unsigned v) {
  _mm256_maskstore_epi32(reinterpret_cast<int*>(p), _mm256_castps_si256(m.bits),
                         _mm256_set1_epi32(static_cast<int>(v)));
}
M loadMask(M m, const int* p) { return {_mm256_castsi256_ps(_mm256_maskload_epi32(p, _mm256_castps_si256(m.bits)))}; }
V root(V v) { return _mm256_sqrt_ps(v); }
V smaller(V a, V b) { return _mm256_min_ps(a, b); }
V larger(V a, V b) { return _mm256_max_ps(a, b); }
V magnitude(V v) { return _mm256_andnot_ps(_mm256_set1_ps(-0.f), v); }
V signOf(V v) { return _mm256_and_ps(v, _mm256_set1_ps(-0.f)); }
V flip(V v, V sign) { return _mm256_xor_ps(v, sign); }
M less(V a, V b) { return {_mm256_cmp_ps(a, b, _CMP_LT_OQ)}; }
M atMost(V a, V b) { return {_mm256_cmp_ps(a, b, _CMP_LE_OQ)}; }
M both(M a, M b) { return {_mm256_and_ps(a.bits, b.bits)}; }
bool any(M m) { return _mm256_movemask_ps(m.bits) != 0; }
V select(M m, V yes, V no) { return _mm256_blendv_ps(no, yes, m.bits); }
using W = __m256i;
W whole(V v) { return _mm256_cvttps_epi32(v); }
W words(unsigned v) { return _mm256_set1_epi32(static_cast<int>(v)); }
W times(W a, W b) { return _mm256_mullo_epi32(a, b); }
W either(W a, W b) { return _mm256_or_si256(a, b); }
template <int N>
W up(W a) {
  return _mm256_slli_epi32(a, N);
}
void store(std::uint32_t* p, W v) { _mm256_storeu_si256(reinterpret_cast<__m256i*>(p), v); }

#include "host/bench/wide_kernels.h"

}  // namespace
}  // namespace solidcast::bench::avx2

constinit const solidcast::bench::Kernels solidcast::bench::kAvx2 = solidcast::bench::avx2::table("avx2");
