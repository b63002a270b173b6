// Disc: the part of a plane within r of c, rim included.
//
// eye    s = m.d as for the plane; with e1, e2 orthonormal in the disc, ((p-c).e1/r, (p-c).e2/r) s are the linear
//        forms u = U.d, v = V.d; hit where u^2 + v^2 <= s^2.
//        With f = c - o: U = (num e1 - (f.e1) n) / (r num), num = n.f. No point is formed, so no offset cancels.
//        Rounding of s^2 - u^2 - v^2: <= 16u (|m|^2 + |U|^2 + |V|^2) |d|^2.
// free   plane, then q = (o - c) + t d against r, with q.q <= r^2 multiplied out by (n.d)^2: no division.
// naive  plane hit, point, distance from the centre.
// eye record    (m, k) (U, index) (V, weight of s) (weight of the rim test, -, -, -)
// world record  (c, index) (n/|n|, r)
#ifndef SOLIDCAST_DISC
#define SOLIDCAST_DISC
#include "../hit.glsl"

void disc_eye(uint row, EyeRay ray, inout Best best) {
  real4 m = record(row);
  real4 u4 = record(row + 1u);
  real4 v4 = record(row + 2u);
  real s = linear(real3(m.x, m.y, m.z), ray.direction);
  real u = linear(real3(u4.x, u4.y, u4.z), ray.direction);
  real v = linear(real3(v4.x, v4.y, v4.z), ray.direction);
  real inside = sub(mul(s, s), add(mul(u, u), mul(v, v)));
  decided(best, mul(inside, record(row + 3u).x));
  bool hit = atLeast(inside, number(0.0));
  if (GRAZING) decided(best, mul(select(settled(), s, hit), v4.w));
  offer(best, hit, s, mul(s, m.w), u4.w);
}

#if ARITHMETIC != 2
void disc_free(uint row, FreeRay ray, inout Best best) {
  real4 c = worldRecord(row);
  real4 n = worldRecord(row + 1u);
  real3 f = minus3(c.xyz, ray.origin);
  real distance = dot3(n.xyz, f);
  real towards = dot3(n.xyz, ray.direction);
  precise real3 q = ray.direction * distance - f * towards;
  real r = mul(n.w, towards);
#ifndef EXACT  // squares of 1e20 overflow fp32; only the sign counts
  real unit = larger(larger(larger(abs(q.x), abs(q.y)), abs(q.z)), abs(r));
  if (unit > real(0)) {
    q = q / unit;
    r = r / unit;
  }
#endif
  real inside = sub(mul(r, r), dot3(q, q));
  real reach = originScale(ray, c.xyz, f);
  bool within = inside >= real(0);
  decidedAgainst(best, inside, ray.squared * (reach * reach + n.w * n.w));
  decidedAgainst(best, within ? distance : reach, reach);
  decidedAgainst(best, within ? towards : real(1), root(ray.squared));
  offer(best, within && distance != real(0) && towards != real(0), quotient(towards, distance), -towards, c.w);
}

void disc_naive(uint row, vec3 origin, vec3 direction, inout Nearest best) {
  vec4 c = vec4(worldRecord(row));
  vec4 n = vec4(worldRecord(row + 1u));
  float towards = float(dot3(n.xyz, direction));
  precise float t = float(dot3(n.xyz, minus3(c.xyz, origin))) / towards;
  precise vec3 p = origin + t * direction;
  vec3 q = vec3(minus3(p, c.xyz));
  offerNaive(best, float(dot3(q, q)) <= n.w * n.w, t, -towards, c.w);
}

void disc_finish(uint row, real3 hit, real3 direction, real cosine, inout real3 normal,
                 inout real3 local) {
  normal = worldRecord(row + 1u).xyz;
}
#endif
#endif
