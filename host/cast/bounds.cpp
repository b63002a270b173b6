// Corners and balls are the solids' own (host/cast/solids); what is told here is the ellipsoid.
//
// (p - c)'M(p - c) = k around c = -M^-1 l, k = -l.c - j, reaches sqrt(k (M^-1)_ii) along axis i. With M^-1 = adj(M)/det(M)
// each of these is a sum of products of fp64 numbers, whose rounding in binary128 is some 2^-110 of the sum of its terms'
// sizes. A quadric counts as bounded only where minors, determinant and cofactors keep 2^-40 of those sizes, so that
// quotients are right to 2^-66, and everything is widened by 2^-60.
#include "host/cast/bounds.h"

#include <algorithm>
#include <cmath>

#include "host/cast/solids/all.h"

namespace solidcast {
namespace {

constexpr double farthest = 0x1p100;

std::optional<Bounds> checked(Bounds b) {
  for (std::size_t i = 0; i < 3; ++i)
    if (!(b.lo[i] >= -farthest && b.hi[i] <= farthest)) return std::nullopt;
  return b;
}

/// `reach` is the size of the numbers that the interval was made from.
void setAxis(Bounds& b, std::size_t i, double lo, double hi, double reach) {
  b.lo[i] = lo - std::ldexp(reach, -48);
  b.hi[i] = hi + std::ldexp(reach, -48);
}

template <class Solid>
std::optional<Bounds> boundsOfSolid(const Solid& solid) {
  Bounds b;
  const auto corners = outline(solid, Triple{0, 0, 0});
  if constexpr (std::tuple_size_v < decltype(outline(solid, Triple{})) >> 0) {
    for (std::size_t i = 0; i < 3; ++i) {
      double lo = corners[0][i], hi = lo;
      for (const Triple& p : corners) lo = std::min(lo, p[i]), hi = std::max(hi, p[i]);
      setAxis(b, i, lo, hi, std::max(std::abs(lo), std::abs(hi)));
    }
    return checked(b);
  }
  const Ball round = ball(solid);
  if (round.radius < 0) return std::nullopt;
  for (std::size_t i = 0; i < 3; ++i)
    setAxis(b, i, round.center[i] - round.radius, round.center[i] + round.radius,
            std::abs(round.center[i]) + round.radius);
  return checked(b);
}

/// Along axis i the disc reaches r sqrt(1 - n_i^2).
std::optional<Bounds> boundsOfSolid(const Disc& disc) {
  Bounds b;
  const V3 n = normalized(V3(disc.normal));
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double reach = disc.radius * static_cast<double>(sqrtq(larger(f128(0), 1 - n[i] * n[i])));
    setAxis(b, at, disc.center[at] - reach, disc.center[at] + reach, std::abs(disc.center[at]) + disc.radius);
  }
  return checked(b);
}

/// `part` is what has to be left of sums, `wide` what results are widened by.
template <class T>
std::optional<Bounds> ellipsoidBounds(const Quadric& quadric, T part, T wide) {
  const QuadricForm<T> q = quadricForm<T>(quadric);
  const T sign = q.M.xx < 0 ? -1 : 1;
  const T M[3][3] = {{sign * q.M.xx, sign * q.M.xy, sign * q.M.xz},
                     {sign * q.M.xy, sign * q.M.yy, sign * q.M.yz},
                     {sign * q.M.xz, sign * q.M.yz, sign * q.M.zz}};
  const Vec3<T> l = sign * q.l;
  T cofactor[3][3], size[3][3];  // and the sum of the magnitudes of its terms
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      const T plus = M[i1][k1] * M[i2][k2], minus = M[i1][k2] * M[i2][k1];
      cofactor[i][k] = plus - minus, size[i][k] = magnitude(plus) + magnitude(minus);
    }
  T determinant = 0, terms = 0;
  for (int k = 0; k < 3; ++k) determinant += M[0][k] * cofactor[0][k], terms += magnitude(M[0][k]) * size[0][k];
  // Sylvester: definite when the leading minors are positive.
  if (!(M[0][0] > 0) || !(determinant > part * terms)) return std::nullopt;
  for (int i = 0; i < 3; ++i)
    if (!(cofactor[i][i] > part * size[i][i])) return std::nullopt;

  Vec3<T> center, uncertain;
  T level = -sign * q.j, levelSize = magnitude(q.j);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      center[i] -= cofactor[i][k] * l[k] / determinant;
      uncertain[i] += size[i][k] * magnitude(l[k]) / determinant;
    }
    level -= l[i] * center[i];
    levelSize += magnitude(l[i]) * uncertain[i];
  }
  level =
      larger(T(0), level) + wide * levelSize;  // below 0 there is no surface: a box costs less than a case of its own
  Bounds b;
  for (int i = 0; i < 3; ++i) {
    const T half = squareRoot(level * cofactor[i][i] / determinant), slack = wide * (uncertain[i] + half);
    setAxis(b, static_cast<std::size_t>(i), static_cast<double>(center[i] - half - slack),
            static_cast<double>(center[i] + half + slack), static_cast<double>(magnitude(center[i]) + half));
  }
  return checked(b);
}

std::optional<Bounds> boundsOfSolid(const Quadric& quadric) {
  return ellipsoidBounds<f128>(quadric, ldexpq(1, -40), ldexpq(1, -60));
}

}  // namespace

std::optional<Bounds> quickBounds(const Quadric& quadric) {
  // In fp64 quotients are right to 2^-36 where sums keep 2^-13 of their terms.
  if (const auto quick = ellipsoidBounds<double>(quadric, 0x1p-13, 0x1p-24)) return quick;
  return boundsOfSolid(quadric);
}

std::optional<Bounds> boundsOf(ShapeRef shape) {
  return shape.visit([](const auto& s) { return boundsOfSolid(s); });
}

}  // namespace solidcast
