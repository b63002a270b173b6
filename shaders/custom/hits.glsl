// What the programs around users' own GLSL share: what was hit, pixel by pixel, and where colours go.
//
// The search (pixels.comp and its like) stores distance and solid; surfaces.comp adds all that follows from them; each
// custom solid puts itself in front where it is nearer (intersect.comp); a colour comes last (radiance.comp, shade.comp).
// So the search does not know of any of it: its modules are the same for all scenes. One invocation does one pixel, so
// that users' code is compiled once.
#ifndef SOLIDCAST_CUSTOM_HITS
#define SOLIDCAST_CUSTOM_HITS

layout(local_size_x = 64) in;

layout(push_constant) uniform Portion {
  uint wholeWidth, wholeHeight;  // of the whole image, in pixels
  uint firstX, firstY;           // of this band, in the whole image
  uint width, height;            // of this band
  uint rows, stride;             // of its planes (stride in words)
  uint sampleX, sampleY;         // which sample of every pixel
  uint solid;                    // intersect.comp: the index of the solid
  uint flags;
  uint program;                  // users' own: which of them this is, for the report
  float low[3], high[3];         // intersect.comp: bounds
} portion;
#define TWO_SIDED_FLAG 1u
#define EIGHT_BITS 2u  // colours as three bytes of a word; otherwise as three floats, summed over the samples
#define BOUNDED 4u

// Planes of one word a pixel. The first two are the search's.
layout(set = 0, binding = 3, std430) buffer Hits { uint hits[]; };
#define DISTANCE_PLANE 0u  // +infinity: nothing hit; 0: no pixel of the image
#define SOLID_PLANE 1u     // 0xffffffff: nothing hit
#define NORMAL_PLANE 2u    // three planes each from here on
#define LOCAL_PLANE 5u
#define POSITION_PLANE 8u
#define ORIGIN_PLANE 11u
#define DIRECTION_PLANE 14u
#define NOTHING 0xffffffffu

uint planeWords() { return portion.stride * portion.rows; }
float hitsFloat(uint plane, uint pixel) { return uintBitsToFloat(hits[plane * planeWords() + pixel]); }
vec3 hitsTriple(uint plane, uint pixel) {
  return vec3(hitsFloat(plane, pixel), hitsFloat(plane + 1u, pixel), hitsFloat(plane + 2u, pixel));
}
void putTriple(uint plane, uint pixel, vec3 v) {
  for (uint c = 0u; c < 3u; ++c) hits[(plane + c) * planeWords() + pixel] = floatBitsToUint(v[c]);
}

layout(set = 0, binding = 8, std430) buffer Colours { uint colours[]; };
layout(set = 0, binding = 9, std430) buffer Report {
  uint nanColours;
  uint endlessLoop;  // the first place whose loop was stopped, with its program; NOTHING: none
};

bool isNumber(float v) { return (floatBitsToUint(v) & 0x7fffffffu) <= 0x7f800000u; }
bool isNumber(vec3 v) { return isNumber(v.x) && isNumber(v.y) && isNumber(v.z); }

// A colour that is not a number is counted and shown in magenta.
void putColour(uint pixel, vec3 colour) {
  if (!isNumber(colour)) {
    atomicAdd(nanColours, 1u);
    colour = vec3(1.0, 0.0, 1.0);
  }
  if ((portion.flags & EIGHT_BITS) != 0u) {
    uvec3 levels = uvec3(clamp(colour, 0.0, 1.0) * 255.0);  // truncated, as everywhere
    colours[pixel] = levels.r | levels.g << 8 | levels.b << 16;
    return;
  }
  bool further = (portion.sampleX | portion.sampleY) != 0u;
  for (uint c = 0u; c < 3u; ++c) {
    uint at = c * planeWords() + pixel;
    precise float sum = (further ? uintBitsToFloat(colours[at]) : 0.0) + colour[c];
    colours[at] = floatBitsToUint(sum);
  }
}
#endif
