// Ray against each solid as polynomials in the ray and the scene's numbers, for any of the oracle's number types.
// No division and no square root before the decision; the hit's parameter is left as a Root.
// World space and homogeneous, so neither the reference's formulas (parameter by division) nor the GPU's (inverse
// distance relative to the eye).
#pragma once
#include "host/oracle/root.h"
#include "host/scene/world.h"

namespace solidcast::oracle {

template <class N>
struct RayOf {
  Vector<N> origin, direction;
  bool exactInputs = false;  // the components were not rounded on the way to N
};

template <class N>
struct Solution {
  Claim claim;
  Root<N> root;
  Vector<N> normal;               // any length; not set where it depends on the hit point
  Vector<N> weights;              // triangle and quad: local coordinates times `weightSum`
  N weightSum{};                  //
  double faceMargin = kInfinity;  // box: relative margin by which this face and no other is hit
  bool maybeApex = false;         // quadric: a double root, where the gradient may vanish
};

template <class N>
Vector<N> vectorOf(const Triple& v) {
  return {N::of(v[0]), N::of(v[1]), N::of(v[2])};
}
template <class N>
Vector<N> between(const Vector<N>& to, const Vector<N>& from, bool exactInputs) {
  Vector<N> result;
  for (int i = 0; i < 3; ++i) result[i] = N::difference(to[i], from[i], exactInputs);
  return result;
}

/// Hit ahead of the origin where numerator and denominator have the same sign: a ray parallel to or in the plane misses.
inline Claim sameSign(const Sign& a, const Sign& b) {
  if (a.is == 0 || b.is == 0) return {Claim::no, 0};
  if (!a.certain() || !b.certain()) return {};
  return {a.is == b.is ? Claim::yes : Claim::no, std::fmin(a.margin, b.margin)};
}
/// a/b >= 0, edges closed, where b is known not to be 0 by a claim of its own.
inline Claim within(const Sign& a, const Sign& b) {
  if (a.is == 0) return {Claim::yes, 0, true};
  if (!a.certain() || !b.certain()) return {};
  return {a.is == b.is ? Claim::yes : Claim::no, a.margin};
}

template <class N>
Solution<N> solve(const InfinitePlane& plane, const RayOf<N>& ray) {
  Solution<N> s;
  s.normal = vectorOf<N>(plane.normal);
  const N height = dot(s.normal, between(vectorOf<N>(plane.origin), ray.origin, ray.exactInputs));
  const N slope = dot(s.normal, ray.direction);
  s.claim = sameSign(signOf(height), signOf(slope));
  s.root = {Root<N>::rational, height, slope};
  return s;
}

/// |height d - slope f|^2 <= r^2 slope^2 with f = center - origin: the offset of the hit from the centre, times slope.
template <class N>
Solution<N> solve(const Disc& disc, const RayOf<N>& ray) {
  Solution<N> s;
  s.normal = vectorOf<N>(disc.normal);
  const Vector<N> f = between(vectorOf<N>(disc.center), ray.origin, ray.exactInputs);
  const N height = dot(s.normal, f), slope = dot(s.normal, ray.direction);
  const Vector<N> offset = height * ray.direction - slope * f;
  const N reach = N::of(disc.radius) * slope;
  s.claim = sameSign(signOf(height), signOf(slope)) && notNegative(signOf(reach * reach - dot(offset, offset)));
  s.root = {Root<N>::rational, height, slope};
  return s;
}

/// Signed volumes of the ray with the three edges; their sum is d.n.
template <class N>
Solution<N> solve(const Triangle& triangle, const RayOf<N>& ray) {
  Solution<N> s;
  const Vector<N> v1 = vectorOf<N>(triangle.v1), v2 = vectorOf<N>(triangle.v2), v3 = vectorOf<N>(triangle.v3);
  s.normal = cross(between(v2, v1, true), between(v3, v1, true));
  const Vector<N> a = between(v1, ray.origin, ray.exactInputs), b = between(v2, ray.origin, ray.exactInputs),
                  c = between(v3, ray.origin, ray.exactInputs);
  const N height = dot(s.normal, a), slope = dot(s.normal, ray.direction);
  s.weights = {dot(ray.direction, cross(b, c)), dot(ray.direction, cross(c, a)), dot(ray.direction, cross(a, b))};
  s.weightSum = slope;
  const Sign slopeSign = signOf(slope);
  s.claim = sameSign(signOf(height), slopeSign);
  for (const N& w : s.weights) s.claim = s.claim && within(signOf(w), slopeSign);
  s.root = {Root<N>::rational, height, slope};
  return s;
}

/// u = (g x e2).d / n.d and v = (e1 x g).d / n.d with g = origin - vertex (Cramer's rule).
template <class N>
Solution<N> solve(const Quad& quad, const RayOf<N>& ray) {
  Solution<N> s;
  const Vector<N> e1 = vectorOf<N>(quad.span1), e2 = vectorOf<N>(quad.span2);
  const Vector<N> g = between(ray.origin, vectorOf<N>(quad.vertex), ray.exactInputs);
  s.normal = cross(e1, e2);
  const N height = -dot(s.normal, g), slope = dot(s.normal, ray.direction);
  s.weights = {dot(cross(g, e2), ray.direction), dot(cross(e1, g), ray.direction), N{}};
  s.weightSum = slope;
  const Sign slopeSign = signOf(slope);
  s.claim = sameSign(signOf(height), slopeSign);
  for (int i = 0; i < 2; ++i) {
    s.claim = s.claim && within(signOf(s.weights[i]), slopeSign) && within(signOf(slope - s.weights[i]), slopeSign);
  }
  s.root = {Root<N>::rational, height, slope};
  return s;
}

/// Sign of C first (origin inside, on or outside), which picks the root; D = a r^2 - |f x d|^2.
template <class N>
Solution<N> solve(const Sphere& sphere, const RayOf<N>& ray) {
  Solution<N> s;
  const Vector<N>& d = ray.direction;
  const Vector<N> f = between(ray.origin, vectorOf<N>(sphere.center), ray.exactInputs);
  const N r2 = N::of(sphere.radius) * N::of(sphere.radius);
  const N a = dot(d, d), b = dot(f, d), c = dot(f, f) - r2;
  const Sign side = signOf(c);
  if (!side.certain()) return s;
  if (side.is == 0) {
    s.claim = positive(-signOf(b));
    s.claim.margin = 0;
    s.root = {Root<N>::rational, -(b + b), a};
    return s;
  }
  const Vector<N> fxd = cross(f, d);
  const N discriminant = a * r2 - dot(fxd, fxd);
  if (side.is < 0) {
    s.claim = {Claim::yes, side.margin};
    if (b.negative()) {
      s.root = {Root<N>::above, -b, a, discriminant};
    } else {
      s.root = {Root<N>::below, -c, b, discriminant};
    }
    return s;
  }
  s.claim = positive(-signOf(b)) && notNegative(signOf(discriminant));
  s.claim.margin = std::fmin(s.claim.margin, side.margin);
  s.root = {Root<N>::below, c, -b, discriminant};
  return s;
}

/// Half the gradient at p is M p + l; Q(p) = p.(M p + 2 l) + j with the off-diagonals of M halved. To stay free of
/// halves everything is doubled: G(p) = 2 M p + 2 l is the gradient itself.
template <class N>
Vector<N> gradient(const std::array<double, 10>& q, const Vector<N>& p, bool withLinear) {
  const N two = N::of(2.0);
  Vector<N> g;
  g[0] = two * (N::of(q[0]) * p[0]) + N::of(q[3]) * p[1] + N::of(q[4]) * p[2];
  g[1] = N::of(q[3]) * p[0] + two * (N::of(q[1]) * p[1]) + N::of(q[5]) * p[2];
  g[2] = N::of(q[4]) * p[0] + N::of(q[5]) * p[1] + two * (N::of(q[2]) * p[2]);
  if (withLinear) {
    for (int i = 0; i < 3; ++i) g[i] = g[i] + N::of(q[6 + i]);
  }
  return g;
}

/// A t^2 + B t + C = 0 with the signs turned so that C > 0: then a positive root exists if A < 0, or if B < 0 and
/// B^2 >= 4AC; the smallest is 2C / (-B + sqrt(B^2 - 4AC)) or, for B >= 0, (B + sqrt(B^2 - 4AC)) / (-2A).
template <class N>
Solution<N> solve(const Quadric& quadric, const RayOf<N>& ray) {
  Solution<N> s;
  const auto& q = quadric.coefficients;
  const Vector<N>&o = ray.origin, &d = ray.direction;
  const N two = N::of(2.0);
  const auto square = [&q](const Vector<N>& v) {
    return N::of(q[0]) * v[0] * v[0] + N::of(q[1]) * v[1] * v[1] + N::of(q[2]) * v[2] * v[2] +
           N::of(q[3]) * v[0] * v[1] + N::of(q[4]) * v[0] * v[2] + N::of(q[5]) * v[1] * v[2];
  };
  N a = square(d);
  N b = dot(d, gradient(q, o, true));
  N c = square(o) + N::of(q[6]) * o[0] + N::of(q[7]) * o[1] + N::of(q[8]) * o[2] + N::of(q[9]);
  const Sign side = signOf(c);
  if (!side.certain()) return s;
  if (side.is == 0) {  // t (A t + B) = 0
    s.claim = sameSign(-signOf(b), signOf(a));
    s.claim.margin = 0;
    s.root = {Root<N>::rational, -b, a};
    return s;
  }
  if (side.is < 0) a = -a, b = -b, c = -c;
  const N discriminant = b * b - two * two * (a * c);
  const Sign rootSign = signOf(discriminant);
  s.claim = positive(-signOf(a)) || (positive(-signOf(b)) && notNegative(rootSign));
  s.claim.margin = std::fmin(s.claim.margin, side.margin);
  s.maybeApex = rootSign.is == 0;
  if (b.negative()) {
    s.root = {Root<N>::below, two * c, -b, discriminant};
  } else {
    s.root = {Root<N>::above, b, -(two * a), discriminant};
  }
  return s;
}

/// Slabs without division: per axis D = |d|, N and F the signed ways to the near and the far face; the entry is the
/// largest N/D, the exit the smallest F/D.
template <class N>
Solution<N> solve(const AABox& box, const RayOf<N>& ray) {
  Solution<N> s;
  N along[3], nearWay[3], farWay[3];
  Sign nearSign[3], farSign[3];
  int direction[3];
  Claim inside{Claim::yes, kInfinity};  // of the slabs that the ray runs along
  double caseMargin = kInfinity;        // origin before a near face or not
  bool before = false;
  for (int i = 0; i < 3; ++i) {
    const Sign sign = signOf(ray.direction[i]);
    if (!sign.certain()) return s;
    direction[i] = sign.is;
    const N low = N::of(std::fmin(box.corner1[i], box.corner2[i])),
            high = N::of(std::fmax(box.corner1[i], box.corner2[i]));
    const N fromLow = N::difference(ray.origin[i], low, ray.exactInputs),
            toHigh = N::difference(high, ray.origin[i], ray.exactInputs);
    if (sign.is == 0) {
      inside = inside && notNegative(signOf(fromLow)) && notNegative(signOf(toHigh));
      continue;
    }
    along[i] = sign.is > 0 ? ray.direction[i] : -ray.direction[i];
    nearWay[i] = sign.is > 0 ? -fromLow : -toHigh;
    farWay[i] = sign.is > 0 ? toHigh : fromLow;
    nearSign[i] = signOf(nearWay[i]);
    farSign[i] = signOf(farWay[i]);
    if (!nearSign[i].certain()) return s;
    if (nearSign[i].is > 0) {
      caseMargin = before ? std::fmax(caseMargin, nearSign[i].margin) : nearSign[i].margin;
      before = true;
    } else if (!before) {
      caseMargin = std::fmin(caseMargin, nearSign[i].margin);
    }
  }
  s.claim = inside;
  int face = -1;
  for (int i = 0; i < 3; ++i) {
    if (direction[i] == 0) continue;
    if (!before) s.claim = s.claim && positive(farSign[i]);
    for (int j = 0; before && j < 3; ++j) {
      if (j == i || direction[j] == 0) continue;
      s.claim = s.claim && notNegative(signOf(farWay[j] * along[i] - nearWay[i] * along[j]));
    }
    // The face hit: entry of the largest N/D, or exit of the smallest F/D; on an edge the lowest axis.
    if (before && nearSign[i].is <= 0) continue;
    if (face < 0) {
      face = i;
      continue;
    }
    const Sign later = before ? signOf(nearWay[i] * along[face] - nearWay[face] * along[i])
                              : signOf(farWay[face] * along[i] - farWay[i] * along[face]);
    if (!later.certain()) {
      if (s.claim.answer != Claim::no) s.claim = {};
      continue;
    }
    s.faceMargin = later.is > 0 ? later.margin : std::fmin(s.faceMargin, later.margin);
    if (later.is > 0) face = i;
  }
  if (s.claim.answer == Claim::doubt) return s;
  s.claim.margin = std::fmin(s.claim.margin, caseMargin);
  const int towards = before ? -direction[face] : direction[face];
  s.normal[static_cast<std::size_t>(face)] = N::of(static_cast<double>(towards));
  s.root = {Root<N>::rational, before ? nearWay[face] : farWay[face], along[face]};
  return s;
}

}  // namespace solidcast::oracle
