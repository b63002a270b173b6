// What an integrator sees of a hit, and the parameters that the scene file gives it.
#ifndef SOLIDCAST_INTEGRATOR
#define SOLIDCAST_INTEGRATOR

struct Shading {
  float cosine;    // max(0, -d.n), or |d.n| when two-sided; d and n of unit length
  float distance;  // t of the unit direction
};
struct Parameters {
  vec3 nearColor;
  float nearDist;
  vec3 farColor;
  float farDist;
};
#endif
