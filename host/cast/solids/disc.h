// Disc on the GPU's side; the mathematics is told in shaders/solids/disc.glsl.
#pragma once
#include "host/cast/solids/plane.h"

namespace solidcast {

template <class T>
void packEye(const Disc& disc, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  Vec3<T> n = normalized(Vec3<T>(disc.normal)), f = eye.relative(disc.center);
  T r = disc.radius / eye.unit, num = dot(n, f);
  out.scales(num, length(f));
  if (dot(Vec3<T>(disc.normal), f) == 0) return;  // as given: rounding the unit normal would move the plane
  Vec3<T> e1 = orthogonal(n), e2 = cross(n, e1);
  // (num e1 - (f.e1) n) / (r num) and the same of e2, without cancelling
  Vec3<T> U = cross(e2, f) / (r * num), V = cross(f, e1) / (r * num), m = n / num;
  out.kind = kinds::disc;
  out.add(eye.toCamera(m), -num);
  out.add(eye.toCamera(U), index);
  out.add(eye.toCamera(V), T(twoTo(-26)) / length(m));
  out.add(1 / (dot(m, m) + dot(U, U) + dot(V, V)), 0, 0, 0);
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
