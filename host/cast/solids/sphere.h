// Sphere on the GPU's side; the mathematics is told in shaders/solids/sphere.glsl.
#pragma once
#include "host/cast/solids/quadric.h"

namespace solidcast {

inline void packEye(const Sphere& sphere, const EyeFrame& eye, f128 index, const EyeWriters& out) {
  V3 f = -eye.relative(sphere.center);
  f128 r = sphere.radius / eye.unit;
  f128 far = dot(f, f), C = far - r * r;
  if (fabsq(C) <= slack() * far) C = 0;  // the eye is on the surface, as far as binary128 can tell
  // Near the surface the numerator sqrt(q) - b cancels: the quadric's careful form does not.
  f128 near = ldexpq(1, out.type() == RealType::f64 ? -20 : out.type() == RealType::df32 ? -12 : -4);
  if (fabsq(C) < near * far) {
    quadricForms({1, 1, 1, 0, 0, 0}, f, C, eye, index, out.quadric(), false);
    return;
  }
  // In this unit of length the error of q is bounded by DOUBT |d|^2: its scale is 1.
  f128 u = unitRoundoff(out.type());
  f128 sigma = 1 / sqrtq(larger(1, ldexpq(u, 57)) * (far + fabsq(C)));
  C = C * sigma * sigma;
  out.sphere().row(eye.toCamera(C < 0 ? -f : f) * sigma, C);
  out.sphere().row(sigma / fabsq(C), (C < 0 ? -1 : 1) / (sigma * r), index, 0);
}

inline void packWorld(const Sphere& sphere, V3 origin, f128 index, RowWriter& out) {
  out.row(V3(sphere.center) - origin, sphere.radius);
  out.row(index, 0, 0, 0);
}

inline Ball ball(const Sphere& sphere) { return {sphere.center, sphere.radius}; }

inline Cut cut(const Sphere& sphere, const RayQ& ray) {
  V3 f = ray.origin - V3(sphere.center), d = ray.direction;
  f128 r = sphere.radius, far = dot(f, f);
  return smallestRoot(dot(d, d), dot(f, d), far - r * r, 0, length(f) * length(d), far + r * r);
}

inline Surface surface(const Sphere& sphere, const RayQ& ray, f128 t) {
  V3 p = ray.origin + t * ray.direction;
  return {normalized(ray.origin - V3(sphere.center) + t * ray.direction), p};
}

}  // namespace solidcast
