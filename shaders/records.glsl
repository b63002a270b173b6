// Where rows of numbers come from. STORAGE 0: uniform buffers (llvmpipe loads them once for all lanes: 1.7 times
// faster), STORAGE 1: storage buffers, for scenes beyond the uniform range; STORAGE 2: a texel buffer, where each lane
// loads rows of its own; STORAGE 3: a storage buffer for the same. A row is four `real`; a double-float row is two vec4,
// high parts first.
// ADDRESS 1, with STORAGE 0: by the buffers' addresses. llvmpipe compares every number of a uniform buffer with the
// buffer's size and branches around the load, and keeps little in registers across branches; from an address it loads
// the number, once for all lanes.
#ifndef SOLIDCAST_RECORDS
#define SOLIDCAST_RECORDS
#include "numeric.glsl"

#if ARITHMETIC == 1
#define RAW dvec4
#else
#define RAW vec4
#endif

layout(constant_id = 20) const uint RECORD_RAWS = 1u;  // sizes of the uniform arrays
layout(constant_id = 21) const uint WORLD_RAWS = 1u;
layout(constant_id = 22) const uint VIEW_RAWS = 1u;

#if STORAGE
#define RECORDS(number, Name, name, size) layout(set = 0, binding = number, std430) readonly buffer Name { RAW name[]; }
#else
#define RECORDS(number, Name, name, size) layout(set = 0, binding = number, std140) uniform Name { RAW name[size]; }
#endif

real4 rowOf(RAW first, RAW second) {
#if ARITHMETIC == 2
  return real4(real(first.x, second.x), real(first.y, second.y), real(first.z, second.z), real(first.w, second.w));
#else
  return first;
#endif
}
#if ARITHMETIC == 2
#define ROW(raws, row) rowOf(raws[2u * (row)], raws[2u * (row) + 1u])
#else
#define ROW(raws, row) rowOf(raws[row], raws[row])
#endif

#if STORAGE >= 2
#if STORAGE == 2
layout(set = 0, binding = 0) uniform usamplerBuffer records;
#define RECORD_TEXEL(i) texelFetch(records, int(i))
#else
layout(set = 0, binding = 0, std430) readonly buffer Records { uvec4 records[]; };
#define RECORD_TEXEL(i) records[i]
#endif
real4 loadedRow(uint row) {
#if ARITHMETIC == 1
  uvec4 low = RECORD_TEXEL(2u * row), high = RECORD_TEXEL(2u * row + 1u);
  return real4(packDouble2x32(low.xy), packDouble2x32(low.zw), packDouble2x32(high.xy), packDouble2x32(high.zw));
#else
  return uintBitsToFloat(RECORD_TEXEL(row));
#endif
}
// Rows that lists.comp has loaded ahead. Which it does is the same for all of a loop, so that nothing is left of the branch.
real4 ahead[2];
bool useAhead = false;
real4 record(uint row) {
  if (useAhead) return ahead[row];
  return loadedRow(row);
}
real4 worldRecord(uint row) { return record(row); }  // the lists of free rays hold nothing else
#elif ADDRESS
// pixels.comp's push constants say where; it defines record() and worldRecord().
layout(buffer_reference, std430, buffer_reference_align = 16) readonly buffer Rows { RAW rows[]; };
#elif EYE
RECORDS(0, Records, records, RECORD_RAWS);
real4 record(uint row) { return ROW(records, row); }
#endif
#if WORLD && !ADDRESS
RECORDS(1, WorldRecords, worldRecords, WORLD_RAWS);
real4 worldRecord(uint row) { return ROW(worldRecords, row); }
#endif

#endif
