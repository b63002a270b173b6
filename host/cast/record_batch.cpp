#include "host/cast/record_batch.h"

#include <utility>

#include "host/cast/wide.h"

namespace solidcast {
namespace {

using Flags = std::int32_t[RecordBatch::block];

Vec3<double> triple(const RecordBatch::Numbers& n, std::size_t first, std::size_t i) {
  return {n.v[first][i], n.v[first + 1][i], n.v[first + 2][i]};
}

template <int ROWS>
inline __attribute__((always_inline)) void store(const EyeRecord<double>& record, std::size_t i,
                                                 RecordBatch::Rows& rows, Flags& poor, Flags& grazing) {
#pragma GCC unroll 20
  for (int k = 0; k < 4 * ROWS; ++k) rows[k][i] = static_cast<float>(record.row[k / 4][k % 4]);
  poor[i] = record.poor | (record.kind < 0), grazing[i] = record.grazing;
}

__attribute__((flatten)) WIDE void packSpheres(const Frame<double>& eye, const RecordBatch::Numbers& n,
                                               std::size_t count, RecordBatch::Rows& rows, Flags& poor,
                                               Flags& grazing) {
  for (std::size_t i = 0; i < count; ++i) {
    EyeRecord<double> record(RealType::f32);
    const Vec3<double> f = -eye.relative(triple(n, 0, i));
    const double r = n.v[3][i] / eye.unit, far = dot(f, f);
    sphereForms(f, r, eye, n.index[i], record);
    record.poor |= nearSurface(far, far - r * r, RealType::f32);
    store<2>(record, i, rows, poor, grazing);
  }
}

template <bool QUAD>
inline __attribute__((always_inline)) void spans(const Frame<double>& eye, const RecordBatch::Numbers& n,
                                                 std::size_t count, RecordBatch::Rows& rows, Flags& poor,
                                                 Flags& grazing) {
  for (std::size_t i = 0; i < count; ++i) {
    EyeRecord<double> record(RealType::f32);
    spanForms<double>({triple(n, 0, i), triple(n, 3, i), triple(n, 6, i)}, QUAD, eye, n.index[i], record);
    store<QUAD ? 5 : 4>(record, i, rows, poor, grazing);
  }
}
__attribute__((flatten)) WIDE void packTriangles(const Frame<double>& eye, const RecordBatch::Numbers& n,
                                                 std::size_t count, RecordBatch::Rows& rows, Flags& poor,
                                                 Flags& grazing) {
  spans<false>(eye, n, count, rows, poor, grazing);
}
__attribute__((flatten)) WIDE void packQuads(const Frame<double>& eye, const RecordBatch::Numbers& n, std::size_t count,
                                             RecordBatch::Rows& rows, Flags& poor, Flags& grazing) {
  spans<true>(eye, n, count, rows, poor, grazing);
}

}  // namespace

std::size_t RecordBatch::pack(const Frame<double>& eye) {
  const auto of = kind_ == kinds::sphere ? packSpheres : kind_ == kinds::triangle ? packTriangles : packQuads;
  of(eye, numbers_, count_, row_, poor_, grazing_);
  return std::exchange(count_, 0);
}

}  // namespace solidcast
