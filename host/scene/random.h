// Random scenes for measurements: the same on every machine, because only correctly rounded operations make them (and
// one cube root, cut to six decimals).
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/scene/world.h"

namespace solidcast {

/// "mixed" and every kind of solid, as kindName() says it.
const std::vector<std::string>& randomKinds();

/// A ball of `count` solids of radius 10 around zero, each about as large as its share of the room, seen by a
/// perspective camera from (0, 0, 30). Infinite planes stand behind it like the facets of a bowl; quadrics are turned
/// ellipsoids; "mixed" has one plane as a floor, and all other kinds in equal parts. Throws Error(Exit::usage) for an
/// unknown kind.
Scene randomScene(const std::string& kind, std::uint32_t count, std::uint64_t seed);

}  // namespace solidcast
