#version 450
// Primary rays of a camera: search, integrate, store. One invocation does several neighbouring pixels of a row (RAYS), so
// that one load of a solid, and the part of its forms that is the row's, serve them all.
//
// Written so that llvmpipe compiles it well (docs/performance-notes.md has what each of these is worth):
//  - No branch encloses a load of a uniform or push constant, not even an early return: under one it becomes a gather,
//    lane by lane. The buffers hold whole workgroups instead.
//  - Loops over the rays are unrolled, so that the rays' state lives in registers.
//  - The first value stored depends on the whole search. What only later stores need would be computed after the
//    first store's loop over the lanes, with everything it is made of kept in memory until then.
//
// Compiled in variants (shaders/CMakeLists.txt):
//   METHOD     0 naive, 1 fast, 2 exact           ARITHMETIC  of `real`, see numeric.glsl
//   CAMERA     0 perspective, 1 environment, 2 orthographic
//   STORAGE    0 records in uniform buffers, 1 in storage buffers and searched in portions
//   ADDRESS    1, with STORAGE 0: records and view by their addresses (records.glsl)
//   TURN       1 or 4, with ADDRESS 1: so many rays of an invocation at a time, the others in a loop. Less code than all at
//              once, which the driver compiles sooner and which runs slower, 1 more so than 4
//   HITS       1: also normals, local coordinates and hit points
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#if ADDRESS
#extension GL_EXT_buffer_reference : require
#endif

#if METHOD == 2
#define EXACT
#endif
#define FREE (METHOD == 0 || CAMERA == 2)  // any ray, from world records; otherwise forms prepared for the one eye
#define EYE (!FREE)
#define WORLD (FREE || HITS)

#include "search.glsl"

layout(local_size_x = 8, local_size_y = 8) in;  // 8 rows: pass.h

layout(push_constant) uniform Portion {
  uint wholeWidth, wholeHeight;  // of the whole image, in pixels
  uint firstX, firstY;           // of this band, in the whole image
  uint rows, stride;             // of this band's planes (stride in words), both in whole workgroups
  uint stage;                    // bit 0: first portion of the solids, bit 1: last
  uint sampleX, sampleY;         // which sample of every pixel
  uint tileX, tileY;             // STORAGE: first pixel of this dispatch in the band, in whole workgroups
  uint count[7], firstRow[7];    // STORAGE: this portion's solids
#if ADDRESS
  uint unused;
  Rows records, view;  // eye records, or, for free rays, world records
#endif
} portion;

#if TURN
// Under the loop llvmpipe would load lane by lane, so that all rows are loaded before it.
#if FREE
#define RAWS WORLD_RAWS
#else
#define RAWS RECORD_RAWS
#endif
real4 keptRecords[RAWS], keptView[VIEW_RAWS];
real4 viewRow(uint row) { return keptView[row]; }
real4 record(uint row) { return keptRecords[row]; }
real4 worldRecord(uint row) { return keptRecords[row]; }
#elif ADDRESS
real4 viewRow(uint row) { return ROW(portion.view.rows, row); }
real4 record(uint row) { return ROW(portion.records.rows, row); }
real4 worldRecord(uint row) { return ROW(portion.records.rows, row); }
#endif

// RAYS: of an invocation
#if TURN
const uint RAYS = 16u;
#define AT_ONCE TURN
#else
layout(constant_id = 31) const uint RAYS = 4u;  // 4, 8 or 16
#define AT_ONCE RAYS
#define STORED RAYS
#endif
#include "picture.glsl"

#if METHOD == 0
#define Found Nearest
#else
#define Found Best
#endif
#if STORAGE
struct Kept {
#if ARITHMETIC == 2
  vec4 s, rest;
  vec2 last;
#else
  real s, cosine, index, second, margin;
#endif
};
layout(set = 0, binding = 6, std430) buffer State { Kept state[]; };

Kept keep(Found found) {
#if METHOD == 0
  return Kept(found.t, found.cosine, found.index, 0.0, 0.0);
#elif ARITHMETIC == 2
  return Kept(vec4(found.s.hi, found.s.lo, found.cosine.hi, found.cosine.lo),
              vec4(found.index.hi, found.second.hi, found.second.lo, found.margin.hi), vec2(found.margin.lo, 0.0));
#elif METHOD == 2
  return Kept(found.s, found.cosine, found.index, found.second, found.margin);
#else
  return Kept(found.s, found.cosine, found.index, number(0.0), number(0.0));
#endif
}
Found kept(Kept k) {
#if METHOD == 0
  return Found(k.s, k.cosine, k.index);
#elif ARITHMETIC == 2
  return Found(real(k.s.x, k.s.y), real(k.s.z, k.s.w), number(k.rest.x), real(k.rest.y, k.rest.z),
               real(k.rest.w, k.last.x));
#elif METHOD == 2
  return Found(k.s, k.cosine, k.index, k.second, k.margin);
#else
  return Found(k.s, k.cosine, k.index);
#endif
}
#endif

// --- search -------------------------------------------------------------------------------------------------------
void search(uint column, uint row, uint pixel, out Result result[AT_ONCE]) {
  Found best[AT_ONCE];
#if METHOD == 0
  vec3 origin[AT_ONCE], direction[AT_ONCE];
#elif FREE
  FreeRay ray[AT_ONCE];
#else
  EyeRay ray[AT_ONCE];
#endif
#if METHOD != 0
  real length[AT_ONCE];  // of the direction
#endif
  UNROLL for (uint k = 0u; k < AT_ONCE; ++k) {
    CameraRay camera = cameraRay(column + k * SAMPLES, row);
#if METHOD == 0
    vec3 eye = vec3(viewRow(1u).w, viewRow(2u).w, viewRow(3u).w);
    precise vec3 from = eye + camera.origin;
    origin[k] = from;
    direction[k] = unit3(combine(camera.direction.x, camera.direction.y, camera.direction.z));
    best[k] = Nearest(3.402823466e38, 0.0, -1.0);
#elif FREE
    ray[k].origin = camera.origin;
    ray[k].direction = combine(camera.direction.x, camera.direction.y, camera.direction.z);
    ray[k].squared = dot3(ray[k].direction, ray[k].direction);
    ray[k].reach = length3(camera.origin);
#else
    ray[k].direction = camera.direction;
    ray[k].squared = linear(camera.direction, camera.direction);
    if (BOX_COUNT > 0u || HITS != 0) {
      ray[k].world = combine(camera.direction.x, camera.direction.y, camera.direction.z);
    } else {
      ray[k].world = camera.direction;
    }
#endif
#if METHOD != 0
    length[k] = root(ray[k].squared);
    best[k] = noHit();
#ifdef EXACT
    // Any start above the bound serves. This one makes the search wait for the roots: otherwise all of them come at the end,
    // one after the other, with nothing left to do beside them.
    best[k].margin = length[k];
#endif
#endif
#if STORAGE
    if ((portion.stage & 1u) == 0u) best[k] = kept(state[pixel + k]);
#endif
  }

  uint next = 0u;
#if METHOD == 0
#define TEST(kind, row) kind##_naive(row, origin[k], direction[k], best[k])
#define ROWS(EYE_ROWS, WORLD_ROWS) WORLD_ROWS
#elif FREE
#define TEST(kind, row) kind##_free(row, ray[k], best[k])
#define ROWS(EYE_ROWS, WORLD_ROWS) WORLD_ROWS
#else
#define TEST(kind, row) kind##_eye(row, ray[k], best[k])
#define ROWS(EYE_ROWS, WORLD_ROWS) EYE_ROWS
#endif
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS)                 \
  if (KIND##_COUNT > 0u) {                                                    \
    uint at = FIRST_ROW(NUMBER, next);                                        \
    for (uint i = 0u; i < COUNT(NUMBER, KIND); ++i) {                         \
      UNROLL for (uint k = 0u; k < AT_ONCE; ++k) TEST(kind, at);              \
      at += ROWS(EYE_ROWS, WORLD_ROWS);                                       \
    }                                                                         \
    next = at;                                                                \
  }
#include "solids.def"
#undef SOLID

  UNROLL for (uint k = 0u; k < AT_ONCE; ++k) {
#if STORAGE
    if ((portion.stage & 2u) == 0u) state[pixel + k] = keep(best[k]);
#endif
#if METHOD == 0
    result[k].hit = best[k].index >= 0.0;
    result[k].distance = best[k].t;
    result[k].cosine = best[k].cosine;
    result[k].index = best[k].index;
    result[k].doubtful = false;
    precise vec3 point = origin[k] + best[k].t * direction[k];
    result[k].point = point;
    result[k].direction = direction[k];
#else
    result[k] = resultOf(best[k], ray[k].squared, length[k]);
#if WORLD && FREE
    precise real3 point = ray[k].origin + ray[k].direction / best[k].s;
    result[k].point = point;
    result[k].direction = ray[k].direction;
#elif WORLD
    precise real3 point = ray[k].world / best[k].s * viewRow(0u).z;
    result[k].point = point;
    result[k].direction = ray[k].world;
#endif
#endif
  }
}

#if HITS
#include "finish.glsl"
#endif

void main() {
  uint x = gl_GlobalInvocationID.x * RAYS, y = gl_GlobalInvocationID.y;
#if STORAGE
  x += portion.tileX;
  y += portion.tileY;
#endif
  uint pixel = y * portion.stride + x;
  uint column = (portion.firstX + x) * SAMPLES + portion.sampleX, row = (portion.firstY + y) * SAMPLES + portion.sampleY;
#if TURN
  for (uint i = 0u; i < RAWS; ++i) keptRecords[i] = ROW(portion.records.rows, i);
  for (uint i = 0u; i < VIEW_RAWS; ++i) keptView[i] = ROW(portion.view.rows, i);
  [[dont_unroll]] for (uint q = 0u; q < RAYS / 4u; ++q) {
    Result result[4];
#if TURN == 1
    [[dont_unroll]] for (uint k = 0u; k < 4u; ++k) {
      Result one[1];
      search(column + (4u * q + k) * SAMPLES, row, pixel, one);
      UNROLL for (uint j = 0u; j < 4u; ++j)
        if (j == k) result[j] = one[0];
    }
#else
    search(column + 4u * q * SAMPLES, row, pixel, result);
#endif
    storeRow(pixel + 4u * q, result);
  }
#else
  Result result[RAYS];
  search(column, row, pixel, result);
#if STORAGE
  if ((portion.stage & 2u) == 0u) return;
#endif
  uint base = storeRow(pixel, result);
#if HITS
  vec3 normal[RAYS], local[RAYS], position[RAYS];
  vec3 eye = METHOD == 0 ? vec3(0.0) : vec3(viewRow(1u).w, viewRow(2u).w, viewRow(3u).w);
  UNROLL for (uint k = 0u; k < RAYS; ++k) {
    normal[k] = local[k] = position[k] = vec3(0.0);
    if (result[k].hit)
      finish(eye, result[k].point, result[k].direction, result[k].cosine, uint(result[k].index), normal[k], local[k],
             position[k]);
  }
#define STORE(bit, value)                                                        \
  if ((WANTED & bit) != 0u) {                                                    \
    for (int c = 0; c < 3; ++c) {                                                \
      EACH_FOUR {                                                                \
        vec4 v;                                                                  \
        UNROLL for (uint k = 0u; k < 4u; ++k) v[k] = value[4u * q + k][c];       \
        image[base + q] = floatBitsToUint(v);                                    \
      }                                                                          \
      base += planeSize;                                                         \
    }                                                                            \
  }
  STORE(NORMAL, normal)
  STORE(LOCAL, local)
  STORE(POSITION, position)
#endif
#endif
}
