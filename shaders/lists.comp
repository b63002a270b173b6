#version 450
// Primary rays by lists: an invocation owns a tile of 4x4 pixels and walks the tile's own lists of solids, so that one
// load of a record serves sixteen rays. The host makes the lists (host/cast/list_build.h): a list a kind, and of each
// kind two, the solids of the wide tile that this one lies in (they are seen large) and its own.
//
// Compiled in variants (shaders/CMakeLists.txt): METHOD 1 fast, 2 exact; ARITHMETIC 0, 1; CAMERA as in pixels.comp (rays of an
// orthographic one are free: their lists hold world records, and each ray brings its own origin); STORAGE 2 records and
// lists in texel buffers, which llvmpipe reads quicker, its loops over the rays unrolled; 3 in storage buffers, its loops left as
// they are, for other devices.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#if METHOD == 2
#define EXACT
#endif
#define FREE (CAMERA == 2)
#define EYE (!FREE)
#define WORLD 0
#define HITS 0

#include "search.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Portion {
  uint wholeWidth, wholeHeight;  // of the whole image, in pixels
  uint firstX, firstY;           // of this band, in the whole image
  uint rows, stride;             // of this band's planes (stride in words)
  uint sampleX, sampleY;         // which sample of every pixel
  uint from, to;                 // PORTIONED: the part of each tile's entries, over all kinds, that is walked now
  uint last;                     // PORTIONED: nothing comes after it
  uint listTexels;               // of `lists` by invocation
} portion;

#include "picture.glsl"

layout(constant_id = 34) const bool PORTIONED = false;

// By invocation: (x, y in the band, -, -), then for each kind of the scene
// (first row of the wide tile's solids, how many, first row of its own, how many of both).
#if STORAGE == 2
layout(set = 0, binding = 1) uniform usamplerBuffer lists;
#define LIST_TEXEL(i) texelFetch(lists, i)
#else
layout(set = 0, binding = 1, std430) readonly buffer Lists { uvec4 lists[]; };
#define LIST_TEXEL(i) lists[i]
#endif

// PORTIONED: what a pixel has found so far.
layout(set = 0, binding = 6, std430) buffer State { Best state[]; };

#define RAYS 16

void main() {
  int at = int(gl_GlobalInvocationID.x) * int(portion.listTexels);
  uvec4 tile = LIST_TEXEL(at);

#if FREE
#define TEST(kind, entry) kind##_free(entry, ray[k], best[k])
#define ROWS(EYE_ROWS, WORLD_ROWS) WORLD_ROWS
  FreeRay ray[RAYS];
#else
#define TEST(kind, entry) kind##_eye(entry, ray[k], best[k])
#define ROWS(EYE_ROWS, WORLD_ROWS) EYE_ROWS
  EyeRay ray[RAYS];
#endif
  Best best[RAYS];
  UNROLL for (int k = 0; k < RAYS; ++k) {
    uint column = (portion.firstX + tile.x + uint(k % 4)) * SAMPLES + portion.sampleX;
    uint row = (portion.firstY + tile.y + uint(k / 4)) * SAMPLES + portion.sampleY;
    CameraRay camera = cameraRay(column, row);
#if FREE
    ray[k].origin = camera.origin;
    ray[k].direction = combine(camera.direction.x, camera.direction.y, camera.direction.z);
    ray[k].squared = dot3(ray[k].direction, ray[k].direction);
    ray[k].reach = length3(camera.origin);
#else
    ray[k].direction = camera.direction;
    ray[k].squared = linear(ray[k].direction, ray[k].direction);
    if (BOX_COUNT > 0u) {
      ray[k].world = combine(ray[k].direction.x, ray[k].direction.y, ray[k].direction.z);
    } else {
      ray[k].world = ray[k].direction;
    }
#endif
    best[k] = noHit();
    if (PORTIONED) {
      if (portion.from > 0u) best[k] = state[gl_GlobalInvocationID.x * RAYS + uint(k)];
    }
  }

  // Lanes read from places of their own, and wait for them: short records are loaded one entry ahead (longer ones take the
  // registers of too many rays; behind the last entry there is always something to read). The condition at the loop's end saves
  // llvmpipe a last round that does nothing.
  uint done = 0u;  // entries of the kinds before
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS)                                    \
  if (KIND##_COUNT > 0u) {                                                                       \
    uvec4 list = LIST_TEXEL(++at);                                                        \
    uint i = 0u, end = list.w;                                                                   \
    if (PORTIONED) {                                                                             \
      i = min(max(portion.from, done) - done, list.w);                                           \
      end = min(max(portion.to, done) - done, list.w);                                           \
      done += list.w;                                                                            \
    }                                                                                            \
    const uint rows = ROWS(EYE_ROWS, WORLD_ROWS);                                                \
    uint entry = i < list.y ? list.x + i * rows : list.z + (i - list.y) * rows;                  \
    useAhead = rows == 2u;                                                                       \
    real4 next[2];                                                                               \
    if (useAhead) next = real4[2](loadedRow(entry), loadedRow(entry + 1u));                      \
    if (i < end) {                                                                               \
      do {                                                                                       \
        uint now = entry;                                                                        \
        entry = i + 1u == list.y ? list.z : entry + rows;                                        \
        if (useAhead) {                                                                          \
          ahead = next;                                                                          \
          now = 0u;                                                                              \
          next = real4[2](loadedRow(entry), loadedRow(entry + 1u));                              \
        }                                                                                        \
        UNROLL for (int k = 0; k < RAYS; ++k) TEST(kind, now);                                   \
      } while (++i < end);                                                                       \
    }                                                                                            \
  }
#include "solids.def"
#undef SOLID

  if (PORTIONED) {
    if (portion.last == 0u) {
      UNROLL for (int k = 0; k < RAYS; ++k) state[gl_GlobalInvocationID.x * RAYS + uint(k)] = best[k];
      return;
    }
  }
  UNROLL for (int y = 0; y < 4; ++y) {
    Result result[STORED];
    UNROLL for (int x = 0; x < 4; ++x) {
      real squared = ray[4 * y + x].squared;
      result[x] = resultOf(best[4 * y + x], squared, root(squared));
    }
    storeRow((tile.y + uint(y)) * portion.stride + tile.x, result);
  }
}
