// The distance at which a ray meets a ball, by solidcast's sphere; 0 where it misses. The including shader defines the
// rows that the sphere is read from (solidcast/hit.glsl): row 0 is its centre and radius, row 1 begins with its index.
#include "solidcast/solids/sphere.glsl"

float ballDistance(vec3 origin, vec3 direction) {
  FreeRay ray;
  ray.origin = origin;
  ray.direction = direction;
  ray.squared = dot3(direction, direction);
  ray.reach = length3(origin);
  Best best = noHit();
  sphere_free(0u, ray, best);
  return best.s > 0.0 ? 1.0 / best.s : 0.0;
}
