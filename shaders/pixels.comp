#version 450
// Primary rays of a camera: search, integrate, store. One invocation does four neighbouring pixels of a row, so that
// one load of a solid serves four rays.
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
//   HITS       1: also normals, local coordinates and hit points
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#if METHOD == 2
#define EXACT
#endif
#define FREE (METHOD == 0 || CAMERA == 2)  // any ray, from world records; otherwise forms prepared for the one eye
#define EYE (!FREE)
#define WORLD (FREE || HITS)

#include "search.glsl"

layout(local_size_x = 16, local_size_y = 4) in;

#define INTEGRATOR(NUMBER, name, Type) const uint name##_number = NUMBER;
#include "integrators.def"
#undef INTEGRATOR
#include "integrators/casting.glsl"
#include "integrators/castingdist.glsl"

// --- what is wanted (specialisation) and where (push constants) --------------------------------------------------
layout(constant_id = 24) const uint INTEGRATOR_NUMBER = 0u;
layout(constant_id = 25) const bool TWO_SIDED = false;
layout(constant_id = 26) const uint SAMPLES = 1u;     // per pixel and axis
layout(constant_id = 27) const uint WANTED = 1u;      // bits: rgb8, radiance, distance, solid, normal, local, position
layout(constant_id = 28) const float DOUBT = 0.0;     // the bound of decided() and decidedAgainst()
layout(constant_id = 29) const bool HITS_IN_DOUBT = false;  // arithmetic too coarse for t: all hits to the second pass
#define RGB8 1u
#define RADIANCE 2u
#define DISTANCE 4u
#define SOLID_INDEX 8u
#define NORMAL 16u
#define LOCAL 32u
#define POSITION 64u

layout(push_constant) uniform Portion {
  uint wholeWidth, wholeHeight;  // of the whole image, in pixels
  uint firstX, firstY;           // of this band, in the whole image
  uint rows, stride;             // of this band's planes (stride in words), both in whole workgroups
  uint stage;                    // bit 0: first portion of the solids, bit 1: last
  uint sampleX, sampleY;         // which sample of every pixel
  uint tileX, tileY;             // STORAGE: first pixel of this dispatch in the band, in whole workgroups
  uint count[7], firstRow[7];    // STORAGE: this portion's solids
} portion;

layout(set = 0, binding = 2, std140) uniform View { RAW view[VIEW_RAWS]; };
real4 viewRow(uint row) { return ROW(view, row); }

layout(set = 0, binding = 3, std430) buffer Image { uvec4 image[]; };

#ifdef EXACT
layout(set = 0, binding = 4, std430) buffer Doubts {  // rays for the second pass
  uint doubtCount;
  uint doubtCapacity;
  uint doubts[];  // pixel / 4 in the buffers' grid, times 16, plus a bit for each of the four
};
#endif
#if CAMERA == 1
// cos and sin of the longitude of each column, then of the latitude of each row, in the grid of samples.
layout(set = 0, binding = 5, std430) readonly buffer Angles { RAW angles[]; };
#endif

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

// --- rays ---------------------------------------------------------------------------------------------------------
// Place of a sample on the whole image's grid of samples, from its middle: exact in fp32 up to 2^23 samples a side.
float gridX(uint column) { return 0.5 * float(int(2u * column + 1u) - int(portion.wholeWidth * SAMPLES)); }
float gridY(uint row) { return 0.5 * float(int(portion.wholeHeight * SAMPLES) - int(2u * row + 1u)); }

struct CameraRay {
  real3 origin, direction;  // orthographic: origin relative to the camera's centre, world axes; else camera axes
};

#if ARITHMETIC == 2
real3 combine(real x, real y, real z) {  // x right + y upward + z backward
  real4 r = viewRow(1u), u = viewRow(2u), b = viewRow(3u);
  return real3(add(mul(x, r.x), add(mul(y, u.x), mul(z, b.x))), add(mul(x, r.y), add(mul(y, u.y), mul(z, b.y))),
               add(mul(x, r.z), add(mul(y, u.z), mul(z, b.z))));
}
#else
real3 combine(real x, real y, real z) {
  precise real3 r = viewRow(1u).xyz * x + (viewRow(2u).xyz * y + viewRow(3u).xyz * z);
  return r;
}
#endif

CameraRay cameraRay(uint column, uint row) {
  CameraRay ray;
  real4 step = viewRow(0u);
  ray.origin = real3(number(0.0), number(0.0), number(0.0));
#if CAMERA == 0
  ray.direction = real3(mul(number(gridX(column)), step.x), mul(number(gridY(row)), step.y), number(-1.0));
#elif CAMERA == 1
  uint columns = portion.wholeWidth * SAMPLES, lines = portion.wholeHeight * SAMPLES;  // beyond them: buffer's margin
  real4 lon = ROW(angles, column < columns ? column : columns - 1u);
  real4 lat = ROW(angles, columns + (row < lines ? row : lines - 1u));
  ray.direction = real3(mul(lat.x, lon.y), lat.y, negate(mul(lat.x, lon.x)));
#else
  ray.origin = combine(mul(number(gridX(column)), step.x), mul(number(gridY(row)), step.y), number(0.0));
  ray.direction = real3(number(0.0), number(0.0), number(-1.0));
#endif
  return ray;
}

// --- search -------------------------------------------------------------------------------------------------------
struct Result {
  float distance;  // t of the unit direction
  float cosine;
  float index;
  bool hit, doubtful;
#if WORLD
  real3 point, direction;  // the hit relative to the records' origin, and the ray, in world axes
#endif
};

#define RAYS 4
#if ARITHMETIC == 2
#define UNROLL  // unrolled, double-float arithmetic takes seconds to compile
#else
#define UNROLL [[unroll]]
#endif

void search(const uint column[RAYS], uint row, uint pixel, out Result result[RAYS]) {
  Found best[RAYS];
#if METHOD == 0
  vec3 origin[RAYS], direction[RAYS];
#elif FREE
  FreeRay ray[RAYS];
#else
  EyeRay ray[RAYS];
#endif
  UNROLL for (int k = 0; k < RAYS; ++k) {
    CameraRay camera = cameraRay(column[k], row);
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
    best[k] = noHit();
#else
    ray[k].direction = camera.direction;
    ray[k].squared = linear(camera.direction, camera.direction);
    if (BOX_COUNT > 0u || HITS != 0) {
      ray[k].world = combine(camera.direction.x, camera.direction.y, camera.direction.z);
    } else {
      ray[k].world = camera.direction;
    }
    best[k] = noHit();
#endif
#if STORAGE
    if ((portion.stage & 1u) == 0u) best[k] = kept(state[pixel + uint(k)]);
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
      UNROLL for (int k = 0; k < RAYS; ++k) TEST(kind, at);                          \
      at += ROWS(EYE_ROWS, WORLD_ROWS);                                       \
    }                                                                         \
    next = at;                                                                \
  }
#include "solids.def"
#undef SOLID

  UNROLL for (int k = 0; k < RAYS; ++k) {
#if STORAGE
    if ((portion.stage & 2u) == 0u) state[pixel + uint(k)] = keep(best[k]);
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
    result[k].hit = atLeast(best[k].index, number(0.0));  // as s > 0, but see above for the first value stored
    result[k].distance = toFloat(mul(quotient(root(ray[k].squared), best[k].s), viewRow(0u).z));
    precise float cosine = toFloat(best[k].cosine) / sqrt(toFloat(ray[k].squared));
    result[k].cosine = cosine;
    result[k].index = toFloat(best[k].index);
    result[k].doubtful = false;
#ifdef EXACT
    // NaN in the margin counts as doubt, hence atLeast() and not less().
    bool clear = atLeast(best[k].margin, mul(ray[k].squared, number(DOUBT)));
    bool order = less(best[k].second, mul(best[k].s, sub(number(1.0), number(1.0 / 33554432.0)))) || !result[k].hit;
    result[k].doubtful = !(clear && order) || (HITS_IN_DOUBT && result[k].hit);
#endif
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

// --- radiance -----------------------------------------------------------------------------------------------------
vec3 radiance(Result result) {
  Shading shading;
  shading.distance = result.distance;
  shading.cosine = TWO_SIDED ? abs(result.cosine) : result.cosine > 0.0 ? result.cosine : 0.0;
  real4 near = viewRow(4u), far = viewRow(5u);
  Parameters parameters = Parameters(vec3(toFloat(near.x), toFloat(near.y), toFloat(near.z)), toFloat(near.w),
                                     vec3(toFloat(far.x), toFloat(far.y), toFloat(far.z)), toFloat(far.w));
  vec3 colour = vec3(0.0);
#define INTEGRATOR(NUMBER, name, Type) \
  if (INTEGRATOR_NUMBER == name##_number) colour = name##_radiance(shading, parameters);
#include "integrators.def"
#undef INTEGRATOR
  return mix(vec3(0.0), colour, bvec3(result.hit));
}

uint level(float v) {
  precise float scaled = (v < 0.0 ? 0.0 : v > 1.0 ? 1.0 : v) * 255.0;
  return uint(scaled);
}

#if HITS
#include "finish.glsl"
#endif

void main() {
  uint x = gl_GlobalInvocationID.x * 4u, y = gl_GlobalInvocationID.y;
#if STORAGE
  x += portion.tileX;
  y += portion.tileY;
#endif
  uint pixel = y * portion.stride + x;
  uint base = pixel / 4u, plane = portion.stride * portion.rows / 4u;
  bool otherSamples = SAMPLES > 1u && (portion.sampleX | portion.sampleY) != 0u;
#ifdef EXACT
  uint four = base, capacity = doubtCapacity;
#endif

  uint column[RAYS];
  UNROLL for (int k = 0; k < RAYS; ++k) column[k] = (portion.firstX + x + uint(k)) * SAMPLES + portion.sampleX;
  Result result[RAYS];
  search(column, (portion.firstY + y) * SAMPLES + portion.sampleY, pixel, result);
#if STORAGE
  if ((portion.stage & 2u) == 0u) return;
#endif
  vec3 colour[RAYS];
  uint doubtful = 0u;
  UNROLL for (int k = 0; k < RAYS; ++k) {
#ifdef EXACT
    doubtful |= result[k].doubtful ? 1u << k : 0u;
    result[k].hit = result[k].hit && !result[k].doubtful;  // the second pass adds it
#endif
    colour[k] = radiance(result[k]);
  }

  if ((WANTED & RGB8) != 0u) {
    uvec4 packed;
    UNROLL for (int k = 0; k < RAYS; ++k)
      packed[k] = level(colour[k].r) | level(colour[k].g) << 8 | level(colour[k].b) << 16;
    image[base] = packed;
    base += plane;
  }
  if ((WANTED & RADIANCE) != 0u) {
    for (int c = 0; c < 3; ++c) {
      precise vec4 sum = vec4(colour[0][c], colour[1][c], colour[2][c], colour[3][c]);
      if (otherSamples) sum += uintBitsToFloat(image[base]);
      image[base] = floatBitsToUint(sum);  // of all samples; the host divides
      base += plane;
    }
  }
  if ((WANTED & DISTANCE) != 0u) {
    vec4 t;
    UNROLL for (int k = 0; k < RAYS; ++k) t[k] = result[k].hit ? result[k].distance : uintBitsToFloat(0x7f800000u);
    image[base] = floatBitsToUint(t);
    base += plane;
  }
  if ((WANTED & SOLID_INDEX) != 0u) {
    uvec4 index;
    UNROLL for (int k = 0; k < RAYS; ++k) index[k] = result[k].hit ? uint(result[k].index) : 0xffffffffu;
    image[base] = index;
    base += plane;
  }
#ifdef EXACT
  if (doubtful != 0u) {
    uint place = atomicAdd(doubtCount, 1u);
    if (place < capacity) doubts[place] = four << 4 | doubtful;
  }
#endif
#if HITS
  vec3 normal[RAYS], local[RAYS], position[RAYS];
  vec3 eye = METHOD == 0 ? vec3(0.0) : vec3(viewRow(1u).w, viewRow(2u).w, viewRow(3u).w);
  UNROLL for (int k = 0; k < RAYS; ++k) {
    normal[k] = local[k] = position[k] = vec3(0.0);
    if (result[k].hit)
      finish(eye, result[k].point, result[k].direction, result[k].cosine, uint(result[k].index), normal[k], local[k],
             position[k]);
  }
#define STORE(bit, value)                                                                                 \
  if ((WANTED & bit) != 0u) {                                                                             \
    for (int c = 0; c < 3; ++c) {                                                                         \
      image[base] = floatBitsToUint(vec4(value[0][c], value[1][c], value[2][c], value[3][c]));            \
      base += plane;                                                                                      \
    }                                                                                                     \
  }
  STORE(NORMAL, normal)
  STORE(LOCAL, local)
  STORE(POSITION, position)
#endif
}
