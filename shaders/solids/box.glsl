// AABox: lo <= p <= hi per axis, closed; outward normal; from inside the far side is hit.
//
// eye    With n_i, f_i the distances from the eye to the nearer and farther face of slab i, the ray is inside slab i
//        for s in an interval of d_i/n_i and d_i/f_i. Eye outside the slab: s <= d_i/n_i and s >= d_i/f_i; eye
//        inside: s >= both. So up = min of the upper bounds, lo = max of the lower ones, hit where up >= lo, at
//        s = up from outside and s = lo from inside. The host gives the reciprocals: no division, no d_i == 0 case,
//        no infinities (a face through the eye has the reciprocal +-BIG).
//        d_i is a world component: |error| <= 7u |d|. Eye on the plane of a face or very near it: a bound of
//        s that hangs on a small d_i is in doubt, on any axis, and is counted (BOX_FACE; compiled in only where needed).
// free   slabs with an explicit test for d_i == 0.
// naive  slabs by reciprocal, min and max.
// eye record    (a, index) (c, eye inside) (l1, weight of up-lo) (l2, weight of d_i) (weights of d for BOX_FACE, -)
//               upper bounds d a + c (c = BIG where there is none), lower bounds d l1 and d l2
// world record  (lo, index) (hi, -)
#ifndef SOLIDCAST_BOX
#define SOLIDCAST_BOX
#include "../hit.glsl"

#ifndef BOX_FACE
#define BOX_FACE false
#endif

void box_eye(uint row, EyeRay ray, inout Best best) {
  real4 a = record(row);
  real4 c = record(row + 1u);
  real4 l1 = record(row + 2u);
  real4 l2 = record(row + 3u);
  real3 d = ray.world;
  real upX = add(mul(d.x, a.x), c.x), upY = add(mul(d.y, a.y), c.y), upZ = add(mul(d.z, a.z), c.z);
  real loX = larger(mul(d.x, l1.x), mul(d.x, l2.x));
  real loY = larger(mul(d.y, l1.y), mul(d.y, l2.y));
  real loZ = larger(mul(d.z, l1.z), mul(d.z, l2.z));
  real up = smaller(smaller(upX, upY), upZ);
  real lo = larger(larger(loX, loY), loZ);
  bool inner = less(number(0.0), c.w);
  bool hit = atLeast(up, lo);
  real s = select(up, lo, inner);
  real decisive = select(sub(up, lo), settled(), inner);  // from inside there is nothing to miss
  // The face whose bound is s; at an edge the first axis. |d_i| = s |face distance|.
  bool onX = inner ? atLeast(loX, s) : atLeast(s, upX);
  bool onY = inner ? atLeast(loY, s) : atLeast(s, upY);
  real towards = magnitude(select(select(d.z, d.y, onY), d.x, onX));
  decided(best, mul(decisive, l1.w));
  if (GRAZING) decided(best, mul(select(settled(), towards, hit), l2.w));
  if (BOX_FACE) {
    real4 w = record(row + 4u);
    decided(best, mul(d.x, w.x));
    decided(best, mul(d.y, w.y));
    decided(best, mul(d.z, w.z));
  }
  offer(best, hit, s, select(towards, negate(towards), inner), a.w);
}

#if ARITHMETIC != 2
void box_free(uint row, FreeRay ray, inout Best best) {
  real4 low = worldRecord(row);
  real3 lo = minus3(low.xyz, ray.origin);
  real3 hi = minus3(worldRecord(row + 1u).xyz, ray.origin);
  real length = root(ray.squared);
  real scale = originScale(ray, low.xyz, lo) + originScale(ray, worldRecord(row + 1u).xyz, hi);
  real enter = real(0), leave = real(0);
  bool unbounded = true;
  real towardsEnter = real(0), towardsLeave = real(0);
  bool miss = false;
  for (int i = 0; i < 3; ++i) {
    real d = ray.direction[i];
    if (d == real(0)) {
      miss = miss || lo[i] > real(0) || hi[i] < real(0);
      decidedAgainst(best, lo[i], scale);
      decidedAgainst(best, hi[i], scale);
    } else {
      real first = quotient(d > real(0) ? lo[i] : hi[i], d);
      real second = quotient(d > real(0) ? hi[i] : lo[i], d);
      if (unbounded || first > enter) {
        enter = first;
        towardsEnter = abs(d);
      }
      if (unbounded || second < leave) {
        leave = second;
        towardsLeave = abs(d);
      }
      unbounded = false;
    }
  }
  // Errors of the distances are those of lo and hi over |d_i|.
  decidedAgainst(best, leave - enter, abs(leave) + abs(enter));
  decidedAgainst(best, enter * towardsEnter, scale);
  decidedAgainst(best, leave * towardsLeave, scale);
  bool outside = enter > real(0);
  real t = outside ? enter : leave;
  bool hit = !miss && enter <= leave && t > real(0);
  decidedAgainst(best, hit ? (outside ? towardsEnter : towardsLeave) : length, length);
  offer(best, hit, quotient(real(1), t), outside ? towardsEnter : -towardsLeave, low.w);
}

void box_naive(uint row, vec3 origin, vec3 direction, inout Nearest best) {
  vec4 low = vec4(worldRecord(row));
  precise vec3 inverse = 1.0 / direction;
  precise vec3 a = (low.xyz - origin) * inverse;
  precise vec3 b = (vec3(worldRecord(row + 1u).xyz) - origin) * inverse;
  vec3 first = min(a, b), second = max(a, b);
  float enter = max(max(first.x, first.y), first.z);
  float leave = min(min(second.x, second.y), second.z);
  bool outside = enter > 0.0;
  float t = outside ? enter : leave;
  vec3 bound = outside ? first : second;
  float d = abs(t == bound.x ? direction.x : t == bound.y ? direction.y : direction.z);
  offerNaive(best, enter <= leave, t, outside ? d : -d, low.w);
}

// The face nearest to the hit point, of those that the ray enters (or, from inside, leaves) by; at an edge the first
// axis.
void box_finish(uint row, real3 hit, real3 direction, real cosine, inout real3 normal,
                inout real3 local) {
  real3 lo = worldRecord(row).xyz, hi = worldRecord(row + 1u).xyz;
  bool entered = cosine >= real(0);
  real3 off = real3(0);
  for (int i = 0; i < 3; ++i) {
    real d = direction[i];
    off[i] = d == real(0) ? real(BIG) : abs(sub(hit[i], (d > real(0)) == entered ? lo[i] : hi[i]));
  }
  real nearest = smaller(smaller(off.x, off.y), off.z);
  real3 axis = off.x == nearest ? real3(1, 0, 0) : off.y == nearest ? real3(0, 1, 0) : real3(0, 0, 1);
  bool forwards = dot3(axis, direction) > real(0);
  normal = forwards == entered ? -axis : axis;
}
#endif
#endif
