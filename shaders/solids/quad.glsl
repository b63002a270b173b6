// Quad: the parallelogram vertex + u span1 + v span2, u and v in [0,1], edges included; normal span1 x span2.
//
// eye    the triangle's forms with e1 = span1, e2 = span2; hit where the forms u, v, s - u, s - v are
//        not negative; only signs count, so each is scaled to unit length.
// free   Cramer's rule without divisions before the tests.
// naive  the same divided through, as usually written.
// eye record    (m, k) (U, index) (V, weight of s) (m - U, -) (m - V, -)
// world record  (vertex, index) (span1, -) (span2, -) (n/|n|, -)
#ifndef SOLIDCAST_QUAD
#define SOLIDCAST_QUAD
#include "../hit.glsl"

void quad_eye(uint row, EyeRay ray, inout Best best) {
  real4 m = record(row);
  real4 a = record(row + 1u);
  real4 b = record(row + 2u);
  real4 c = record(row + 3u);
  real4 e = record(row + 4u);
  real s = linear(real3(m.x, m.y, m.z), ray.direction);
  real inside = smaller(smaller(linear(real3(a.x, a.y, a.z), ray.direction), linear(real3(b.x, b.y, b.z), ray.direction)),
                        smaller(linear(real3(c.x, c.y, c.z), ray.direction), linear(real3(e.x, e.y, e.z), ray.direction)));
  decided(best, inside);
  bool hit = atLeast(inside, number(0.0));
  if (GRAZING) decided(best, mul(select(settled(), s, hit), b.w));
  offer(best, hit, s, mul(s, m.w), a.w);
}

#if ARITHMETIC != 2
void quad_free(uint row, FreeRay ray, inout Best best) {
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
  real inside = smaller(smaller(u, v), sub(abs(det), larger(u, v)));
  real reach = originScale(ray, v1.xyz, f), length = root(ray.squared), l1 = length3(e1), l2 = length3(e2);
  bool hit = inside >= real(0) && det != real(0);
  decidedAgainst(best, inside, length * (reach * (l1 + l2) + l1 * l2));
  decidedAgainst(best, det, length * l1 * l2);
  decidedAgainst(best, hit ? distance : real(1), hit ? reach * l1 * l2 : real(1));
  real towards = dot3(worldRecord(row + 3u).xyz, ray.direction);
  offer(best, hit && distance != real(0), quotient(abs(det), distance), -towards, v1.w);
}

void quad_naive(uint row, vec3 origin, vec3 direction, inout Nearest best) {
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
  float towards = float(dot3(worldRecord(row + 3u).xyz, direction));
  offerNaive(best, det != 0.0 && u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0, t, -towards, v1.w);
}

void quad_finish(uint row, real3 hit, real3 direction, real cosine, inout real3 normal,
                 inout real3 local) {
  normal = worldRecord(row + 3u).xyz;
  real3 q = minus3(hit, worldRecord(row).xyz), e1 = worldRecord(row + 1u).xyz, e2 = worldRecord(row + 2u).xyz;
  real area = dot3(cross3(e1, e2), normal);
  real beta = quotient(dot3(cross3(q, e2), normal), area);
  real gamma = quotient(dot3(cross3(e1, q), normal), area);
  local = real3(beta, gamma, real(0));
}
#endif
#endif
