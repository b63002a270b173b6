// Triangle on the GPU's side; the mathematics is told in shaders/solids/triangle.glsl. The quad shares its forms.
#pragma once
#include <algorithm>

#include "host/cast/solids/disc.h"

namespace solidcast {

/// v1 + beta e1 + gamma e2
struct Span {
  V3 v1, e1, e2;
};

inline Span span(const Triangle& t) { return {V3(t.v1), V3(t.v2) - V3(t.v1), V3(t.v3) - V3(t.v1)}; }

/// Rows (m, k) (U, index) (V, weight of s), and (m - U - V, -) for a triangle, (m - U, -) (m - V, -) for a quad.
inline void spanForms(const Span& s, bool quad, const EyeFrame& eye, f128 index, const EyeWriters& out) {
  V3 f = (s.v1 - eye.origin) / eye.unit, e1 = s.e1 / eye.unit, e2 = s.e2 / eye.unit;
  V3 n = cross(e1, e2);
  f128 num = dot(n, f), n2 = dot(n, n);
  if (num == 0) return;  // the eye is in its plane
  V3 m = n / num;
  V3 U = (num * cross(e2, n) - dot(cross(f, e2), n) * n) / (n2 * num);
  V3 V = (num * cross(n, e1) - dot(cross(e1, f), n) * n) / (n2 * num);
  RowWriter& rows = quad ? out.quad() : out.triangle();
  auto edge = [&](V3 form) { return eye.toCamera(normalized(form)); };
  rows.row(eye.toCamera(m), -num / length(n));
  rows.row(edge(U), index);
  rows.row(edge(V), ldexpq(1, -26) / length(m));
  if (quad) {
    rows.row(edge(m - U), 0);
    rows.row(edge(m - V), 0);
  } else {
    rows.row(edge(m - U - V), 0);
  }
  out.mayGraze(num / length(n), length(f) + length(e1) + length(e2));
}

inline void spanWorld(const Span& s, V3 origin, f128 index, RowWriter& out) {
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

inline SpanCut cutSpan(const Span& s, const RayQ& ray) {
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

inline void packEye(const Triangle& triangle, const EyeFrame& eye, f128 index, const EyeWriters& out) {
  spanForms(span(triangle), false, eye, index, out);
}

inline void packWorld(const Triangle& triangle, V3 origin, f128 index, RowWriter& out) {
  spanWorld(span(triangle), origin, index, out);
}

inline Outline outline(const Triangle& t) { return {{t.v1, t.v2, t.v3}, 3}; }

inline Ball ball(const Triangle& t) { return {t.v1, std::max(distance(t.v1, t.v2), distance(t.v1, t.v3))}; }

inline Cut cut(const Triangle& triangle, const RayQ& ray) {
  SpanCut c = cutSpan(span(triangle), ray);
  return c.within(smaller(smaller(c.beta, c.gamma), 1 - c.beta - c.gamma));
}

inline Surface surface(const Triangle& triangle, const RayQ& ray, f128) {
  Span s = span(triangle);
  SpanCut c = cutSpan(s, ray);
  return {normalized(cross(s.e1, s.e2)), {1 - c.beta - c.gamma, c.beta, c.gamma}};
}

}  // namespace solidcast
