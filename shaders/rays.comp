#version 450
// Free rays: each with its own origin, one an invocation.
//
// METHOD 0 naive and 1 fast give the whole hit. METHOD 2 exact gives the solid, or that it is in doubt: t, normal and
// local coordinates of that one solid are the host's, in binary128 (a query's text costs more than they do), and so
// is the whole search for the few rays in doubt.
//
// INDEX: each kind's loop walks its tree of boxes (index.glsl). A ray that is not through after STEPS of them keeps what it
// found and where it was, and goes on in another dispatch: llvmpipe stops all loops of an invocation's vector together
// after 65535 rounds without a word.
#extension GL_GOOGLE_include_directive : require

#if METHOD == 2
#define EXACT
#endif
#define EYE 0
#define ORIGIN_EXACT (ARITHMETIC == 1)
#define WORLD 1
#include "search.glsl"
#if METHOD != 2
#include "finish.glsl"
#endif

layout(local_size_x = 64) in;

layout(constant_id = 28) const float DOUBT = 0.0;  // bound of decidedAgainst()

layout(push_constant) uniform Portion {
  uint rays;
  uint stage;  // bit 0: first portion of the solids, bit 1: last
  uint count[7], firstRow[7];  // INDEX: the node after the kind's last; row of the place 0 in the index's order
} portion;

struct QueryRay {
  vec4 origin;     // and tMax
  vec4 direction;
};
struct QueryHit {
  int index;  // -1 no hit, -2 in doubt
  float t;
  float normal[3], local[3], position[3];
};
layout(set = 0, binding = 2, std430) readonly buffer Rays { QueryRay rays[]; };
layout(set = 0, binding = 3, std430) buffer Hits { QueryHit hits[]; };

#if METHOD == 0
#define Found Nearest
#else
#define Found Best
#endif
#if STORAGE
struct Kept {
  real s, cosine, index, second, margin;
#if INDEX
  uint node;
#endif
};
layout(set = 0, binding = 6, std430) buffer State { Kept state[]; };
#endif

#if METHOD == 0
#define TEST(kind, row) kind##_naive(row, ray.origin, ray.direction, best)
#define RAY NaiveRay
struct NaiveRay {
  vec3 origin, direction;
};
#else
#define TEST(kind, row) kind##_free(row, ray, best)
#define RAY FreeRay
#endif

#if INDEX
#include "index.glsl"

float inverseDistance(Found best) {
#if METHOD == 0
  return 1.0 / best.t;
#else
  return float(best.s);
#endif
}

// Two loops, so that a vector of rays tries solids when all its rays have found a leaf. Whatever outlives the inner ones
// is set before them and tested at their top: llvmpipe loses values that are first set in a loop which lanes leave apart.
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS)                                                  \
  void kind##_walk(uint end, uint firstRow, RAY ray, BoxRay boxes, inout uint node, inout uint steps,          \
                   inout Found best) {                                                                         \
    while (node < end && steps < STEPS) {                                                                      \
      float limit = limitOf(inverseDistance(best), boxes);                                                     \
      uint leaf = 0u;                                                                                          \
      while (leaf == 0u && node < end && steps < STEPS) {                                                      \
        step(boxes, limit, node, leaf);                                                                        \
        ++steps;                                                                                               \
      }                                                                                                        \
      uint row = firstRow + (leaf >> 4) * WORLD_ROWS, left = leaf & 15u;                                       \
      while (left > 0u) {                                                                                      \
        TEST(kind, row);                                                                                       \
        row += WORLD_ROWS;                                                                                     \
        --left;                                                                                                \
      }                                                                                                        \
      steps += leaf & 15u;                                                                                     \
    }                                                                                                          \
  }
#include "solids.def"
#undef SOLID
#endif

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= portion.rays) return;
  QueryRay given = rays[i];
#if METHOD == 0
  NaiveRay ray = NaiveRay(given.origin.xyz, given.direction.xyz);
  Nearest best = Nearest(given.origin.w, 0.0, -1.0);
#else
  FreeRay ray;
  ray.origin = real3(given.origin.xyz);
  ray.direction = real3(given.direction.xyz);
  ray.squared = dot3(ray.direction, ray.direction);
  ray.reach = length3(ray.origin);
  Best best = noHit();
  best.s = quotient(number(1.0), number(given.origin.w));  // t < tMax; 0 for an infinite one
#endif
#if STORAGE
  if ((portion.stage & 1u) == 0u) {
    Kept k = state[i];
#if METHOD == 0
    best = Nearest(k.s, k.cosine, k.index);
#elif METHOD == 2
    best = Best(k.s, k.cosine, k.index, k.second, k.margin);
#else
    best = Best(k.s, k.cosine, k.index);
#endif
  }
#endif

#if INDEX
  uint node = (portion.stage & 1u) == 0u ? state[i].node : 0u, steps = 0u;
  BoxRay boxes = boxRay(i, given.origin.xyz);
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  if (KIND##_COUNT > 0u) kind##_walk(portion.count[NUMBER], portion.firstRow[NUMBER], ray, boxes, node, steps, best);
#include "solids.def"
#undef SOLID
  uint end = 0u;
  for (int k = 0; k < 7; ++k) end = max(end, portion.count[k]);
  bool through = node >= end;
  if (!through) unfinished = 1u;
#else
  bool through = (portion.stage & 2u) != 0u;
  uint next = 0u;
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  if (KIND##_COUNT > 0u) {                                    \
    uint at = FIRST_ROW(NUMBER, next);                        \
    for (uint j = 0u; j < COUNT(NUMBER, KIND); ++j) {         \
      TEST(kind, at);                                         \
      at += WORLD_ROWS;                                       \
    }                                                         \
    next = at;                                                \
  }
#include "solids.def"
#undef SOLID
#endif

#if STORAGE
#if INDEX
  state[i].node = node;
#endif
  if (!through) {
    state[i].cosine = best.cosine;
    state[i].index = best.index;
#if METHOD == 0
    state[i].s = best.t;
#else
    state[i].s = best.s;
#endif
#if METHOD == 2
    state[i].second = best.second;
    state[i].margin = best.margin;
#endif
    return;
  }
#endif

  QueryHit hit;
  hit.index = int(best.index);
#ifdef EXACT
  // NaN counts as doubt, hence the comparisons' sense. A loser too near the winner, or to tMax, leaves the order open.
  bool clear = best.margin >= real(DOUBT);
  bool order = best.second == real(0) || best.second < best.s * (real(1) - real(DOUBT));
  if (!clear || !order) hit.index = -2;
  hit.t = 0.0;
  hit.normal[0] = hit.normal[1] = hit.normal[2] = 0.0;
  hit.local = hit.position = hit.normal;
#else
  vec3 normal = vec3(0.0), local = vec3(0.0), position = vec3(0.0);
#if METHOD == 0
  hit.t = best.t;
  precise vec3 point = ray.origin + best.t * ray.direction;
#else
  hit.t = toFloat(quotient(number(1.0), best.s));
  precise vec3 point = ray.origin + ray.direction / best.s;
#endif
  if (hit.index >= 0) {
    finish(vec3(0.0), real3(point), real3(given.direction.xyz), toFloat(best.cosine), uint(hit.index), normal, local,
           position);
  }
  for (int c = 0; c < 3; ++c) {
    hit.normal[c] = normal[c];
    hit.local[c] = local[c];
    hit.position[c] = position[c];
  }
#endif
  hits[i] = hit;
}
