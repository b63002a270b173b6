#version 450
// A user's integrator: radiance() is theirs.
#extension GL_GOOGLE_include_directive : require
#include "custom/user.glsl"

vec3 radiance(Hit hit, Ray ray, Parameters p);
#include "solidcast:code"

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  Ray ray = solidcast_ray(pixel);
  Hit hit;
  hit.distance = hitsFloat(DISTANCE_PLANE, pixel);
  hit.normal = hitsTriple(NORMAL_PLANE, pixel);
  hit.local = hitsTriple(LOCAL_PLANE, pixel);
  hit.position = hitsTriple(POSITION_PLANE, pixel);
  hit.solid = hits[SOLID_PLANE * planeWords() + pixel];
  hit.cosine = -dot(hit.normal, ray.direction);
  if ((portion.flags & TWO_SIDED_FLAG) != 0u) hit.cosine = abs(hit.cosine);
  vec3 colour = vec3(0.0);
  if (hit.solid != NOTHING) colour = radiance(hit, ray, solidcast_parameters());
  putColour(pixel, colour);
}
