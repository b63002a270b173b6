// The walk through an index (host/cast/index.h): boxes in boxes, the nearer child first, no stack.
//
// Conservative. With m the ray's power of two (indexRay()), a box's bounds are reached at t m = (bound - o) times `near` or
// `far`, whose margins of 2^-22 cover the roundings of the difference, the factor and the product, 2^-24 each: what is
// calculated as `enter` is at most the truth, as `leave` at least. So a ray that meets a box never passes it by. Boxes have
// 2^-100 to spare on each side, so that denormal results (|bound - o| < 2^-125) cannot put enter and leave in the wrong
// order. NaN (0 times infinity: the origin on a face, the axis out of the ray's reach) decides nothing.
//
// A box is also passed by where it begins behind the best hit so far: enter s m > BEYOND, s being right to 2^-24, and, for
// `exact`, to half the gap that it asks of the second best: what may be in doubt is tried. s is cut at 2^100, so that
// the product cannot overflow where `enter` is small. In fp32 (naive, fast), t itself may be off: 2^-10.
#ifndef SOLIDCAST_INDEX
#define SOLIDCAST_INDEX

struct Node {
  uvec4 lo, hi;  // as bits of floats, and: 4 * upper child + axis, 16 * place + number of solids (0: no leaf)
};
struct IndexRay {
  vec4 near, far;  // and in near.w what brings s to their units
};
layout(set = 0, binding = 0, std430) readonly buffer Nodes { Node nodes[]; };
layout(set = 0, binding = 8, std430) readonly buffer Skips { uint skips[]; };  // by octant: the node after all below
layout(set = 0, binding = 4, std430) readonly buffer IndexRays { IndexRay indexRays[]; };
layout(set = 0, binding = 5, std430) buffer Unfinished { uint unfinished; };  // 1: some ray is not through

// Of one invocation and dispatch. Two steps, a node and a solid, take up to five rounds of loops, and a vector's rounds are
// at most the sum of its lanes': 16 lanes stay below 65535.
const uint STEPS = 1600u;

#if METHOD == 2
#define BEYOND (1.0 + 3.0e-5 + 2.0 * DOUBT)
#else
#define BEYOND (1.0 + 1.0e-3)
#endif

struct BoxRay {
  vec3 origin, near, far;
  bvec3 ahead;  // where the lower bound is the nearer one
  float toUnits;
  uint octant;
};

BoxRay boxRay(uint i, vec3 origin) {
  IndexRay r = indexRays[i];
  bvec3 ahead = greaterThan(r.near.xyz, vec3(0.0));
  uint octant = (ahead.x ? 0u : 1u) | (ahead.y ? 0u : 2u) | (ahead.z ? 0u : 4u);
  return BoxRay(origin, r.near.xyz, r.far.xyz, ahead, r.near.w, octant);
}

float limitOf(float s, BoxRay ray) {
  precise float inUnits = s * ray.toUnits;
  return inUnits < 1.0e30 ? inUnits : 1.0e30;
}

// From `node` to the next; `leaf` is the node's own where it is one that the ray meets.
void step(BoxRay ray, float limit, inout uint node, inout uint leaf) {
  Node n = nodes[node];
  vec3 lo = uintBitsToFloat(n.lo.xyz), hi = uintBitsToFloat(n.hi.xyz);
  precise vec3 first = (mix(hi, lo, ray.ahead) - ray.origin) * ray.near;
  precise vec3 second = (mix(lo, hi, ray.ahead) - ray.origin) * ray.far;
  float enter = 0.0, leave = 3.0e38;
  enter = first.x > enter ? first.x : enter;
  enter = first.y > enter ? first.y : enter;
  enter = first.z > enter ? first.z : enter;
  leave = second.x < leave ? second.x : leave;
  leave = second.y < leave ? second.y : leave;
  leave = second.z < leave ? second.z : leave;
  precise float part = enter * limit;
  bool met = enter <= leave && !(part > BEYOND);
  leaf = met ? n.hi.w : 0u;
  bool upperFirst = ((ray.octant >> (n.lo.w & 3u)) & 1u) != 0u;
  uint child = upperFirst ? n.lo.w >> 2 : node + 1u;
  uint skip = skips[8u * node + ray.octant];
  node = met && n.hi.w == 0u ? child : skip;
}
#endif
