// Sphere on the GPU's side; the mathematics is told in shaders/solids/sphere.glsl.
#pragma once
#include "host/cast/solids/quadric.h"

namespace solidcast {

/// fp32 needs sphere.glsl's FAR_SPHERES: farther than 16 radii.
inline bool isFar(const Sphere& sphere, const Frame<double>& eye) {
  Vec3<double> f = eye.relative(sphere.center);
  double r = sphere.radius / eye.unit;
  return dot(f, f) > 256 * r * r;
}

/// The eye is so near the surface that the numerator sqrt(q) - b would cancel: the quadric's careful form does not.
/// `far`: |f|^2, `C`: |f|^2 - r^2.
template <class T>
bool nearSurface(T far, T C, RealType type) {
  const T near = twoTo(type == RealType::f64 ? -20 : type == RealType::df32 ? -12 : -4);
  return magnitude(C) < near * far;
}

/// `f`: the eye from the centre, in the eye's unit as `r` is.
template <class T>
void sphereForms(Vec3<T> f, T r, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  T far = dot(f, f), C = far - r * r;
  out.counts(C, far);
  // In this unit of length the error of q is bounded by DOUBT |d|^2: its scale is 1.
  T u = unitRoundoff(out.type);
  T sigma = 1 / squareRoot(larger(T(1), u * T(twoTo(57))) * (far + magnitude(C)));
  C = C * sigma * sigma;
  out.kind = kinds::sphere;
  out.add(eye.toCamera(C < 0 ? -f : f) * sigma, C);
  out.add(sigma / magnitude(C), (C < 0 ? -1 : 1) / (sigma * r), index, sigma * sigma * r * r);
}

template <class T>
void packEye(const Sphere& sphere, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  Vec3<T> f = -eye.relative(sphere.center);
  T r = sphere.radius / eye.unit;
  T far = dot(f, f), C = far - r * r;
  if (!nearSurface(far, C, out.type)) return sphereForms(f, r, eye, index, out);
  out.counts(C, far);
  if (magnitude(C) <= T(twoTo(-100)) * far) C = 0;  // the eye is on the surface, as far as binary128 can tell
  quadricForms<T>({1, 1, 1, 0, 0, 0}, f, C, eye, index, out, false);
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
