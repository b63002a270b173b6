// Triangle (v1, v2, v3), edges e1 = v2 - v1, e2 = v3 - v1, normal n = e1 x e2; edges and vertices belong to it.
//
// eye    s = m.d as for the plane. With P = v1 + beta e1 + gamma e2, u = beta s = U.d and v = gamma s = V.d are linear:
//        f = v1 - o, num = n.f, U = [num (e2 x n) - ((f x e2).n) n] / (|n|^2 num),
//                               V = [num (n x e1) - ((e1 x f).n) n] / (|n|^2 num).
//        Hit where u >= 0, v >= 0, w = s - u - v >= 0: no division, and the sign of the determinant is gone (s > 0
//        fixes it). Only these signs count, so each of U, V, W = m - U - V is scaled to unit length.
//        Slivers and far offsets cost nothing: the cancelling cross products are the host's, in binary128.
//        Rounding of each form: <= 7u |d|.
// free   Moeller-Trumbore without divisions before the tests.
// naive  Moeller-Trumbore as published.
// eye record    (m, k) (U, index) (V, weight of s) (W, -)
// world record  (v1, index) (e1, -) (e2, -) (n/|n|, -)
#ifndef SOLIDCAST_TRIANGLE
#define SOLIDCAST_TRIANGLE
#include "../hit.glsl"

void triangle_eye(uint row, EyeRay ray, inout Best best) {
  real4 m = record(row);
  real4 a = record(row + 1u);
  real4 b = record(row + 2u);
  real4 c = record(row + 3u);
  real s = linear(real3(m.x, m.y, m.z), ray.direction);
  real inside = smaller(smaller(linear(real3(a.x, a.y, a.z), ray.direction), linear(real3(b.x, b.y, b.z), ray.direction)),
                        linear(real3(c.x, c.y, c.z), ray.direction));
  decided(best, inside);
  bool hit = atLeast(inside, number(0.0));
  if (GRAZING) decided(best, mul(select(settled(), s, hit), b.w));
  offer(best, hit, s, mul(s, m.w), a.w);
}

#if ARITHMETIC != 2
void triangle_free(uint row, FreeRay ray, inout Best best) {
  real4 v1 = worldRecord(row);
  real3 e1 = worldRecord(row + 1u).xyz, e2 = worldRecord(row + 2u).xyz;
  real3 f = minus3(ray.origin, v1.xyz);
  real3 p = cross3(ray.direction, e2);
  real det = dot3(e1, p);
  real sgn = det < real(0) ? real(-1) : real(1);
  real u = mul(sgn, dot3(f, p));
  real3 q = cross3(f, e1);
  real v = mul(sgn, dot3(ray.direction, q));
  real distance = mul(sgn, dot3(e2, q));
  real inside = smaller(smaller(u, v), sub(sub(abs(det), u), v));
  real reach = originScale(ray, v1.xyz, f), length = root(ray.squared), l1 = length3(e1), l2 = length3(e2);
  bool hit = inside >= real(0) && det != real(0);
  decidedAgainst(best, inside, length * (reach * (l1 + l2) + l1 * l2));
  decidedAgainst(best, det, length * l1 * l2);
  decidedAgainst(best, hit ? distance : real(1), hit ? reach * l1 * l2 : real(1));
  real towards = dot3(worldRecord(row + 3u).xyz, ray.direction);
  offer(best, hit && distance != real(0), quotient(abs(det), distance), -towards, v1.w);
}

void triangle_naive(uint row, vec3 origin, vec3 direction, inout Nearest best) {
  vec4 v1 = vec4(worldRecord(row));
  vec3 e1 = vec3(worldRecord(row + 1u).xyz), e2 = vec3(worldRecord(row + 2u).xyz);
  vec3 p = vec3(cross3(direction, e2));
  float det = float(dot3(e1, p));
  precise float inverse = 1.0 / det;
  vec3 f = vec3(minus3(origin, v1.xyz));
  precise float u = float(dot3(f, p)) * inverse;
  vec3 q = vec3(cross3(f, e1));
  precise float v = float(dot3(direction, q)) * inverse;
  precise float t = float(dot3(e2, q)) * inverse;
  precise float uv = u + v;
  float towards = float(dot3(worldRecord(row + 3u).xyz, direction));
  offerNaive(best, det != 0.0 && u >= 0.0 && v >= 0.0 && uv <= 1.0, t, -towards, v1.w);
}

void triangle_finish(uint row, real3 hit, real3 direction, real cosine, inout real3 normal,
                     inout real3 local) {
  normal = worldRecord(row + 3u).xyz;
  real3 q = minus3(hit, worldRecord(row).xyz), e1 = worldRecord(row + 1u).xyz, e2 = worldRecord(row + 2u).xyz;
  real area = dot3(cross3(e1, e2), normal);
  real beta = quotient(dot3(cross3(q, e2), normal), area);
  real gamma = quotient(dot3(cross3(e1, q), normal), area);
  local = real3(real(1) - beta - gamma, beta, gamma);
}
#endif
#endif
