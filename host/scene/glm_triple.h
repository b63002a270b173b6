// Triples to GLM's vectors and back.
#pragma once
#include <glm/vec3.hpp>

#include "host/scene/world.h"

namespace solidcast {

inline glm::dvec3 vec(const Triple& t) { return {t[0], t[1], t[2]}; }
inline Triple triple(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace solidcast
