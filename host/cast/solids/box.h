// AABox on the GPU's side; the mathematics is told in shaders/solids/box.glsl.
#pragma once
#include <utility>

#include "host/cast/rational_pass.h"
#include "host/cast/solids/quad.h"

namespace solidcast {

template <class T>
struct Corners {
  Vec3<T> lo, hi;
};
template <class T = f128>
Corners<T> corners(const AABox& box) {
  Vec3<T> a(box.corner1), b(box.corner2), lo, hi;
  for (int i = 0; i < 3; ++i) lo[i] = smaller(a[i], b[i]), hi[i] = larger(a[i], b[i]);
  return {lo, hi};
}

/// A box without thickness on one axis, seen from outside that plane, is a quad whose normal faces the eye. (In the
/// box's own form every hit would be a tie of the two faces.)
template <class T>
bool packFlat(const Corners<T>& c, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  Vec3<T> size = c.hi - c.lo;
  int flat = size.x == 0 ? 0 : size.y == 0 ? 1 : size.z == 0 ? 2 : -1;
  if (flat < 0) return false;
  int a = (flat + 1) % 3, b = (flat + 2) % 3;
  if (size[a] == 0 || size[b] == 0 || eye.origin[flat] == c.lo[flat]) return false;
  if (eye.origin[flat] < c.lo[flat]) std::swap(a, b);
  Span<T> s{c.lo, {}, {}};
  s.e1[a] = size[a], s.e2[b] = size[b];
  spanForms(s, true, eye, index, out);
  return true;
}

/// Axes on which the eye is so near the plane of a face that a bound of s may be in doubt: d_i is then small against
/// |d| where that bound is about s. (d_i loses 2^-28 below 2^-22 |d| in fp64, 2^-13 in double-float.)
template <class T>
std::array<bool, 3> nearFacePlane(const AABox& box, const Frame<T>& eye) {
  Corners<T> c = corners<T>(box);
  T plane[3], farthest = 0;
  for (int i = 0; i < 3; ++i) {
    T a = magnitude(c.lo[i] - eye.origin[i]), b = magnitude(c.hi[i] - eye.origin[i]);
    plane[i] = smaller(a, b);
    farthest += larger(a, b);
  }
  std::array<bool, 3> near{};
  for (std::size_t i = 0; i < 3; ++i) near[i] = plane[i] <= farthest * T(twoTo(-10));
  return near;
}

/// box.glsl needs BOX_FACE.
template <class T>
bool eyeOnFacePlane(const AABox& box, const Frame<T>& eye) {
  std::array<bool, 3> near = nearFacePlane(box, eye);
  return near[0] || near[1] || near[2];
}

template <class T>
void packEye(const AABox& box, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  Corners<T> c = corners<T>(box);
  if (packFlat(c, eye, index, out)) return;
  Vec3<T> up, cap, low1, low2, onFace;
  T big = bigNumber(out.type), steep = steepNumber(out.type), steepest = 0;
  T nearest = -1, farthest = 0;  // plane of a face that can be hit; corner
  bool inside = true;
  std::array<bool, 3> near = nearFacePlane(box, eye);
  for (int i = 0; i < 3; ++i) {
    T a = (c.lo[i] - eye.origin[i]) / eye.unit, b = (c.hi[i] - eye.origin[i]) / eye.unit;
    farthest += larger(magnitude(a), magnitude(b));
    onFace[i] = twoTo(near[static_cast<std::size_t>(i)] ? -26 : 100);
    if (a > 0 || b < 0) {
      inside = false;
      up[i] = 1 / (a > 0 ? a : b), cap[i] = 0;
      low1[i] = low2[i] = 1 / (a > 0 ? b : a);
    } else {
      up[i] = 0, cap[i] = big;
      low1[i] = a == 0 ? -steep : 1 / a;
      low2[i] = b == 0 ? steep : 1 / b;
      // Eye on this face: below the bound of any ray that leaves by it (the face itself is at t = 0, no hit), above
      // all others.
      if (a == 0 || b == 0) cap[i] = steep * twoTo(out.type == RealType::f64 ? -66 : -42);
    }
    T plane = smaller(magnitude(a), magnitude(b));
    if ((a > 0 || b < 0) && (nearest < 0 || plane < nearest)) nearest = plane;
    for (T v : {up[i], low1[i], low2[i]})
      if (magnitude(v) != steep) steepest = larger(steepest, magnitude(v));
  }
  if (inside)
    for (int i = 0; i < 3; ++i)
      for (T v : {c.lo[i], c.hi[i]}) {
        T plane = magnitude(v - eye.origin[i]) / eye.unit;
        if (nearest < 0 || plane < nearest) nearest = plane;
      }
  out.mayGraze(nearest, farthest);
  out.kind = kinds::box;
  out.add(up, index);
  out.add(cap, inside ? 1 : 0);
  out.add(low1, steepest > 0 ? 1 / steepest : T(1));
  out.add(low2, T(twoTo(-26)));
  out.add(onFace, 0);
}

inline void packWorld(const AABox& box, V3 origin, f128 index, RowWriter& out) {
  Corners<f128> c = corners(box);
  out.row(c.lo - origin, index);
  out.row(c.hi - origin, 0);
}

inline std::array<Triple, 8> outline(const AABox& box, const Triple& origin) {
  const Triple a = difference(box.corner1, origin), b = difference(box.corner2, origin);
  std::array<Triple, 8> points;
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 3; ++k) points[i][k] = (i >> k & 1 ? b : a)[k];
  return points;
}

inline Ball ball(const AABox& box) { return {box.corner1, distance(box.corner1, box.corner2)}; }

inline Cut cut(const AABox& box, const RayQ& ray) {
  Corners<f128> c = corners(box);
  f128 enter = -1, leave = -1;
  bool bounded = false, entered = false, almost = false;
  for (int i = 0; i < 3; ++i) {
    f128 a = c.lo[i] - ray.origin[i], b = c.hi[i] - ray.origin[i], d = ray.direction[i];
    if (d == 0 || (!ray.rational && fabsq(d) <= slack() * length(ray.direction))) {
      almost = almost || d != 0;
      if (a > 0 || b < 0) return {};
      continue;
    }
    f128 first = (d > 0 ? a : b) / d, second = (d > 0 ? b : a) / d;
    enter = entered ? larger(enter, first) : first;
    leave = bounded ? smaller(leave, second) : second;
    entered = bounded = true;
  }
  if (!bounded) return {};
  f128 beyond = enter - leave, doubt = slack() * fabsq(leave), t = enter > 0 ? enter : leave;
  return {beyond <= doubt && t > 0, t, almost || fabsq(beyond) <= doubt};
}

inline Surface surface(const AABox& box, const RayQ& ray, f128 t) {
  Corners<f128> c = corners(box);
  V3 p = ray.origin + t * ray.direction;
  // Entered from outside: the normal is against the ray; left from inside or from the surface: along it. Faces on the
  // other side are not asked: a ray that enters at an edge may leave there too.
  bool entering = false;
  for (int i = 0; i < 3; ++i) entering = entering || ray.origin[i] < c.lo[i] || ray.origin[i] > c.hi[i];
  int face = -1;
  f128 nearest = 0, doubt = slack() * (length(p) + length(c.hi - c.lo));
  bool close = false;
  for (int i = 0; i < 3; ++i) {  // the first axis among equals, as in the search
    if (ray.direction[i] == 0) continue;
    f128 off = fabsq(p[i] - ((ray.direction[i] > 0) == entering ? c.lo[i] : c.hi[i]));
    close = close || (face >= 0 && fabsq(off - nearest) <= doubt);
    if (face < 0 || off < nearest - doubt) face = i, nearest = off;
  }
  if (close && ray.rational) face = rationalFace(box, ray, entering);
  V3 n;
  n[face] = (ray.direction[face] > 0) == entering ? -1 : 1;
  return {n, p};
}

}  // namespace solidcast
