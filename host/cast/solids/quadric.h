// Quadric on the GPU's side; the mathematics is told in shaders/solids/quadric.glsl.
#pragma once
#include "host/cast/solids/plane.h"

namespace solidcast {

struct Symmetric {  // 3x3
  f128 xx, yy, zz, xy, xz, yz;
  V3 operator*(V3 v) const {
    return {xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z, xz * v.x + yz * v.y + zz * v.z};
  }
  f128 norm() const { return sqrtq(xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)); }
  Symmetric operator*(f128 k) const { return {xx * k, yy * k, zz * k, xy * k, xz * k, yz * k}; }
};

/// p'Mp + 2 l.p + j
struct QuadricForm {
  Symmetric M;
  V3 l;
  f128 j;
};

inline QuadricForm quadricForm(const Quadric& quadric) {
  const auto& c = quadric.coefficients;
  return {{c[0], c[1], c[2], f128(c[3]) / 2, f128(c[4]) / 2, f128(c[5]) / 2},
          V3{f128(c[6]) / 2, f128(c[7]) / 2, f128(c[8]) / 2},
          c[9]};
}

/// Rows for A = d'Md, B = w.d, C along rays from the eye; M, w in world axes and in the eye's unit of length.
inline void quadricForms(Symmetric M, V3 w, f128 C, const EyeFrame& eye, f128 index, RowWriter& out, bool negated) {
  V3 r = eye.right, u = eye.upward, b = eye.backward;
  V3 Mr = M * r, Mu = M * u, Mb = M * b;
  M = {dot(r, Mr), dot(u, Mu), dot(b, Mb), dot(r, Mu), dot(r, Mb), dot(u, Mb)};
  w = eye.toCamera(w);
  f128 sign = negated ? -1 : 1;
  if (C < 0) M = M * -1, w = -w, C = -C, sign = -sign;
  // Powers of two that bring |M| to about 1 and C to about |M|: t = tau t', and everything times mu.
  f128 tau = powerOfTwo(C > 0 ? sqrtq(C / M.norm()) : length(w) / M.norm());
  f128 mu = 1 / (powerOfTwo(M.norm()) * tau * tau);
  M = M * (mu * tau * tau), w = w * (mu * tau), C = C * mu;
  f128 u0 = unitRoundoff(out.type()), size = M.norm(), slope = length(w), huge = ldexpq(1, 100);
  out.row(M.xx, M.yy, M.zz, C);
  out.row(M.xy, M.xz, M.yz, 1 / tau);
  out.row(w, index);
  out.row(sign, 1 / (larger(1, ldexpq(u0, 58)) * (slope * slope + C * size)),
          C > 0 ? ldexpq(1, -26) / (C * size) : huge, ldexpq(1, -27) / size);
  out.row(C > 0 ? huge : ldexpq(1, -26) / slope, 0, 0, 0);
}

inline void packEye(const Quadric& quadric, const EyeFrame& eye, f128 index, const EyeWriters& out) {
  QuadricForm Q = quadricForm(quadric);
  V3 o = eye.origin;
  V3 w = Q.M * o + Q.l;
  f128 C = dot(o, w + Q.l) + Q.j;
  // What is left of an eye on the surface is binary128's rounding; the second pass has the same rule.
  f128 reach = length(o), scale = (Q.M.norm() * reach + 2 * length(Q.l)) * reach + fabsq(Q.j);
  if (fabsq(C) <= slack() * scale) C = 0;
  Symmetric M = Q.M * (eye.unit * eye.unit);
  w = w * eye.unit;
  if (Q.M.norm() == 0) {  // a plane 2 l.p + j = 0
    planeForms(Q.l, -C / 2 / eye.unit, eye, index, out.plane());
  } else if (C != 0 || !isZero(w)) {  // else the eye is a cone's apex: nothing but t = 0
    quadricForms(M, w, C, eye, index, out.quadric(), false);
  }
}

inline void packWorld(const Quadric& quadric, V3 origin, f128 index, RowWriter& out) {
  QuadricForm Q = quadricForm(quadric);
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

inline Cut cutQuadric(const Symmetric& M, V3 l, f128 j, const RayQ& ray) {
  V3 o = ray.origin, d = ray.direction;
  V3 w = M * o + l;
  f128 A = dot(d, M * d), B = dot(w, d), C = dot(o, w + l) + j;
  f128 size = M.norm(), reach = length(o), slope = size * reach + length(l);
  return smallestRoot(A, B, C, size * dot(d, d), slope * length(d), (slope + length(l)) * reach + fabsq(j));
}

inline Ball ball(const Quadric&) { return {{0, 0, 0}, -1}; }

inline Cut cut(const Quadric& quadric, const RayQ& ray) {
  QuadricForm Q = quadricForm(quadric);
  return cutQuadric(Q.M, Q.l, Q.j, ray);
}

inline Surface surface(const Quadric& quadric, const RayQ& ray, f128 t) {
  QuadricForm Q = quadricForm(quadric);
  V3 p = ray.origin + t * ray.direction;
  V3 gradient = Q.M * p + Q.l;
  f128 scale = Q.M.norm() * length(p) + length(Q.l);
  if (length(gradient) <= slack() * scale) return {-normalized(ray.direction), p};  // apex: it faces the ray
  return {normalized(gradient), p};
}

}  // namespace solidcast
