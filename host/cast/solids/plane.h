// InfinitePlane on the GPU's side; the mathematics is told in shaders/solids/plane.glsl.
#pragma once
#include "host/cast/solids/forms.h"

namespace solidcast {

/// Rows (m, k) (index, weight of s) for any plane n.(p - o) = num, n in world axes and of any length.
template <class T>
void planeForms(Vec3<T> n, T num, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  if (num == 0 || isZero(n)) return;  // holds the eye: cannot be hit
  Vec3<T> m = eye.toCamera(n) / num;
  out.kind = kinds::plane;
  out.add(m, -num / length(n));
  out.add(index, T(twoTo(-26)) / length(m), 0, 0);
}

template <class T>
void packEye(const InfinitePlane& plane, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  Vec3<T> n(plane.normal), f = eye.relative(plane.origin);  // n as given: a rounded unit normal would put an eye in the
  T num = dot(n, f);                                        // plane beside it
  out.scales(num, length(n) * length(f));
  planeForms(n, num, eye, index, out);
}

inline void packWorld(const InfinitePlane& plane, V3 origin, f128 index, RowWriter& out) {
  out.row(V3(plane.origin) - origin, index);
  out.row(normalized(V3(plane.normal)), 0);
}

/// Plane through p with normal n of any length.
inline Cut cutPlane(V3 n, V3 p, const RayQ& ray) {
  V3 f = p - ray.origin;
  f128 distance = dot(n, f), towards = dot(n, ray.direction);
  f128 slackD = slack() * length(n) * length(f), slackT = slack() * length(n) * length(ray.direction);
  if (fabsq(distance) <= slackD || fabsq(towards) <= slackT) return {false, 0, true};  // eye in the plane, or parallel
  f128 t = distance / towards;
  return {t > 0, t};
}

inline Ball ball(const InfinitePlane& plane) { return {plane.origin, -1}; }

inline Cut cut(const InfinitePlane& plane, const RayQ& ray) {
  return cutPlane(V3(plane.normal), V3(plane.origin), ray);
}

inline Surface surface(const InfinitePlane& plane, const RayQ& ray, f128 t) {
  return {normalized(V3(plane.normal)), ray.origin + t * ray.direction};
}

}  // namespace solidcast
