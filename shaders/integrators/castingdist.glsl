// RayCastingDistIntegrator: the cosine times a colour that goes from near to far with the distance, clamped.
#ifndef SOLIDCAST_CASTINGDIST
#define SOLIDCAST_CASTINGDIST
#include "../integrator.glsl"

vec3 castingdist_radiance(Shading hit, Parameters parameters) {
  precise float part = (hit.distance - parameters.nearDist) / (parameters.farDist - parameters.nearDist);
  part = part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
  precise vec3 colour = (parameters.nearColor + part * (parameters.farColor - parameters.nearColor)) * hit.cosine;
  return colour;
}
#endif
