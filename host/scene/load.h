// Scene files (JSON, docs/scene-format.md) to Scene, and what people need around them.
#pragma once
#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "host/scene/world.h"

namespace solidcast {

/// Reads and checks a scene file, or makes a scene of a mesh file (.ply, .obj); "-" is standard input. Throws Error(Exit::usage) with one line
/// `file:line:column: ...` or `file: /json/path: what is wrong, expected what`. Warnings (slivers) go to `warnings`.
/// `files`, where given, gets all files that were read or should have been, also when it throws.
Scene loadScene(const std::string& file, std::vector<std::string>& warnings, std::vector<std::string>* files = nullptr);

/// The same from text; `file` is used in messages.
Scene parseScene(const std::string& text, const std::string& file, std::vector<std::string>& warnings,
                 std::vector<std::string>* files = nullptr);

/// The rules that a scene made through the API must keep too (positive radius, finite numbers, ...).
void checkScene(const Scene& scene, std::vector<std::string>& warnings);

/// Name for messages and output: its own, or "sphere 3" by kind and index.
std::string solidName(const World& world, std::uint32_t index);

/// "sphere", "infinite_plane", ... as in scene files.
const char* kindName(const Shape& shape);

/// The course sheet's scene, made through the API; scenes/a_solids.json holds the same.
Scene aSolids();

}  // namespace solidcast
