// RayCastingIntegrator: grey, the cosine between the ray and the normal.
#ifndef SOLIDCAST_CASTING
#define SOLIDCAST_CASTING
#include "../integrator.glsl"

vec3 casting_radiance(Shading hit, Parameters parameters) { return vec3(hit.cosine); }
#endif
