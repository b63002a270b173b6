// Whether solids of different kinds can be at the same distance along many rays, so that `fast` has to compare indices.
#pragma once
#include "host/cast/records.h"

namespace solidcast {

/// For forms in fp32. False only if no two solids of different kinds share a plane (to 2^-20) and no quadric is among
/// others: where surfaces merely cross, rays at exactly equal fp32 distances are chance, and which solid such a ray shows is
/// within the rounding of `fast`.
bool mayTie(const Records& records, const EyeFrame& eye);

}  // namespace solidcast
