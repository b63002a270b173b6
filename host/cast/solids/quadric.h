// Quadric on the GPU's side; the mathematics is told in shaders/solids/quadric.glsl.
#pragma once
#include "host/cast/solids/plane.h"

namespace solidcast {

template <class T>
struct Symmetric {  // 3x3
  T xx, yy, zz, xy, xz, yz;
  Vec3<T> operator*(Vec3<T> v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  T norm() const { return squareRoot(xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)); }
  Symmetric operator*(T k) const { return {xx * k, yy * k, zz * k, xy * k, xz * k, yz * k}; }
};

/// p'Mp + 2 l.p + j
template <class T>
struct QuadricForm {
  Symmetric<T> M;
  Vec3<T> l;
  T j;
};

template <class T = f128>
QuadricForm<T> quadricForm(const Quadric& quadric) {
  const auto& c = quadric.coefficients;
  return {{c[0], c[1], c[2], T(c[3]) / 2, T(c[4]) / 2, T(c[5]) / 2}, {T(c[6]) / 2, T(c[7]) / 2, T(c[8]) / 2}, c[9]};
}

/// Rows for A = d'Md, B = w.d, C along rays from the eye; M, w in world axes and in the eye's unit of length.
template <class T>
void quadricForms(Symmetric<T> M, Vec3<T> w, T C, const Frame<T>& eye, T index, EyeRecord<T>& out, bool negated) {
  Vec3<T> r = eye.right, u = eye.upward, b = eye.backward;
  Vec3<T> Mr = M * r, Mu = M * u, Mb = M * b;
  M = {dot(r, Mr), dot(u, Mu), dot(b, Mb), dot(r, Mu), dot(r, Mb), dot(u, Mb)};
  w = eye.toCamera(w);
  T sign = negated ? -1 : 1;
  if (C < 0) M = M * -1, w = -w, C = -C, sign = -sign;
  // Powers of two that bring |M| to about 1 and C to about |M|: t = tau t', and everything times mu.
  T tau = powerOfTwo(C > 0 ? squareRoot(C / M.norm()) : length(w) / M.norm());
  T mu = 1 / (powerOfTwo(M.norm()) * tau * tau);
  M = M * (mu * tau * tau), w = w * (mu * tau), C = C * mu;
  T u0 = unitRoundoff(out.type), size = M.norm(), slope = length(w), huge = T(twoTo(100));
  out.kind = kinds::quadric;
  out.add(M.xx, M.yy, M.zz, C);
  out.add(M.xy, M.xz, M.yz, 1 / tau);
  out.add(w, index);
  out.add(sign, 1 / (larger(T(1), u0 * T(twoTo(58))) * (slope * slope + C * size)),
          C > 0 ? T(twoTo(-26)) / (C * size) : huge, T(twoTo(-27)) / size);
  out.add(C > 0 ? huge : T(twoTo(-26)) / slope, 0, 0, 0);
}

template <class T>
void packEye(const Quadric& quadric, const Frame<T>& eye, T index, EyeRecord<T>& out) {
  QuadricForm<T> Q = quadricForm<T>(quadric);
  Vec3<T> o = eye.origin;
  Vec3<T> w = Q.M * o + Q.l;
  T C = dot(o, w + Q.l) + Q.j;
  // What is left of an eye on the surface is binary128's rounding; the second pass has the same rule.
  T reach = length(o), scale = (Q.M.norm() * reach + 2 * length(Q.l)) * reach + magnitude(Q.j);
  out.counts(C, scale);
  out.counts(length(w), Q.M.norm() * reach + length(Q.l));
  if (magnitude(C) <= T(twoTo(-100)) * scale) C = 0;
  Symmetric<T> M = Q.M * (eye.unit * eye.unit);
  w = w * eye.unit;
  if (Q.M.norm() == 0) {  // a plane 2 l.p + j = 0
    planeForms<T>(Q.l, -C / 2 / eye.unit, eye, index, out);
  } else if (C != 0 || !isZero(w)) {  // else the eye is a cone's apex: nothing but t = 0
    quadricForms<T>(M, w, C, eye, index, out, false);
  }
}

inline void packWorld(const Quadric& quadric, V3 origin, f128 index, RowWriter& out) {
  QuadricForm<f128> Q = quadricForm(quadric);
  // The equation may be scaled as one likes: coefficients of 1e30 or 1e-40 would leave fp32.
  f128 k = 1 / powerOfTwo(Q.M.norm() > 0 ? Q.M.norm() : length(Q.l));
  V3 w = Q.M * origin + Q.l;
  out.row(Q.M.xx * k, Q.M.yy * k, Q.M.zz * k, index);
  out.row(Q.M.xy * k, Q.M.xz * k, Q.M.yz * k, (dot(origin, w + Q.l) + Q.j) * k);
  out.row(w * k, 0);
}

/// Smallest t > 0 with A t^2 + 2 B t + C = 0; scales are the sizes of the terms that A, B and C were summed from.
inline Cut smallestRoot(f128 A, f128 B, f128 C, f128 scaleA, f128 scaleB, f128 scaleC) {
  Cut best;
  auto flushed = [&](f128 x, f128 scale) {
    bool zero = fabsq(x) <= slack() * scale;
    best.close = best.close || zero;
    return zero ? 0 : x;
  };
  A = flushed(A, scaleA), B = flushed(B, scaleB), C = flushed(C, scaleC);
  if (A == 0 && B == 0) return best;
  f128 q = B * B - A * C;
  f128 doubt = slack() * (2 * fabsq(B) * scaleB + fabsq(A) * scaleC + fabsq(C) * scaleA + scaleB * scaleB * slack());
  best.close = best.close || fabsq(q) <= doubt;
  if (q < -doubt) return best;
  f128 h = q > 0 ? sqrtq(q) : 0;
  f128 z = B > 0 ? -(B + h) : h - B;  // roots z/A and C/z, no cancellation
  auto offer = [&](f128 numerator, f128 denominator) {
    if (denominator == 0 || numerator == 0) return;
    f128 t = numerator / denominator;
    if (t > 0 && (!best.hit || t < best.t)) best.hit = true, best.t = t;
  };
  offer(z, A);
  offer(C, z);
  return best;
}

inline Cut cutQuadric(const Symmetric<f128>& M, V3 l, f128 j, const RayQ& ray) {
  V3 o = ray.origin, d = ray.direction;
  V3 w = M * o + l;
  f128 A = dot(d, M * d), B = dot(w, d), C = dot(o, w + l) + j;
  f128 size = M.norm(), reach = length(o), slope = size * reach + length(l);
  return smallestRoot(A, B, C, size * dot(d, d), slope * length(d), (slope + length(l)) * reach + fabsq(j));
}

inline Ball ball(const Quadric&) { return {{0, 0, 0}, -1}; }

inline Cut cut(const Quadric& quadric, const RayQ& ray) {
  QuadricForm<f128> Q = quadricForm(quadric);
  return cutQuadric(Q.M, Q.l, Q.j, ray);
}

inline Surface surface(const Quadric& quadric, const RayQ& ray, f128 t) {
  QuadricForm<f128> Q = quadricForm(quadric);
  V3 p = ray.origin + t * ray.direction;
  V3 gradient = Q.M * p + Q.l;
  f128 scale = Q.M.norm() * length(p) + length(Q.l);
  if (length(gradient) <= slack() * scale) return {-normalized(ray.direction), p};  // apex: it faces the ray
  return {normalized(gradient), p};
}

}  // namespace solidcast
