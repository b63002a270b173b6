// Disc on the GPU's side; the mathematics is told in shaders/solids/disc.glsl.
#pragma once
#include "host/cast/solids/plane.h"

namespace solidcast {

inline void packEye(const Disc& disc, const EyeFrame& eye, f128 index, const EyeWriters& out) {
  V3 n = normalized(V3(disc.normal)), f = eye.relative(disc.center);
  f128 r = disc.radius / eye.unit, num = dot(n, f);
  if (dot(V3(disc.normal), f) == 0) return;  // as given: rounding the unit normal would move the plane
  V3 e1 = orthogonal(n), e2 = cross(n, e1);
  V3 U = (num * e1 - dot(f, e1) * n) / (r * num), V = (num * e2 - dot(f, e2) * n) / (r * num), m = n / num;
  RowWriter& rows = out.disc();
  rows.row(eye.toCamera(m), -num);
  rows.row(eye.toCamera(U), index);
  rows.row(eye.toCamera(V), ldexpq(1, -26) / length(m));
  rows.row(1 / (dot(m, m) + dot(U, U) + dot(V, V)), 0, 0, 0);
  out.mayGraze(num, length(f) + r);
}

inline void packWorld(const Disc& disc, V3 origin, f128 index, RowWriter& out) {
  out.row(V3(disc.center) - origin, index);
  out.row(normalized(V3(disc.normal)), disc.radius);
}

inline Ball ball(const Disc& disc) { return {disc.center, disc.radius}; }

inline Cut cut(const Disc& disc, const RayQ& ray) {
  V3 n(disc.normal), c(disc.center);
  Cut plane = cutPlane(n, c, ray);
  if (!plane.hit) return plane;
  V3 q = ray.origin - c + plane.t * ray.direction;
  f128 r = disc.radius, reach = length(ray.origin - c) + r;
  // The point's error: that of t along the ray.
  f128 grazing = length(n) * length(ray.direction) / fabsq(dot(n, ray.direction));
  f128 beyond = dot(q, q) - r * r, doubt = slack() * reach * reach * grazing;
  return {beyond <= doubt, plane.t, fabsq(beyond) <= doubt};
}

inline Surface surface(const Disc& disc, const RayQ& ray, f128 t) {
  return {normalized(V3(disc.normal)), ray.origin + t * ray.direction};
}

}  // namespace solidcast
