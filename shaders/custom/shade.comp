#version 450
// The built-in integrators, for scenes with custom solids: a colour from what all solids together left in the planes.
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

void main() {
  uint pixel = gl_GlobalInvocationID.x;
  Result result;
  result.hit = hits[SOLID_PLANE * planeWords() + pixel] != NOTHING;
  result.distance = hitsFloat(DISTANCE_PLANE, pixel);
  result.cosine = -dot(hitsTriple(DIRECTION_PLANE, pixel), hitsTriple(NORMAL_PLANE, pixel));
  putColour(pixel, radiance(result));
}
