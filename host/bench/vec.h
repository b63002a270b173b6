// What the peers' geometry is calculated in.
#pragma once
#include <glm/glm.hpp>

#include "host/scene/world.h"

namespace solidcast::bench {

using Vec = glm::dvec3;

inline Vec vec(const Triple& v) { return {v[0], v[1], v[2]}; }

}  // namespace solidcast::bench
