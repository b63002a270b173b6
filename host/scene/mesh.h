// Triangle meshes from files: PLY (ascii, binary of both byte orders) and OBJ.
//
// Both formats are read here and not by a library: the one that Debian has for both (assimp 5.2) keeps single precision, reads
// decimals to an ulp or so, and aborts the process on many damaged PLY files, while a scene's numbers are fp64 as parsed,
// and bad input is one line. What is read is the geometry alone: vertices and faces, in the order of the file.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "host/scene/rules.h"
#include "host/scene/world.h"

namespace solidcast {

struct Mesh {
  std::vector<Triple> vertices;                         // correctly rounded to fp64
  std::vector<std::array<std::uint32_t, 3>> triangles;  // polygons as fans from their first vertex
  std::size_t thin = 0;                                 // faces of fewer than three vertices: left out
  std::size_t bent = 0;                                 // polygons that are not convex: their fan overlaps itself
};

/// ".ply" or ".obj", in any case.
bool isMeshFile(const std::string& file);

/// Throws Fault without a place, whose text begins with the file and, where there is one, the line. Indices are in range.
Mesh readMesh(const std::string& file);

/// scale, then rotation about an axis through the origin (right-handed), then translation.
struct Placement {
  double scale = 1;
  Triple axis{0, 0, 1};
  double degrees = 0;
  Triple translate{0, 0, 0};
};

/// Adds the mesh as a group of its own, its triangles in the file's order, vertices placed in binary128 and rounded once.
/// Triangles without area are left out; what was left out or is doubtful is one warning. Throws Fault when none is left.
void addMesh(World& world, std::uint32_t parent, const std::string& name, const std::string& file,
             const Placement& placement, std::vector<Fault>& warnings);

/// A scene of one mesh file, seen whole from the front (from +z, a little above and to the right), shining on both
/// sides. Throws Fault.
Scene sceneOfMesh(const std::string& file, std::vector<Fault>& warnings);

}  // namespace solidcast
