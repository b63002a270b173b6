// InfinitePlane on the GPU's side; the mathematics is told in shaders/solids/plane.glsl.
#pragma once
#include "host/cast/solids/forms.h"

namespace solidcast {

/// Rows (m, k) (index, weight of s) for any plane n.(p - o) = num, n in world axes and of any length.
inline bool planeForms(V3 n, f128 num, const EyeFrame& eye, f128 index, RowWriter& out) {
  if (num == 0 || isZero(n)) return false;  // holds the eye: cannot be hit
  V3 m = eye.toCamera(n) / num;
  out.row(m, -num / length(n));
  out.row(index, ldexpq(1, -26) / length(m), 0, 0);
  return true;
}

inline void packEye(const InfinitePlane& plane, const EyeFrame& eye, f128 index, const EyeWriters& out) {
  V3 n(plane.normal);  // as given: a rounded unit normal would put an eye in the plane beside it
  planeForms(n, dot(n, eye.relative(plane.origin)), eye, index, out.plane());
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
