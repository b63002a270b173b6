#version 450
// A user's solid: intersect() is theirs. It takes the place of what was hit so far where it is nearer.
#extension GL_GOOGLE_include_directive : require
#include "custom/user.glsl"

bool intersect(Ray ray, float tMin, float tMax, Parameters p, out float t, out vec3 normal);
#include "solidcast:code"

// The part of [from, to] that lies in the bounds, a little widened: rounding must not cut off what touches them.
void clip(Ray ray, inout float from, inout float to) {
  for (int axis = 0; axis < 3; ++axis) {
    float a = (portion.low[axis] - ray.origin[axis]) / ray.direction[axis];
    float b = (portion.high[axis] - ray.origin[axis]) / ray.direction[axis];
    if (ray.direction[axis] == 0.0) {
      bool between = portion.low[axis] <= ray.origin[axis] && ray.origin[axis] <= portion.high[axis];
      a = between ? -3.4e38 : 3.4e38;
      b = -a;
    }
    float near = clamp(min(a, b), -3.0e38, 3.0e38), far = clamp(max(a, b), -3.0e38, 3.0e38);
    from = max(from, near - 1.0e-6 * abs(near));
    to = min(to, far + 1.0e-6 * abs(far));
  }
}

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  Ray ray = solidcast_ray(pixel);
  float nearest = hitsFloat(DISTANCE_PLANE, pixel);
  float from = 0.0, to = min(nearest, 3.4e38);
  if ((portion.flags & BOUNDED) != 0u) clip(ray, from, to);
  float t = 0.0;
  vec3 normal = vec3(0.0);
  bool hit = false;
  if (from < to) hit = intersect(ray, from, to, solidcast_parameters(), t, normal);
  // NaN is no hit.
  if (!(hit && t > 0.0 && t >= from && t <= to && t < nearest)) return;
  vec3 position = ray.origin + t * ray.direction;
  hits[DISTANCE_PLANE * planeWords() + pixel] = floatBitsToUint(t);
  hits[SOLID_PLANE * planeWords() + pixel] = portion.solid;
  putTriple(NORMAL_PLANE, pixel, normalize(normal));
  putTriple(LOCAL_PLANE, pixel, position);
  putTriple(POSITION_PLANE, pixel, position);
}
