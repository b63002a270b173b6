#version 450
// Free rays: each with its own origin, one an invocation.
//
// METHOD 0 naive and 1 fast give the whole hit. METHOD 2 exact gives the solid, or that it is in doubt: t, normal and
// local coordinates of that one solid are the host's, in binary128 (a query's text costs more than they do), and so
// is the whole search for the few rays in doubt.
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
  uint count[7], firstRow[7];
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
};
layout(set = 0, binding = 6, std430) buffer State { Kept state[]; };
#endif

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= portion.rays) return;
  QueryRay given = rays[i];
#if METHOD == 0
  vec3 origin = given.origin.xyz, direction = given.direction.xyz;
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

  uint next = 0u;
#if METHOD == 0
#define TEST(kind, row) kind##_naive(row, origin, direction, best)
#else
#define TEST(kind, row) kind##_free(row, ray, best)
#endif
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

#if STORAGE
  if ((portion.stage & 2u) == 0u) {
#if METHOD == 0
    state[i] = Kept(best.t, best.cosine, best.index, 0.0, 0.0);
#elif METHOD == 2
    state[i] = Kept(best.s, best.cosine, best.index, best.second, best.margin);
#else
    state[i] = Kept(best.s, best.cosine, best.index, number(0.0), number(0.0));
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
  precise vec3 point = origin + best.t * direction;
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
