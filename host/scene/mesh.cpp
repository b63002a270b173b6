#include "host/scene/mesh.h"

#include <quadmath.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "host/scene/exact.h"
#include "host/scene/mesh_text.h"

namespace solidcast {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxMeshBytes = std::uintmax_t{1} << 30;

/// Of a file without surprises: no folder, no device, no pipe.
std::string readRegularFile(const std::string& file) {
  const auto refuse = [&](const std::string& what) { throw Fault{"", file + ": " + what}; };
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) refuse("no such file, expected a mesh file (.ply or .obj)");
  if (error) refuse(error.message() + ", expected a mesh file that can be read");
  if (status.type() != fs::file_type::regular) refuse("is no regular file, expected a mesh file (.ply or .obj)");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(std::string(std::strerror(errno)) + ", expected a mesh file that can be read");
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > kMaxMeshBytes)
    refuse("the file is larger than " + std::to_string(kMaxMeshBytes) + " bytes, expected at most that");
  std::string text(size, '\0');
  in.read(text.data(), static_cast<std::streamsize>(size));
  if (static_cast<std::uintmax_t>(in.gcount()) != size) refuse("cannot be read, expected a readable mesh file");
  return text;
}

/// Sine and cosine, exact for quarters of a turn.
void sineAndCosine(double degrees, Wide& sine, Wide& cosine) {
  int quarters = 0;
  const Wide rest = remquoq(Wide(degrees), 90, &quarters) * M_PIq / 180;
  const Wide s = sinq(rest), c = cosq(rest);
  const Wide sines[] = {s, c, -s, -c};
  sine = sines[quarters & 3];
  cosine = sines[(quarters + 1) & 3];
}

/// The placement as a matrix and a shift, in binary128.
class Placed {
 public:
  explicit Placed(const Placement& placement) : translate_(placement.translate) {
    Wide axis[3], sine, cosine;
    const Wide length =
        sqrtq(Wide(placement.axis[0]) * placement.axis[0] + Wide(placement.axis[1]) * placement.axis[1] +
              Wide(placement.axis[2]) * placement.axis[2]);
    for (int i = 0; i < 3; ++i) axis[i] = placement.axis[i] / length;
    sineAndCosine(placement.degrees, sine, cosine);
    // Rodrigues: R = cos I + sin [axis]x + (1 - cos) axis axis^T.
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      for (int column = 0; column < 3; ++column)
        rows_[i][column] = (1 - cosine) * axis[i] * axis[column] + (column == i ? cosine : 0);
      rows_[i][k] += sine * axis[j];
      rows_[i][j] -= sine * axis[k];
      for (Wide& entry : rows_[i]) entry *= placement.scale;
    }
    isPlain_ = placement.scale == 1 && remainder(placement.degrees, 360) == 0 && isZero(placement.translate);
  }

  Triple operator()(const Triple& p) const {
    if (isPlain_) return p;
    Triple placed;
    for (int i = 0; i < 3; ++i)
      placed[i] = static_cast<double>(rows_[i][0] * p[0] + rows_[i][1] * p[1] + rows_[i][2] * p[2] + translate_[i]);
    return placed;
  }

 private:
  Wide rows_[3][3];
  Triple translate_;
  bool isPlain_;
};

/// One warning for all that was left out or is doubtful; nothing when all is well.
std::string doubts(const Mesh& mesh, std::size_t flat, std::size_t slivers) {
  std::string text;
  const auto say = [&](std::size_t count, const char* what) {
    if (count > 0) text += (text.empty() ? "" : "; ") + std::to_string(count) + what;
  };
  say(flat + mesh.thin, " faces without area are left out");
  say(slivers, " triangles are slivers");
  say(mesh.bent, " polygons are not convex, their triangles overlap");
  return text;
}

}  // namespace

bool isMeshFile(const std::string& file) {
  std::string ending = fs::path(file).extension();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending == ".ply" || ending == ".obj";
}

Mesh readMesh(const std::string& file) {
  if (!isMeshFile(file)) throw Fault{"", file + ": the file's ending is unknown, expected .ply or .obj"};
  const std::string text = readRegularFile(file);
  const bool isPly = text.starts_with("ply\n") || text.starts_with("ply\r");
  if (!isPly && std::tolower(file[file.size() - 3]) == 'p')
    throw Fault{"", file + ": the file does not begin with \"ply\", expected a PLY file"};
  Mesh mesh = isPly ? readPly(file, text) : readObj(file, text);
  if (mesh.triangles.empty())
    throw Fault{"", file + ": the file has " + std::to_string(mesh.vertices.size()) +
                        " vertices and no faces, expected at least one triangle"};
  return mesh;
}

void addMesh(World& world, std::uint32_t parent, const std::string& name, const std::string& file,
             const Placement& placement, std::vector<Fault>& warnings) {
  Mesh mesh = readMesh(file);
  const Placed place(placement);
  for (Triple& vertex : mesh.vertices) {
    vertex = place(vertex);
    try {
      for (const double number : vertex) checkNumber(number, "");
    } catch (const Fault& fault) { throw Fault{"", file + ": a vertex when placed: " + fault.text}; }
  }

  const auto group = static_cast<std::uint32_t>(world.groups.size());
  world.groups.push_back({name, parent, {}});
  world.groups[parent].members.push_back({true, group});
  std::vector<GroupMember>& members = world.groups[group].members;
  members.reserve(mesh.triangles.size());
  world.solids.reserve<Triangle>(mesh.triangles.size());
  std::size_t flat = 0;
  std::vector<Fault> slivers;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Triangle triangle{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    try {
      checkShape(triangle, slivers);
    } catch (const Fault&) {  // the only rule left to break: no area
      ++flat;
      continue;
    }
    members.push_back({false, static_cast<std::uint32_t>(world.solids.size())});
    world.solids.push_back({"", triangle, group});
  }
  if (members.empty())
    throw Fault{"", file + ": all " + std::to_string(flat) + " triangles are without area, expected one that is not"};
  if (std::string text = doubts(mesh, flat, slivers.size()); !text.empty())
    warnings.push_back({"", file + ": of " + std::to_string(mesh.triangles.size()) + " triangles: " + text});
}

Scene sceneOfMesh(const std::string& file, std::vector<Fault>& warnings) {
  Scene scene;
  scene.file = file;
  addMesh(scene.world, 0, "", file, {}, warnings);
  const std::vector<Triangle>& triangles = scene.world.solids.of<Triangle>();
  Triple low = triangles[0].v1, high = low;
  for (const Triangle& triangle : triangles) {
    for (const Triple& vertex : {triangle.v1, triangle.v2, triangle.v3})
      for (int i = 0; i < 3; ++i) {
        low[i] = std::min(low[i], vertex[i]);
        high[i] = std::max(high[i], vertex[i]);
      }
  }
  // The ball around the bounds fills the vertical angle: its centre is radius / sin(45/2 degrees) away.
  const double radius = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) / 2;
  const double distance = 2.6131259297527530 * radius;
  const Triple back = {0.36, 0.27, 0.89303};  // towards the eye, nearly of length 1
  PerspectiveCamera camera{{}, {-back[0], -back[1], -back[2]}, {0, 1, 0}, 45, 57.82240163683314};
  for (int i = 0; i < 3; ++i) camera.center[i] = low[i] + (high[i] - low[i]) / 2 + distance * back[i];
  try {
    checkCamera(camera, warnings);
  } catch (const Fault& fault) {
    throw Fault{"", file + ": the camera that sees all of the mesh" + fault.where + ": " + fault.text};
  }
  scene.camera = camera;
  scene.twoSided = true;
  scene.distParameters = RayCastingDistIntegrator{{1, 1, 1}, distance - radius, {0.1, 0.1, 0.2}, distance + radius};
  return scene;
}

}  // namespace solidcast
