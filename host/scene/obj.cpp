// Wavefront OBJ, as far as it is geometry: `v` and `f`. Texture and normal indices are read and not kept; groups,
// materials, lines, points and free-form surfaces are passed over.
#include "host/scene/fields.h"
#include "host/scene/mesh_text.h"

namespace solidcast {
namespace {

constexpr char kIndex[] = "the number of a vertex (from 1, or from -1 backwards)";

}  // namespace

Mesh readObj(const std::string& file, std::string_view whole) {
  MeshText text(file, whole);
  Mesh mesh;
  Faces faces;
  std::vector<std::uint32_t> corners;
  std::uint32_t largest = 0;  // a face may stand before its vertices
  MeshText largestAt = text;  // where that was

  const auto corner = [&] {
    const std::int64_t given = text.whole(kIndex);
    while (text.take('/'))
      if (text.peek() == '-' || (text.peek() >= '0' && text.peek() <= '9'))
        text.whole("the number of a texture coordinate or normal");
    const auto count = static_cast<std::int64_t>(mesh.vertices.size());
    if (given == 0 || given < -count || given > UINT32_MAX)
      text.refuse("vertex " + std::to_string(given) + " does not exist, expected " + kIndex + "; " +
                  std::to_string(count) + " stand above");
    const auto index = static_cast<std::uint32_t>(given < 0 ? count + given : given - 1);
    if (index > largest || largest == 0) {
      largest = index;
      largestAt = text;
    }
    return index;
  };

  for (; !text.done(); text.nextLine()) {
    const std::string_view key = text.word();
    if (key == "v") {
      const double x = text.real("x"), y = text.real("y"), z = text.real("z");
      mesh.vertices.push_back({x, y, z});
    } else if (key == "f") {
      corners.clear();
      while (!text.lineEnds() && text.peek() != '#') corners.push_back(corner());
      faces.add(mesh, corners);
    }
  }
  if (!mesh.triangles.empty() && largest >= mesh.vertices.size())
    largestAt.refuse("vertex " + std::to_string(std::uint64_t{largest} + 1) + " does not exist, expected " + kIndex +
                     "; the file has " + std::to_string(mesh.vertices.size()));
  faces.finish(mesh);
  return mesh;
}

}  // namespace solidcast
