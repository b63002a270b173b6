// Quad on the GPU's side: the triangle's forms with another inside test (shaders/solids/quad.glsl).
#pragma once
#include "host/cast/solids/triangle.h"

namespace solidcast {

template <class T = f128>
Span<T> span(const Quad& q) {
  return {Vec3<T>(q.vertex), Vec3<T>(q.span1), Vec3<T>(q.span2)};
}

template <class T>
void packEye(const Quad& quad, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  spanForms(span<T>(quad), true, eye, index, out);
}

inline void packWorld(const Quad& quad, V3 origin, f128 index, RowWriter& out) {
  spanWorld(span(quad), origin, index, out);
}

inline std::array<Triple, 4> outline(const Quad& q, const Triple& origin) {
  const Triple vertex = difference(q.vertex, origin);
  std::array<Triple, 4> points;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 3; ++k) points[i][k] = vertex[k] + (i & 1 ? q.span1[k] : 0) + (i & 2 ? q.span2[k] : 0);
  return points;
}

inline Ball ball(const Quad& quad) {
  const Triple zero{0, 0, 0};
  return {quad.vertex, distance(quad.span1, zero) + distance(quad.span2, zero)};
}

inline Cut cut(const Quad& quad, const RayQ& ray) {
  SpanCut c = cutSpan(span(quad), ray);
  return c.within(smaller(smaller(c.beta, c.gamma), 1 - larger(c.beta, c.gamma)));
}

inline Surface surface(const Quad& quad, const RayQ& ray, f128) {
  Span<f128> s = span(quad);
  SpanCut c = cutSpan(s, ray);
  return {normalized(cross(s.e1, s.e2)), {c.beta, c.gamma, 0}};
}

}  // namespace solidcast
