#include "host/scene/write.h"

#include <nlohmann/json.hpp>

#include "host/scene/load.h"
#include "host/scene/rules.h"

namespace solidcast {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 16;

template <std::size_t count>
std::string list(const std::array<double, count>& numbers) {
  std::string out = "[";
  for (const double number : numbers) out.append(out.size() > 1 ? ", " : "").append(shortest(number));
  return out + "]";
}

std::string member(const char* key, const std::string& value) { return std::string(", \"") + key + "\": " + value; }
std::string member(const char* key, const Triple& value) { return member(key, list(value)); }
std::string member(const char* key, double value) { return member(key, shortest(value)); }

std::string fields(const InfinitePlane& s) { return member("origin", s.origin) + member("normal", s.normal); }
std::string fields(const AABox& s) { return member("corner1", s.corner1) + member("corner2", s.corner2); }
std::string fields(const Sphere& s) { return member("center", s.center) + member("radius", s.radius); }
std::string fields(const Disc& s) {
  return member("center", s.center) + member("normal", s.normal) + member("radius", s.radius);
}
std::string fields(const Triangle& s) {
  std::string vertices = "[";
  vertices.append(list(s.v1)).append(", ").append(list(s.v2)).append(", ").append(list(s.v3)).append("]");
  return member("vertices", vertices);
}
std::string fields(const Quad& s) {
  return member("vertex", s.vertex) + member("span1", s.span1) + member("span2", s.span2);
}
std::string fields(const Quadric& s) { return member("coefficients", list(s.coefficients)); }

template <class AnyCamera>
std::string frame(const char* type, const AnyCamera& c) {
  return std::string("\"type\": \"") + type + "\"" + member("center", c.center) + member("forward", c.forward) +
         member("up", c.up);
}
std::string fields(const PerspectiveCamera& c) {
  return frame("perspective", c) + member("vertical_angle", c.verticalAngle) +
         member("horizontal_angle", c.horizontalAngle);
}
std::string fields(const OrthographicCamera& c) {
  return frame("orthographic", c) + member("scale_x", c.scaleX) + member("scale_y", c.scaleY);
}
std::string fields(const EnvironmentCamera& c) {
  return frame("environment", c) + member("vertical_angle", c.verticalAngle) +
         member("horizontal_angle", c.horizontalAngle);
}

std::string text(const std::string& value) { return nlohmann::json(value).dump(); }

std::string fields(const CustomCode& code) {
  std::string parameters = "{";
  for (const GlslParameter& p : code.parameters)
    parameters += (parameters.size() > 1 ? ", " : "") + text(p.name) + ": " +
                  (p.value.index() == 0 ? shortest(std::get<0>(p.value)) : list(std::get<1>(p.value)));
  return member("glsl", text(code.file)) + (code.parameters.empty() ? "" : member("parameters", parameters + "}"));
}

std::string fields(const RayCastingIntegrator&) { return ""; }
std::string fields(const RayCastingDistIntegrator& dist) {
  return member("near_color", dist.nearColor) + member("near_dist", dist.nearDist) +
         member("far_color", dist.farColor) + member("far_dist", dist.farDist);
}
std::string fields(const CustomIntegrator& custom) { return fields(custom.code); }

/// The chosen one first, then the others that the scene has numbers for.
std::string integrators(const Scene& scene) {
  static constexpr const char* types[] = {"casting", "castingdist", "custom"};
  std::string list;
  const auto add = [&](const Integrator& integrator) {
    list += (list.empty() ? "" : ", ") + std::string("{\"type\": \"") + types[integrator.index()] + "\"" +
            std::visit([](const auto& i) { return fields(i); }, integrator) + "}";
  };
  add(scene.integrator);
  const bool one = (!scene.distParameters || scene.integrator.index() == 1) &&
                   (!scene.customIntegrator || scene.integrator.index() == 2);
  if (scene.distParameters && scene.integrator.index() != 1) add(*scene.distParameters);
  if (scene.customIntegrator && scene.integrator.index() != 2) add(*scene.customIntegrator);
  return one ? list : "[" + list + "]";
}

std::string nameMember(const std::string& name) { return name.empty() ? "" : member("name", text(name)); }

std::string solidLine(const SolidEntry& solid) {
  return std::string("{\"type\": \"") + kindName(solid.shape) + "\"" + nameMember(solid.name) +
         std::visit([](const auto& shape) { return fields(shape); }, solid.shape) + "}";
}

std::string bounds(const CustomSolid& solid) {
  if (!solid.bounds) return "";
  return ", \"bounds\": {\"min\": " + list((*solid.bounds)[0]) + member("max", (*solid.bounds)[1]) + "}";
}

/// Writes the tree with the way down on a vector: groups may nest deeper than a stack would bear.
template <class Write>
void writeSolids(const World& world, const Write& write) {
  struct Place {
    std::uint32_t group;
    std::size_t next;
  };
  std::vector<Place> path = {{0, 0}};
  while (!path.empty()) {
    const std::vector<GroupMember>& members = world.groups[path.back().group].members;
    const std::size_t i = path.back().next++;
    if (i == members.size()) {
      path.pop_back();
      if (!path.empty()) write("]}");
      continue;
    }
    write(i == 0 ? "\n    " : ",\n    ");
    if (!members[i].isGroup) {
      write(solidLine(world.solids[members[i].index]));
      continue;
    }
    write("{\"type\": \"group\"" + nameMember(world.groups[members[i].index].name) + ", \"solids\": [");
    path.push_back({members[i].index, 0});
  }
}

}  // namespace

std::string cameraText(const Camera& camera) {
  std::string text = "{";
  text += std::visit([](const auto& c) { return fields(c); }, camera);
  return text += "}";
}

void writeScene(const Scene& scene, std::string_view comment, const TextSink& sink) {
  std::string piece;
  const auto write = [&](std::string_view text) {
    piece += text;
    if (piece.size() < kPiece) return;
    sink(piece);
    piece.clear();
  };
  while (!comment.empty()) {
    const std::string_view line = comment.substr(0, comment.find('\n'));
    write("// ");
    write(line);
    write("\n");
    comment.remove_prefix(std::min(comment.size(), line.size() + 1));
  }
  write("{\n  \"image\": {\"width\": " + std::to_string(scene.width) + ", \"height\": " + std::to_string(scene.height));
  write("},\n  \"camera\": " + cameraText(scene.camera));
  write(",\n  \"integrator\": " + integrators(scene));
  if (scene.twoSided) write(",\n  \"two_sided\": true");
  write(",\n  \"solids\": [");
  writeSolids(scene.world, write);
  for (const CustomSolid& custom : scene.world.customSolids)
    write(std::string(&custom == scene.world.customSolids.data() && scene.world.groups[0].members.empty() ? "" : ",") +
          "\n    {\"type\": \"custom\"" + nameMember(custom.name) + fields(custom.code) + bounds(custom) + "}");
  write("\n  ]\n}\n");
  sink(piece);
}

}  // namespace solidcast
