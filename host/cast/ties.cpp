#include "host/cast/ties.h"

#include <algorithm>
#include <cmath>

namespace solidcast {
namespace {

constexpr std::size_t mostPlanes = 4096;  // planes that are compared; with more of them ties are taken for granted

/// A plane as m, s = m.d; what two solids' fp32 forms of one plane differ by is a few units in the last place.
struct Side {
  std::uint32_t kind;
  double m[3], length;
};

double distanceOf(const Side& a, const Side& b) {
  return std::hypot(a.m[0] - b.m[0], a.m[1] - b.m[1], a.m[2] - b.m[2]);
}

}  // namespace

bool mayTie(const Records& records, const EyeFrame& eye) {
  const auto kindsThere = std::count_if(records.count.begin(), records.count.end(), [](auto n) { return n > 0; });
  if (kindsThere < 2) return false;
  if (records.count[kinds::quadric] > 0 || records.solids() > mostPlanes) return true;
  std::vector<Side> sides;
  auto add = [&](std::uint32_t kind, double x, double y, double z) {
    sides.push_back({kind, {x, y, z}, std::hypot(x, y, z)});
  };
  auto row = [&](std::uint32_t kind, std::uint32_t solid, std::uint32_t of) {
    std::array<float, 4> r;
    const std::size_t at = records.firstRow[kind] + std::size_t{solid} * records.rowsPer[kind] + of;
    std::memcpy(r.data(), records.bytes.data() + at * sizeof r, sizeof r);
    return r;
  };
  for (const int kind : {kinds::plane, kinds::disc, kinds::triangle, kinds::quad})
    for (std::uint32_t i = 0; i < records.count[kind]; ++i) {
      const auto m = row(kind, i, 0);
      add(kind, m[0], m[1], m[2]);
    }
  for (std::uint32_t i = 0; i < records.count[kinds::box]; ++i) {
    const bool inside = row(kinds::box, i, 1)[3] > 0;
    const auto up = row(kinds::box, i, 0), low1 = row(kinds::box, i, 2), low2 = row(kinds::box, i, 3);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const double reciprocal :
           {inside ? 0.0 : double(up[axis]), inside ? double(low1[axis]) : 0.0, inside ? double(low2[axis]) : 0.0}) {
        const int a = static_cast<int>(axis);
        if (reciprocal != 0)
          add(kinds::box, double(eye.right[a]) * reciprocal, double(eye.upward[a]) * reciprocal,
              double(eye.backward[a]) * reciprocal);
      }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.length < b.length; });
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const double slack = std::ldexp(sides[i].length, -20);
    for (std::size_t k = i + 1; k < sides.size() && sides[k].length <= sides[i].length + slack; ++k)
      if (sides[i].kind != sides[k].kind && !(distanceOf(sides[i], sides[k]) > slack)) return true;
  }
  return false;
}

}  // namespace solidcast
