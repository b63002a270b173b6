// fp32 records for one eye, of many solids of a kind at a time: the very numbers that packed() gives, by loops that the
// compiler turns into vectors. A record alone takes up to 25 divisions and roots.
#pragma once
#include <array>
#include <cstdint>
#include <cstring>

#include "host/cast/solids/all.h"

namespace solidcast {

class RecordBatch {
 public:
  static constexpr std::size_t block = 64;

  /// Of kinds::sphere, triangle or quad.
  explicit RecordBatch(int kind) : kind_(kind) {}
  int kind() const { return kind_; }
  std::size_t size() const { return count_; }
  bool full() const { return count_ == block; }
  /// `index`: of the solid in the world.
  void add(const Sphere& sphere, std::uint32_t index) {
    put(0, Vec3<double>(sphere.center));
    numbers_.v[3][count_] = sphere.radius, numbers_.index[count_++] = index;
  }
  void add(const Triangle& triangle, std::uint32_t index) { add(span<double>(triangle), index); }
  void add(const Quad& quad, std::uint32_t index) { add(span<double>(quad), index); }

  /// Calculates the records of all that were added since the last time, and forgets them; the count of them.
  std::size_t pack(const Frame<double>& eye);
  /// Of the i-th, in the order that they were added. Poor: fp64 does not serve (EyeRecord::poor), or the record is of another kind
  /// (a sphere with the eye near its surface); to be packed alone.
  bool poor(std::size_t i) const { return poor_[i] != 0; }
  bool grazing(std::size_t i) const { return grazing_[i] != 0; }
  /// The numbers of its rows, one after the other.
  void copy(std::size_t i, std::byte* to) const {
    if (kind_ == kinds::sphere) copyRows<2>(i, to);
    else if (kind_ == kinds::triangle) copyRows<4>(i, to);
    else copyRows<5>(i, to);
  }

  /// One array a number.
  struct Numbers {
    alignas(64) double v[9][block], index[block];
  };
  using Rows = float[20][block];

 private:
  template <int ROWS>
  void copyRows(std::size_t i, std::byte* to) const {
#pragma GCC unroll 20
    for (int k = 0; k < 4 * ROWS; ++k) std::memcpy(to + k * sizeof(float), &row_[k][i], sizeof(float));
  }
  void add(const Span<double>& span, std::uint32_t index) {
    put(0, span.v1), put(3, span.e1), put(6, span.e2);
    numbers_.index[count_++] = index;
  }
  void put(std::size_t first, const Vec3<double>& v) {
    for (std::size_t k = 0; k < 3; ++k) numbers_.v[first + k][count_] = v[static_cast<int>(k)];
  }

  int kind_;
  std::size_t count_ = 0;
  Numbers numbers_;
  alignas(64) Rows row_{};
  alignas(64) std::int32_t poor_[block]{}, grazing_[block]{};
};

}  // namespace solidcast
