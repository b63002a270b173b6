// What a ray is and what it remembers while it looks for the nearest solid.
//
// The search runs in inverse distance s = 1/t, t counted in lengths of the ray's direction. With a shared origin
// every solid is then a few linear and quadratic forms in the direction, the largest positive s wins, and no
// division is needed before the end. `best.s` starts at 0, so "in front of the eye" is the same comparison.
//
// Each solid's file gives up to three searches over the same solid:
//   KIND_eye    forms prepared by the host for one shared origin; real = float, double or double-float
//   KIND_free   any ray, from the solid itself; real = float or double
//   KIND_naive  any ray, the textbook in fp32: the yardstick
// and KIND_finish, which turns the winner into its normal and local coordinates.
#ifndef SOLIDCAST_HIT
#define SOLIDCAST_HIT
#include "numeric.glsl"

// One row of the solids' records for the search, and one of their world records; the including shader defines them.
real4 record(uint row);
real4 worldRecord(uint row);

struct EyeRay {
  real3 direction;  // in camera axes (right, upward, backward), any length
  real3 world;      // the same in world axes; only boxes read it
  real squared;     // |direction|^2
};

struct Best {
  real s;       // largest inverse distance so far; 0: nothing hit
  real cosine;  // -n.d of that hit, n the unit normal, d with the ray's length
  real index;   // of the solid, depth first
#ifdef EXACT
  real second;  // largest s that lost: too near to s means that the order is in doubt
  real margin;  // smallest decision so far, each divided by its own scale: below the bound it is in doubt
#endif
};

Best noHit() {
#ifdef EXACT
  return Best(number(0.0), number(0.0), number(-1.0), number(0.0), number(1.0));
#else
  return Best(number(0.0), number(0.0), number(-1.0));
#endif
}

// A sign of `value` was used whose rounding error is at most DOUBT |d|^2.
void decided(inout Best best, real value) {
#ifdef EXACT
  real m = magnitude(value);
  best.margin = select(best.margin, m, less(m, best.margin));
#endif
}

// Some finite flat solid can be seen at so flat an angle that s itself is in doubt there. The host knows the bound:
// |cosine| >= distance of the plane / distance of the farthest corner.
#ifndef GRAZING
#define GRAZING false
#endif

// Whether solids of different kinds can be at equal s by more than chance: the host looks for it. Those of one kind come in
// the order of their indices.
#ifndef TIES
#define TIES true
#endif

#ifndef ADDRESS
#define ADDRESS 0
#endif

// A candidate at inverse distance s. At equal s the solid with the lower index wins; `exact` leaves that, like
// every near tie, to the second pass.
void offer(inout Best best, bool inside, real s, real cosine, real index) {
#ifdef EXACT
  real candidate = select(number(0.0), s, inside);
  bool nearer = less(best.s, candidate);
  real loser = select(candidate, best.s, nearer);
  best.second = select(best.second, loser, less(best.second, loser));
#else
  // Numbers loaded by address are computed with all at once, and masks made long before they are used go to memory and
  // back: a number is selected instead. Where numbers are constants the mask is a part of the next comparison.
  if (ADDRESS != 0 && !TIES) {
    s = select(number(0.0), s, inside);
    inside = true;
  }
  bool nearer = inside && (less(best.s, s) || (TIES && atLeast(s, best.s) && less(index, best.index)));
#endif
  best.s = select(best.s, s, nearer);
  best.cosine = select(best.cosine, cosine, nearer);
  best.index = select(best.index, index, nearer);
}

#if ARITHMETIC != 2

struct FreeRay {
  real3 origin, direction;  // world axes; the origin is relative to the records' own
  real squared;             // |direction|^2
  real reach;               // |origin|, for error scales
};

// Size of the terms behind f = point - origin, for error scales. A query's origin (fp32) and the world's numbers (fp64)
// are exact, so that f has one rounding of its own size; a camera's grid of origins and its records are rounded before.
#ifndef ORIGIN_EXACT
#define ORIGIN_EXACT 0
#endif
real dot3(real3 a, real3 b) { return linear(a, b); }
real3 cross3(real3 a, real3 b) {
  precise real3 r = real3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  return r;
}
real3 minus3(real3 a, real3 b) {
  precise real3 r = a - b;
  return r;
}
real length3(real3 a) { return root(dot3(a, a)); }
real originScale(FreeRay ray, real3 point, real3 f) {
#if ORIGIN_EXACT
  return length3(f);
#else
  return length3(point) + ray.reach;
#endif
}
real3 unit3(real3 a) {  // scaled first: squares of 1e30 overflow fp32
  real big = larger(larger(abs(a.x), abs(a.y)), abs(a.z));
  if (big == real(0)) return a;
  precise real3 v = a / big;
  real l = length3(v);
  precise real3 r = v / l;
  return r;
}
// Like decided(), with the scale known only here. NaN (overflow) is doubt, and so is a scale so small that the terms
// behind the value have lost digits to underflow.
void decidedAgainst(inout Best best, real value, real scale) {
#ifdef EXACT
  real m = abs(value) / scale;
  m = m >= real(0) && scale * real(BIG) >= real(1.0e7) ? m : real(0);
  best.margin = select(best.margin, m, less(m, best.margin));
#endif
}

struct Nearest {  // of the textbook search, in t
  float t, cosine, index;
};
void offerNaive(inout Nearest best, bool hit, float t, float cosine, float index) {
  if (hit && t > 0.0 && (t < best.t || (t == best.t && index < best.index))) best = Nearest(t, cosine, index);
}

#endif
#endif
