// Numbers and names as an explanation spells them.
#pragma once
#include <string>

#include "host/cast/quad_precision.h"

namespace solidcast::explain {

/// The name in the scene file, else "sphere 2" by kind and index.
std::string solidName(const World& world, std::int32_t index);
/// 18 significant digits; 3 significant digits; the nearest fp64 in hex.
std::string decimal(f128 x);
std::string brief(f128 x);
std::string hex(f128 x);

}  // namespace solidcast::explain
