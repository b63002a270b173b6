// What every solid's packing and second pass are written with: the eye's frame, the writer of rows, rays in binary128.
#pragma once
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

#include "host/cast/quad_precision.h"

namespace solidcast {

enum class RealType { f32, f64, df32 };  // ARITHMETIC 0, 1, 2 of shaders/numeric.glsl

/// Unit roundoff u of the type, as numeric.glsl states it.
inline f128 unitRoundoff(RealType type) {
  return ldexpq(1, type == RealType::f32 ? -24 : type == RealType::f64 ? -53 : -44);
}
/// Stands for infinity in records: BIG of numeric.glsl. Half as large a one survives a product with a direction.
inline f128 bigNumber(RealType type) { return type == RealType::f64 ? f128(1e250) : f128(3e37); }
inline f128 steepNumber(RealType type) { return type == RealType::f64 ? f128(1e240) : f128(1e30); }

/// Rows of four numbers, each rounded once from binary128.
class RowWriter {
 public:
  /// `unrounded`, where given, takes the numbers as they were before rounding (host/explain).
  explicit RowWriter(RealType type, std::vector<f128>* unrounded = nullptr) : type_(type), unrounded_(unrounded) {}

  void row(V3 v, f128 w) { row(v.x, v.y, v.z, w); }
  void row(f128 x, f128 y, f128 z, f128 w) {
    const f128 v[4] = {x, y, z, w};
    if (unrounded_) unrounded_->insert(unrounded_->end(), v, v + 4);
    if (type_ == RealType::f64) {
      double d[4];
      for (int i = 0; i < 4; ++i) d[i] = static_cast<double>(v[i]);
      append(d, sizeof d);
    } else {
      float high[4], low[4];
      for (int i = 0; i < 4; ++i) {
        high[i] = static_cast<float>(v[i]);
        low[i] = static_cast<float>(v[i] - high[i]);
      }
      append(high, sizeof high);
      if (type_ == RealType::df32) append(low, sizeof low);
    }
    ++rows_;
  }

  RealType type() const { return type_; }
  std::size_t rows() const { return rows_; }
  const std::vector<std::byte>& bytes() const { return bytes_; }

 private:
  void append(const void* data, std::size_t size) {
    const auto* from = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), from, from + size);
  }

  RealType type_;
  std::vector<f128>* unrounded_;
  std::size_t rows_ = 0;
  std::vector<std::byte> bytes_;
};

/// The shared origin of all rays and the camera's axes (unit, orthogonal), with the unit of length of the records:
/// lengths are divided by `unit`, a power of two that keeps fp32's squares in range (1 for fp64).
struct EyeFrame {
  V3 origin, right, upward, backward;
  f128 unit = 1;

  V3 toCamera(V3 world) const { return {dot(world, right), dot(world, upward), dot(world, backward)}; }
  V3 relative(const Triple& point) const { return (V3(point) - origin) / unit; }
};

/// One writer a kind, by its number in solids.def: a solid may need another kind's careful form (a sphere with the eye
/// on it is cast as a quadric), one that holds the eye in its plane needs none.
struct EyeWriters {
  RowWriter* writers;
  bool* grazing;  // set where hit.glsl's GRAZING is needed

  /// A flat solid whose plane passes the eye at `distance` and whose farthest point is at `farthest`: the cosine is at
  /// least their ratio, and s keeps 2^-28 relative where 7u <= 2^-28 of it.
  void mayGraze(f128 distance, f128 farthest) const {
    if (fabsq(distance) < ldexpq(unitRoundoff(type()), 31) * farthest) *grazing = true;
  }
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  RowWriter& kind() const { return writers[NUMBER]; }
#include "shaders/solids.def"
#undef SOLID
  RealType type() const { return writers[0].type(); }
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
inline f128 slack() { return ldexpq(1, -100); }

struct Surface {
  V3 normal, local;
};

/// A ball that holds the solid, in fp64; radius < 0: unbounded. Its centre says where the solid's coordinates lie.
struct Ball {
  Triple center;
  double radius;
};
/// Corners whose convex hull holds the solid; none: the ball does.
struct Outline {
  std::array<Triple, 8> points{};
  int count = 0;
};
template <class Solid>
Outline outline(const Solid&) {
  return {};
}
inline double distance(const Triple& a, const Triple& b) { return static_cast<double>(length(V3(a) - V3(b))); }

}  // namespace solidcast
