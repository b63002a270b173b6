// InfinitePlane: n.(p - p0) = 0, hit from both sides; a ray in or parallel to the plane misses.
//
// eye    s = m.d with m = n / n.(p0-o). The host drops a plane that holds the eye: it cannot be hit.
//        Rounding: |s^ - s| <= 7u |m||d|, so s keeps 2^-28 relative unless |s| < 7u 2^28 |m||d| (grazing: in doubt).
// free   t = n.(p0-o) / n.d, taken as s = n.d / n.(p0-o).
// naive  the same in fp32 with D = -n.p0, as most textbooks have it.
// eye record    (m, k) (index, weight of s, -, -)   k = -n.(p0-o)/|n|, so that the cosine is k s
// world record  (p0, index) (n/|n|, -)
#ifndef SOLIDCAST_PLANE
#define SOLIDCAST_PLANE
#include "../hit.glsl"

void plane_eye(uint row, EyeRay ray, inout Best best) {
  real4 m = record(row);
  real4 more = record(row + 1u);
  real s = linear(real3(m.x, m.y, m.z), ray.direction);
  decided(best, mul(s, more.y));
  offer(best, true, s, mul(s, m.w), more.x);
}

#if ARITHMETIC != 2
void plane_free(uint row, FreeRay ray, inout Best best) {
  real4 p = worldRecord(row);
  real3 n = worldRecord(row + 1u).xyz;
  real3 f = minus3(p.xyz, ray.origin);
  real distance = dot3(n, f);
  real towards = dot3(n, ray.direction);
  real s = quotient(towards, distance);
  decidedAgainst(best, distance, originScale(ray, p.xyz, f));
  decidedAgainst(best, towards, root(ray.squared));
  offer(best, distance != real(0), s, -towards, p.w);
}

void plane_naive(uint row, vec3 origin, vec3 direction, inout Nearest best) {
  vec4 p = vec4(worldRecord(row));
  vec3 n = vec3(worldRecord(row + 1u).xyz);
  float offset = -float(dot3(n, p.xyz));
  float towards = float(dot3(n, direction));
  precise float t = -(float(dot3(n, origin)) + offset) / towards;
  offerNaive(best, towards != 0.0, t, -towards, p.w);
}

void plane_finish(uint row, real3 hit, real3 direction, real cosine, inout real3 normal,
                  inout real3 local) { normal = worldRecord(row + 1u).xyz; }
#endif
#endif
