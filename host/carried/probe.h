// What a device's arithmetic really does, found by running it: exact methods rest on correctly rounded + - * / and
// sqrt, on `precise` being kept, and on error-free transformations that hold.
#pragma once
#include <cstdint>
#include <string>

#include "host/gpu/device.h"

namespace solidcast::gpu {

/// Of one number type. Counts are over `cases` random operands: half of them of moderate size, half any bit pattern
/// (denormals, infinities and NaN included). A NaN fits any NaN. The ulp counts leave denormals out; those have a
/// line of their own.
struct ArithmeticReport {
  int cases = 0;
  std::string fma;                          // "fused", "not fused" (two roundings) or "mixed"
  double divisionUlp = 0, rootUlp = 0;      // largest error beyond correct rounding; 0: correctly rounded
  double sumUlp = 0, productUlp = 0;        // the same of + and *
  bool denormalInputs = false;              // kept as operands
  bool denormalResults = false;             // kept as results
  bool uncontracted = false;                // a * b + c under `precise` is two roundings
  bool precise = false;                     // (a + b) - a under `precise` is computed as written
  bool twoSum = false, twoProduct = false;  // error-free transformations are error-free
  bool exactOperations() const { return divisionUlp == 0 && rootUlp == 0 && sumUlp == 0 && productUlp == 0; }
};

/// Runs the module probe_f32 (float64 = false) or probe_f64. Same operands on every device.
/// Throws Exit::noDevice where float64 is asked of a device without it.
ArithmeticReport probeArithmetic(Device& device, bool float64);

/// Iterations that a plain loop of one invocation makes when it is asked for `wanted` (runs probe_loop). lavapipe stops
/// at 65,535, counted over all loops of the invocation, and says nothing; a shader that loops longer is wrong there.
std::uint32_t loopIterations(Device& device, std::uint32_t wanted);

}  // namespace solidcast::gpu
