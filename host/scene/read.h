// JSON objects of a scene file to the plain description: one function a concept, all refusing with Fault.
#pragma once
#include "host/scene/fields.h"

namespace solidcast {

/// One solid: {"type": "sphere", ...}. Keeps every rule of rules.h. Warnings have their place from `fields` on.
Shape readSolid(const Fields& fields, std::vector<Fault>& warnings);

/// Types that may stand in a list of solids, groups included.
Names solidTypes();

/// The text under "name", or "" where there is none.
std::string readName(const Fields& fields);

/// Everything at the top of the file but the solids: image, camera, integrators, two_sided.
void readView(const Fields& fields, Scene& scene, std::vector<Fault>& warnings);

}  // namespace solidcast
