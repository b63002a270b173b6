#version 450
// After the search, for users' own GLSL: of every pixel the ray, and of what it hit the normal, local coordinates and
// the place, all in fp32 from the distance that the search found.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#define METHOD 1
#define ARITHMETIC 0
#define STORAGE 1
#define HITS 1
#define EYE 0
#define WORLD 1
#include "custom/hits.glsl"
#include "finish.glsl"
#include "picture.glsl"

// A box's normal depends on whether the ray came from outside: then the middle of its way is outside.
bool fromInside(uint row, vec3 middle) {
  return all(greaterThan(middle, worldRecord(row).xyz)) && all(lessThan(middle, worldRecord(row + 1u).xyz));
}

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  uint x = pixel % portion.stride, y = pixel / portion.stride;
  bool inImage = x < portion.width && y < portion.height;
  CameraRay camera = cameraRay((portion.firstX + x) * SAMPLES + portion.sampleX,
                               (portion.firstY + y) * SAMPLES + portion.sampleY);
  vec3 eye = vec3(viewRow(1u).w, viewRow(2u).w, viewRow(3u).w);
  vec3 direction = unit3(combine(camera.direction.x, camera.direction.y, camera.direction.z));
  putTriple(ORIGIN_PLANE, pixel, eye + camera.origin);
  putTriple(DIRECTION_PLANE, pixel, direction);

  float t = hitsFloat(DISTANCE_PLANE, pixel);
  uint solid = hits[SOLID_PLANE * planeWords() + pixel];
  vec3 normal = vec3(0.0), local = vec3(0.0), position = vec3(0.0);
  if (!inImage) {
    hits[DISTANCE_PLANE * planeWords() + pixel] = 0u;
    hits[SOLID_PLANE * planeWords() + pixel] = NOTHING;
  } else if (solid != NOTHING) {
    precise vec3 point = camera.origin + t * direction;
    bool inside = false;
    if (BOX_IN_WORLD) {
      uvec2 place = places[solid];
      inside = place.x == 2u && fromInside(place.y, camera.origin + 0.5 * t * direction);
    }
    finish(eye, point, direction, inside ? -1.0 : 1.0, solid, normal, local, position);
  }
  putTriple(NORMAL_PLANE, pixel, normal);
  putTriple(LOCAL_PLANE, pixel, local);
  putTriple(POSITION_PLANE, pixel, position);
}
