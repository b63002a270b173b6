// Making a World through the API, solid by solid, in the depth-first order that it wants.
#pragma once
#include <cstdint>
#include <string>

#include "host/scene/world.h"

namespace solidcast {

/// Appends to a group (0 is the root) and returns the solid's index. Finish a nested group before its parent goes on.
std::uint32_t addSolid(World& world, Shape shape, std::string name = "", std::uint32_t group = 0);

/// Appends an empty group to `parent` and returns its index.
std::uint32_t addGroup(World& world, std::string name = "", std::uint32_t parent = 0);

}  // namespace solidcast
