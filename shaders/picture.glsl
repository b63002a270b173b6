// What all programs that make pictures share: what is wanted of a pixel, the camera's rays, and the integrators.
// The including shader has METHOD, CAMERA, ARITHMETIC, WORLD, records.glsl, and the push constants `portion` with the whole
// image's size (wholeWidth, wholeHeight), the planes' (stride in words, rows), and which sample is cast (sampleX, sampleY).
#ifndef SOLIDCAST_PICTURE
#define SOLIDCAST_PICTURE

#define INTEGRATOR(NUMBER, name, Type, CHANNELS) const uint name##_number = NUMBER;
#include "integrators.def"
#undef INTEGRATOR
#include "integrators/casting.glsl"
#include "integrators/castingdist.glsl"

#if ARITHMETIC == 2 || STORAGE == 3
#define UNROLL  // unrolled, double-float arithmetic takes seconds to compile, and lists.comp minutes on SwiftShader
#else
#define UNROLL [[unroll]]
#endif

// --- what is wanted (specialisation) --------------------------------------------------------------------------------
layout(constant_id = 24) const uint INTEGRATOR_NUMBER = 0u;
layout(constant_id = 25) const bool TWO_SIDED = false;
layout(constant_id = 26) const uint SAMPLES = 1u;     // per pixel and axis
layout(constant_id = 27) const uint WANTED = 1u;      // bits: rgb8, radiance, distance, solid, normal, local, position
layout(constant_id = 28) const float DOUBT = 0.0;     // the bound of decided() and decidedAgainst()
layout(constant_id = 29) const bool HITS_IN_DOUBT = false;  // arithmetic too coarse for t: all hits to the second pass
layout(constant_id = 36) const bool GREY = false;  // rgb8: a byte a pixel, in the first quarter of the plane
#define RGB8 1u
#define RADIANCE 2u
#define DISTANCE 4u
#define SOLID_INDEX 8u
#define NORMAL 16u
#define LOCAL 32u
#define POSITION 64u

#if !ADDRESS
layout(set = 0, binding = 2, std140) uniform View { RAW view[VIEW_RAWS]; };
real4 viewRow(uint row) { return ROW(view, row); }
#endif

layout(set = 0, binding = 3, std430) buffer Image { uvec4 image[]; };

#ifdef EXACT
layout(set = 0, binding = 4, std430) buffer Doubts {  // rays for the second pass
  uint doubtCount;
  uint doubtCapacity;
  uint doubts[];  // pixel / 8 in the buffers' grid, times 256, plus a bit for each of the eight
};
#endif
#if CAMERA == 1
// cos and sin of the longitude of each column, then of the latitude of each row, in the grid of samples.
layout(set = 0, binding = 5, std430) readonly buffer Angles { RAW angles[]; };
#endif

// --- what all pixels share, loaded before any loop -------------------------------------------------------------------
uint gridColumns = portion.wholeWidth * SAMPLES, gridRows = portion.wholeHeight * SAMPLES;  // of the whole image's samples
uint planeSize = portion.stride * portion.rows / 4u;                                        // in fours of words
bool otherSamples = SAMPLES > 1u && (portion.sampleX | portion.sampleY) != 0u;
#ifdef EXACT
uint capacity = doubtCapacity;
#endif

// --- rays -----------------------------------------------------------------------------------------------------------
// Place of a sample on the whole image's grid of samples, from its middle: exact in fp32 up to 2^23 samples a side.
float gridX(uint column) { return 0.5 * float(int(2u * column + 1u) - int(gridColumns)); }
float gridY(uint row) { return 0.5 * float(int(gridRows) - int(2u * row + 1u)); }

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
  real4 lon = ROW(angles, column < gridColumns ? column : gridColumns - 1u);  // beyond them: buffer's margin
  real4 lat = ROW(angles, gridColumns + (row < gridRows ? row : gridRows - 1u));
  ray.direction = real3(mul(lat.x, lon.y), lat.y, negate(mul(lat.x, lon.x)));
#else
  ray.origin = combine(mul(number(gridX(column)), step.x), mul(number(gridY(row)), step.y), number(0.0));
  ray.direction = real3(number(0.0), number(0.0), number(-1.0));
#endif
  return ray;
}

// --- radiance -----------------------------------------------------------------------------------------------------
struct Result {
  float distance;  // t of the unit direction
  float cosine;
  float index;
  bool hit, doubtful;
#if WORLD
  real3 point, direction;  // the hit relative to the records' origin, and the ray, in world axes
#endif
};

#if METHOD != 0
Result resultOf(Best best, real squared, real length) {  // of the ray's direction
  Result result;
  // The first value stored has to depend on the whole search, index included where it is wanted.
  result.hit = (WANTED & SOLID_INDEX) != 0u ? atLeast(best.index, number(0.0)) : less(number(0.0), best.s);
  result.distance = toFloat(mul(quotient(length, best.s), viewRow(0u).z));
  // Rounded once, as the second pass rounds it: which rays are in doubt must not show.
  result.cosine = toFloat(quotient(best.cosine, length));
  result.index = toFloat(best.index);
  result.doubtful = false;
#ifdef EXACT
  // NaN in the margin counts as doubt, hence atLeast() and not less().
  bool clear = atLeast(best.margin, mul(squared, number(DOUBT)));
  bool order = less(best.second, mul(best.s, sub(number(1.0), number(1.0 / 33554432.0)))) || !result.hit;
  result.doubtful = !(clear && order) || (HITS_IN_DOUBT && result.hit);
#endif
  return result;
}
#endif

vec3 radiance(Result result) {  // of a ray that hits
  Shading shading;
  shading.distance = result.distance;
  shading.cosine = TWO_SIDED ? abs(result.cosine) : result.cosine > 0.0 ? result.cosine : 0.0;
  real4 near = viewRow(4u), far = viewRow(5u);
  Parameters parameters = Parameters(vec3(toFloat(near.x), toFloat(near.y), toFloat(near.z)), toFloat(near.w),
                                     vec3(toFloat(far.x), toFloat(far.y), toFloat(far.z)), toFloat(far.w));
  vec3 colour = vec3(0.0);
#define INTEGRATOR(NUMBER, name, Type, CHANNELS) \
  if (INTEGRATOR_NUMBER == name##_number) colour = name##_radiance(shading, parameters);
#include "integrators.def"
#undef INTEGRATOR
  return colour;
}

uint level(float v) {
  float atLeast0 = v > 0.0 ? v : 0.0;  // each one instruction, unlike nested selections
  precise float scaled = (atLeast0 < 1.0 ? atLeast0 : 1.0) * 255.0;
  return uint(scaled);
}

// --- storing --------------------------------------------------------------------------------------------------------
// Stores this many neighbours of a row, the first of them at `pixel` of the planes, with their doubts. Gives the place in
// the plane after the last one stored (of the first four of them).
#ifndef STORED
#define STORED 4u
#endif
#define EACH_FOUR UNROLL for (uint q = 0u; q < STORED / 4u; ++q)

uint storeRow(uint pixel, inout Result result[STORED]) {
  uint base = pixel / 4u;
#ifdef EXACT
  uint doubtful[(STORED + 7u) / 8u];
  UNROLL for (uint e = 0u; e < (STORED + 7u) / 8u; ++e) doubtful[e] = 0u;
#endif
  vec3 colour[STORED];
  UNROLL for (uint k = 0u; k < STORED; ++k) {
#ifdef EXACT
    doubtful[k / 8u] |= result[k].doubtful ? 1u << (k % 8u) : 0u;
    result[k].hit = result[k].hit && !result[k].doubtful;  // the second pass adds it
#endif
    colour[k] = radiance(result[k]);
  }

  if ((WANTED & RGB8) != 0u && GREY) {
    // Stores are what is left of a small scene's time on llvmpipe, which does them word by word and lane by lane.
    uint four[STORED / 4u];
    EACH_FOUR {
      bool some = false;
      uint bytes = 0u;
      UNROLL for (uint k = 0u; k < 4u; ++k) {
        Result r = result[4u * q + k];
        bytes |= (r.hit ? level(colour[4u * q + k].r) : 0u) << (8u * k);
        some = some || r.hit;
      }
      four[q] = some ? bytes : 0u;  // a selection last, as below
    }
    if (STORED >= 16u) {
      UNROLL for (uint q = 0u; q < STORED / 4u; q += 4u)
        image[base / 4u + q / 4u] = uvec4(four[q], four[q + 1u], four[q + 2u], four[q + 3u]);
    } else {
      EACH_FOUR image[base / 4u][base % 4u + q] = four[q];
    }
    base += planeSize;
  } else if ((WANTED & RGB8) != 0u) {
    EACH_FOUR {
      uvec4 packed;
      UNROLL for (uint k = 0u; k < 4u; ++k) {
        vec3 c = colour[4u * q + k];
        // The selection comes last: LLVM moves conversions and shifts into the store's loop over the lanes.
        packed[k] = result[4u * q + k].hit ? level(c.r) | level(c.g) << 8 | level(c.b) << 16 : 0u;
      }
      image[base + q] = packed;
    }
    base += planeSize;
  }
  if ((WANTED & RADIANCE) != 0u) {
    for (int c = 0; c < 3; ++c) {
      EACH_FOUR {
        precise vec4 sum;
        UNROLL for (uint k = 0u; k < 4u; ++k) sum[k] = result[4u * q + k].hit ? colour[4u * q + k][c] : 0.0;
        if (otherSamples) sum += uintBitsToFloat(image[base + q]);
        image[base + q] = floatBitsToUint(sum);  // of all samples; the host divides
      }
      base += planeSize;
    }
  }
  if ((WANTED & DISTANCE) != 0u) {
    EACH_FOUR {
      vec4 t;
      UNROLL for (uint k = 0u; k < 4u; ++k)
        t[k] = result[4u * q + k].hit ? result[4u * q + k].distance : uintBitsToFloat(0x7f800000u);
      image[base + q] = floatBitsToUint(t);
    }
    base += planeSize;
  }
  if ((WANTED & SOLID_INDEX) != 0u) {
    EACH_FOUR {
      uvec4 index;
      UNROLL for (uint k = 0u; k < 4u; ++k)
        index[k] = result[4u * q + k].hit ? uint(result[4u * q + k].index) : 0xffffffffu;
      image[base + q] = index;
    }
    base += planeSize;
  }
#ifdef EXACT
  UNROLL for (uint e = 0u; e < (STORED + 7u) / 8u; ++e)
    if (doubtful[e] != 0u) {
      uint place = atomicAdd(doubtCount, 1u);
      if (place < capacity) doubts[place] = (pixel / 8u + e) << 8 | doubtful[e] << (pixel & 4u);
    }
#endif
  return base;
}
#endif
