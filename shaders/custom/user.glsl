// What users' own GLSL sees (docs/custom-glsl.md), and what stands guard over it.
#ifndef SOLIDCAST_CUSTOM_USER
#define SOLIDCAST_CUSTOM_USER
#include "custom/hits.glsl"

struct Ray {
  vec3 origin;
  vec3 direction;  // of length 1
};
struct Hit {
  float distance;  // along the ray
  float cosine;    // of the angle between the normal and the way back along the ray; not negative when two-sided
  vec3 normal;     // of length 1
  vec3 local;      // local coordinates: the weights of a triangle's vertices, u and v of a quad, else the position
  vec3 position;
  uint solid;      // its index, as query and --aov solid count
};

// Every loop of users' code asks here before each round (host/cast/loop_guard.h writes the calls). lavapipe ends all
// loops of an invocation after 65535 rounds, counted over the eight lanes that run together, and says nothing; a GPU
// hangs. Eight lanes of 8191 rounds stay below.
#define SOLIDCAST_ROUNDS 8191u
uint solidcast_rounds = 0u;
bool solidcast_guard(uint place) {
  bool more = solidcast_rounds < SOLIDCAST_ROUNDS;
  if (solidcast_rounds == SOLIDCAST_ROUNDS) atomicMin(endlessLoop, portion.program << 22 | place);
  ++solidcast_rounds;
  return more;
}

layout(set = 0, binding = 0, std140) uniform Values { vec4 solidcast_values[VALUES]; };
#include "solidcast:parameters"  // struct Parameters, and solidcast_parameters() out of Values

Ray solidcast_ray(uint pixel) {
  return Ray(hitsTriple(ORIGIN_PLANE, pixel), hitsTriple(DIRECTION_PLANE, pixel));
}
#endif
