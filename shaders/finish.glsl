// From the solid that was hit to its normal and local coordinates: looked up once a ray, not carried in the search.
// Local coordinates are the hit point, but for triangles (weights of the vertices) and quads (u, v, 0).
#ifndef SOLIDCAST_FINISH
#define SOLIDCAST_FINISH
#include "search.glsl"

layout(set = 0, binding = 7, std430) readonly buffer Places { uvec2 places[]; };  // by index: kind, world row

// Kinds of the world; the search may cast one kind in another's form.
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  layout(constant_id = 10 + NUMBER) const bool KIND##_IN_WORLD = false;
#include "solids.def"
#undef SOLID

// `origin` is that of the world records; `point` the hit relative to it.
void finish(vec3 origin, real3 point, real3 direction, float cosine, uint index, out vec3 normal, out vec3 local,
            out vec3 position) {
  uvec2 place = places[index];
  precise vec3 at = origin + vec3(point);
  position = at;
  real3 n = real3(0), where = real3(at);
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  if (KIND##_IN_WORLD && place.x == NUMBER) kind##_finish(place.y, point, direction, real(cosine), n, where);
#include "solids.def"
#undef SOLID
  normal = vec3(n);
  local = vec3(where);
}
#endif
