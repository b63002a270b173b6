// What every solid's packing and second pass are written with: the eye's frame, the writer of rows, rays in binary128.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "host/cast/quad_precision.h"

namespace solidcast {

enum class RealType { f32, f64, df32 };  // ARITHMETIC 0, 1, 2 of shaders/numeric.glsl

/// Unit roundoff u of the type, as numeric.glsl states it.
inline double unitRoundoff(RealType type) {
  return twoTo(type == RealType::f32 ? -24 : type == RealType::f64 ? -53 : -44);
}
/// Stands for infinity in records: BIG of numeric.glsl. Half as large a one survives a product with a direction.
inline double bigNumber(RealType type) { return type == RealType::f64 ? 1e250 : 3e37; }
inline double steepNumber(RealType type) { return type == RealType::f64 ? 1e240 : 1e30; }

/// Bytes of one row of four numbers.
inline std::size_t rowBytes(RealType type) { return type == RealType::f32 ? 16 : 32; }

/// One row of four numbers, each rounded once from T; `to` has room for rowBytes().
template <class T>
void writeRow(std::byte* to, RealType type, const T (&v)[4]) {
  if (type == RealType::f64) {
    double d[4];
    for (int i = 0; i < 4; ++i) d[i] = static_cast<double>(v[i]);
    std::memcpy(to, d, sizeof d);
    return;
  }
  float high[4], low[4];
  for (int i = 0; i < 4; ++i) high[i] = static_cast<float>(v[i]);
  std::memcpy(to, high, sizeof high);
  if (type != RealType::df32) return;
  for (int i = 0; i < 4; ++i) low[i] = static_cast<float>(v[i] - high[i]);
  std::memcpy(to + sizeof high, low, sizeof low);
}

/// Rows of four numbers, one after the other.
class RowWriter {
 public:
  /// `unrounded`, where given, takes the numbers as they were before rounding (host/explain).
  explicit RowWriter(RealType type, std::vector<f128>* unrounded = nullptr) : type_(type), unrounded_(unrounded) {}

  void row(V3 v, f128 w) { row(v.x, v.y, v.z, w); }
  void row(f128 x, f128 y, f128 z, f128 w) { add<f128>({x, y, z, w}); }
  template <class T>
  void add(const T (&v)[4]) {
    if (unrounded_) unrounded_->insert(unrounded_->end(), v, v + 4);
    bytes_.resize(bytes_.size() + rowBytes(type_));
    writeRow(bytes_.data() + bytes_.size() - rowBytes(type_), type_, v);
    ++rows_;
  }

  RealType type() const { return type_; }
  std::size_t rows() const { return rows_; }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  RealType type_;
  std::vector<f128>* unrounded_;
  std::size_t rows_ = 0;
  std::vector<std::byte> bytes_;
};

/// The shared origin of all rays and the camera's axes (unit, orthogonal), with the unit of length of the records:
/// lengths are divided by `unit`, a power of two that keeps fp32's squares in range (1 for fp64).
template <class T>
struct Frame {
  Vec3<T> origin, right, upward, backward;
  T unit = 1;

  Frame() = default;
  template <class U>
  explicit Frame(const Frame<U>& f)
      : origin(f.origin), right(f.right), upward(f.upward), backward(f.backward), unit(static_cast<T>(f.unit)) {}

  Vec3<T> toCamera(Vec3<T> world) const { return {dot(world, right), dot(world, upward), dot(world, backward)}; }
  Vec3<T> relative(const Vec3<T>& point) const { return (point - origin) * (1 / unit); }
  Vec3<T> relative(const Triple& point) const { return relative(Vec3<T>(point)); }
};
using EyeFrame = Frame<f128>;

/// Numbers of solids.def.
namespace kinds {
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) inline constexpr int kind = NUMBER;
#include "shaders/solids.def"
#undef SOLID
}  // namespace kinds

/// One solid's record for one eye, before it is rounded to `type`. A solid may need another kind's careful form (a
/// sphere with the eye on it is cast as a quadric); one that holds the eye in its plane needs none (kind -1).
///
/// T is f128, or a narrower type that is many times as quick: where that would show in the rounded record, `poor` says
/// so, and the solid has to be packed in f128 (docs/numerics.md: Records in fewer bits).
template <class T>
struct EyeRecord {
  RealType type;
  int kind = -1, rows = 0;
  T row[5][4];
  bool grazing = false;  // hit.glsl needs GRAZING
  bool poor = false;

  explicit EyeRecord(RealType t) : type(t) {}
  void add(T x, T y, T z, T w) {
    T* to = row[rows++];
    to[0] = x, to[1] = y, to[2] = z, to[3] = w;
  }
  void add(Vec3<T> v, T w) { add(v.x, v.y, v.z, w); }

  /// `value` was summed from terms of this size and its rounding counts relative to itself: what is left of T's bits
  /// has to be below 2^-3 u.
  void counts(T value, T terms) {
    if constexpr (!std::is_same_v<T, f128>)
      poor |= !(magnitude(value) >= terms * (type == RealType::f32 ? T(0x1p-20) : T(0x1p-5)));
  }
  /// The same for a value that only scales s and the cosine, where 2^-32 relative does no harm.
  void scales(T value, T terms) {
    if constexpr (!std::is_same_v<T, f128>) poor |= !(magnitude(value) >= terms * T(0x1p-18));
  }
  /// A flat solid whose plane passes the eye at `distance` and whose farthest point is at `farthest`: the cosine is at
  /// least their ratio, and s keeps 2^-28 relative where 7u <= 2^-28 of it.
  void mayGraze(T distance, T farthest) {
    grazing |= magnitude(distance) < T(unitRoundoff(type) * twoTo(31)) * farthest;
  }
};

/// A ray in binary128, t counted in lengths of its direction.
struct RayQ {
  V3 origin, direction;
  bool rational = false;  // the very numbers of a free ray, so that rational_pass.h can decide
};

/// Second pass: what one solid says of a ray. Decisions within binary128's own rounding count as on the edge (hit).
struct Cut {
  bool hit = false;
  f128 t = 0;
  bool close = false;  // some decision was within that rounding
};

/// Relative rounding that a decision in binary128 is granted; far above 2^-113, far below anything fp64 can tell.
constexpr f128 slack() { return twoTo(-100); }

struct Surface {
  V3 normal, local;
};

/// A ball that holds the solid, in fp64; radius < 0: unbounded. Its centre says where the solid's coordinates lie.
struct Ball {
  Triple center;
  double radius;
};
inline Triple difference(const Triple& a, const Triple& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
/// Corners, from `origin`, whose convex hull is the solid; none: the ball has to do.
template <class Solid>
std::array<Triple, 0> outline(const Solid&, const Triple&) {
  return {};
}
inline double distance(const Triple& a, const Triple& b) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
  return std::sqrt(x * x + y * y + z * z);
}

}  // namespace solidcast
