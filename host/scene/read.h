// JSON objects of a scene file to the plain description: one function a concept, all refusing with Fault.
#pragma once
#include "host/scene/fields.h"
#include "host/scene/mesh.h"

namespace solidcast {

/// One solid: {"type": "sphere", ...}. Keeps every rule of rules.h. Warnings have their place from `fields` on.
Shape readSolid(const Fields& fields, std::vector<Fault>& warnings);

/// {"type": "mesh", ...}: which file, and where it goes. The file is not opened yet.
struct MeshSolid {
  std::string file;  // as the scene names it: from the scene file's folder
  Placement placement;
};
MeshSolid readMeshSolid(const Fields& fields);

/// "glsl" and "parameters" of {"type": "custom", ...}, be it an integrator or a solid.
CustomCode readCustomCode(const Fields& fields);
CustomSolid readCustomSolid(const Fields& fields);

/// Types that may stand in a list of solids, groups and meshes included.
Names solidTypes();

/// The text under "name", or "" where there is none.
std::string readName(const Fields& fields);

/// {"type": "perspective", ...}. Keeps checkCamera()'s rules.
Camera readCamera(const Fields& fields, std::vector<Fault>& warnings);

/// Everything at the top of the file but the solids: image, camera, integrators, two_sided.
void readView(const Fields& fields, Scene& scene, std::vector<Fault>& warnings);

}  // namespace solidcast
