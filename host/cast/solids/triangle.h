// Triangle on the GPU's side; the mathematics is told in shaders/solids/triangle.glsl. The quad shares its forms.
#pragma once
#include <algorithm>

#include "host/cast/solids/disc.h"

namespace solidcast {

/// v1 + beta e1 + gamma e2
template <class T>
struct Span {
  Vec3<T> v1, e1, e2;
};

template <class T = f128>
Span<T> span(const Triangle& t) {
  Vec3<T> v1(t.v1);
  return {v1, Vec3<T>(t.v2) - v1, Vec3<T>(t.v3) - v1};
}

/// Rows (m, k) (U, index) (V, weight of s), and (m - U - V, -) for a triangle, (m - U, -) (m - V, -) for a quad. The zeros
/// of each edge's form are the plane through the eye and that edge, so that it is a cross product of the edge and one
/// of its points, over num.
template <class T>
void spanForms(const Span<T>& s, bool quad, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  const T scale = 1 / eye.unit;  // a power of two: exact
  Vec3<T> f = (s.v1 - eye.origin) * scale, e1 = s.e1 * scale, e2 = s.e2 * scale;
  Vec3<T> n = cross(e1, e2);
  T num = dot(n, f), area = length(n), l1 = length(e1), l2 = length(e2), reach = length(f);
  out.counts(area, l1 * l2);
  out.scales(num, area * reach);
  Vec3<T> m = n / num;
  auto edge = [&](Vec3<T> along, Vec3<T> point, T terms) {
    Vec3<T> form = cross(along, point);
    T size = length(form);
    out.counts(size, terms);
    return eye.toCamera(form) * ((num < 0 ? T(-1) : T(1)) / size);
  };
  out.kind = quad ? kinds::quad : kinds::triangle;
  out.add(eye.toCamera(m), -num / area);
  out.add(edge(e2, f, l2 * reach), index);
  out.add(edge(f, e1, l1 * reach), T(twoTo(-26)) / length(m));
  if (quad) {
    out.add(edge(f + e1, e2, l2 * (reach + l1)), 0);
    out.add(edge(e1, f + e2, l1 * (reach + l2)), 0);
  } else {
    out.add(edge(f + e1, e2 - e1, (reach + l1) * (l1 + l2)), 0);
  }
  out.mayGraze(num / area, reach + l1 + l2);
  if (num == 0) out.kind = -1, out.rows = 0;  // the eye is in its plane
}

inline void spanWorld(const Span<f128>& s, V3 origin, f128 index, RowWriter& out) {
  out.row(s.v1 - origin, index);
  out.row(s.e1, 0);
  out.row(s.e2, 0);
  out.row(normalized(cross(s.e1, s.e2)), 0);
}

struct SpanCut {
  Cut plane;
  f128 beta = 0, gamma = 0;
  f128 doubt = 0;  // of beta and gamma

  /// `inside` is the smallest of the numbers that must not be negative.
  Cut within(f128 inside) const {
    if (!plane.hit) return plane;
    return {inside >= -doubt, plane.t, fabsq(inside) <= doubt};
  }
};

inline SpanCut cutSpan(const Span<f128>& s, const RayQ& ray) {
  V3 n = cross(s.e1, s.e2);
  SpanCut c;
  c.plane = cutPlane(n, s.v1, ray);
  if (!c.plane.hit) return c;
  // Determinants with the origin: no point is formed, so a far origin costs nothing but its own size.
  V3 f = ray.origin - s.v1, d = ray.direction;
  f128 det = -dot(n, d);
  c.beta = dot(cross(d, s.e2), f) / det;
  c.gamma = dot(cross(s.e1, d), f) / det;
  f128 reach = length(d) * length(f) * (length(s.e1) + length(s.e2));
  c.doubt = slack() * (1 + reach / fabsq(det));
  return c;
}

template <class T>
void packEye(const Triangle& triangle, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  spanForms(span<T>(triangle), false, eye, index, out);
}

inline void packWorld(const Triangle& triangle, V3 origin, f128 index, RowWriter& out) {
  spanWorld(span(triangle), origin, index, out);
}

inline std::array<Triple, 3> outline(const Triangle& t, const Triple& origin) {
  return {difference(t.v1, origin), difference(t.v2, origin), difference(t.v3, origin)};
}

inline Ball ball(const Triangle& t) { return {t.v1, std::max(distance(t.v1, t.v2), distance(t.v1, t.v3))}; }

inline Cut cut(const Triangle& triangle, const RayQ& ray) {
  SpanCut c = cutSpan(span(triangle), ray);
  return c.within(smaller(smaller(c.beta, c.gamma), 1 - c.beta - c.gamma));
}

inline Surface surface(const Triangle& triangle, const RayQ& ray, f128) {
  Span<f128> s = span(triangle);
  SpanCut c = cutSpan(s, ray);
  return {normalized(cross(s.e1, s.e2)), {1 - c.beta - c.gamma, c.beta, c.gamma}};
}

}  // namespace solidcast
