// The loops over a scene's solids, kind by kind. A kind that the scene lacks has a count of 0, a specialisation
// constant, and its loop and code vanish from the pipeline (llvmpipe would run a branch never taken).
//
// Uniform scenes know their counts when the pipeline is made. Storage scenes get them with each dispatch, in portions
// of at most 32768 solids: llvmpipe cuts a loop after 65535 rounds without a word.
#ifndef SOLIDCAST_SEARCH
#define SOLIDCAST_SEARCH
#include "records.glsl"

#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  layout(constant_id = NUMBER) const uint KIND##_COUNT = 0u;
#include "solids.def"
#undef SOLID

layout(constant_id = 23) const bool BOX_FACE_PLANE = false;  // some box has the eye on the plane of a face
#define BOX_FACE BOX_FACE_PLANE
layout(constant_id = 30) const bool SOME_GRAZE = false;  // some flat solid is seen at too flat an angle
#define GRAZING SOME_GRAZE
layout(constant_id = 35) const bool SOME_FAR_SPHERE = false;  // fast: fp32 needs the careful discriminant
#define FAR_SPHERES SOME_FAR_SPHERE
layout(constant_id = 32) const bool SOME_TIE = true;  // solids of several kinds share a plane or a surface
#define TIES SOME_TIE

#include "hit.glsl"
#include "solids/plane.glsl"
#include "solids/sphere.glsl"
#include "solids/box.glsl"
#include "solids/disc.glsl"
#include "solids/triangle.glsl"
#include "solids/quad.glsl"
#include "solids/quadric.glsl"

#if STORAGE
#define COUNT(NUMBER, KIND) portion.count[NUMBER]
#define FIRST_ROW(NUMBER, ROW) portion.firstRow[NUMBER]
#else
#define COUNT(NUMBER, KIND) KIND##_COUNT
#define FIRST_ROW(NUMBER, ROW) ROW
#endif

#endif
