// The rules for scenes made through the API: those of rules.h, and that the flat tree is a tree.
#include "host/error.h"
#include "host/scene/builder.h"
#include "host/scene/load.h"

namespace solidcast {
namespace {

/// Walks the groups as the solids' order says: depth first, each group and solid met exactly once.
void checkTree(const World& world) {
  const auto refuse = [](const std::string& text) { throw Fault{"", text}; };
  if (world.groups.empty() || world.groups[0].parent != 0)
    refuse("the world has no root, expected groups[0] to be its own parent");
  struct Place {
    std::uint32_t group;
    std::size_t next;
  };
  std::vector<Place> path = {{0, 0}};
  std::size_t solids = 0, groups = 1;
  while (!path.empty()) {
    const std::uint32_t group = path.back().group;
    if (path.back().next == world.groups[group].members.size()) {
      path.pop_back();
      continue;
    }
    const GroupMember member = world.groups[group].members[path.back().next++];
    const std::string what = numbered(member.isGroup ? "group " : "solid ", member.index);
    if (member.index >= (member.isGroup ? world.groups.size() : world.solids.size()))
      refuse(what + " does not exist, expected an index into the world's lists");
    if (member.isGroup) {
      if (member.index == 0 || world.groups[member.index].parent != group || ++groups > world.groups.size())
        refuse(what + " is a member of group " + std::to_string(group) + ", expected only its parent's");
      if (path.size() > kMaxGroupDepth)
        refuse("groups are nested too deep, expected at most " + std::to_string(kMaxGroupDepth));
      path.push_back({member.index, 0});
    } else if (member.index != solids++ || world.solids.group(member.index) != group) {
      refuse(what + " is out of order or in the wrong group, expected solids depth first");
    }
  }
  if (solids != world.solids.size() || groups != world.groups.size())
    refuse("the groups hold " + std::to_string(solids) + " solids and " + std::to_string(groups - 1) +
           " groups, expected all " + std::to_string(world.solids.size()) + " and " +
           std::to_string(world.groups.size() - 1));
}

}  // namespace

void checkScene(const Scene& scene, std::vector<std::string>& warnings) {
  const std::string prefix = scene.file.empty() ? "scene: " : scene.file + ": ";
  std::string place;
  const auto report = [&](const std::vector<Fault>& found) {
    for (const Fault& fault : found) warnings.push_back(prefix + place + fault.where + ": " + fault.text);
  };
  try {
    std::vector<Fault> found;
    place = "/image";
    checkImageSize(scene.width, scene.height);
    place = "/camera";
    checkCamera(scene.camera, found);
    report(found);
    place = "/integrator";
    if (const auto* dist = std::get_if<RayCastingDistIntegrator>(&scene.integrator)) checkIntegrator(*dist);
    if (scene.distParameters) checkIntegrator(*scene.distParameters);
    place = "/solids";
    checkTree(scene.world);
    UniqueNames names;
    for (std::uint32_t i = 0; i < scene.world.solids.size(); ++i) {
      const SolidEntry solid = scene.world.solids[i];
      place = solidName(scene.world, i);
      found.clear();
      checkShape(solid.shape, found);
      report(found);
      names.add(solid.name, kindName(solid.shape) + numbered(" ", i), "");
    }
    for (const CustomSolid& custom : scene.world.customSolids) names.add(custom.name, "custom", "");
    for (std::size_t i = 0; i < scene.world.groups.size(); ++i) {
      place = numbered("group ", i);
      names.add(scene.world.groups[i].name, place, "");
    }
  } catch (const Fault& fault) { throw Error(Exit::usage, prefix + place + fault.where + ": " + fault.text); }
}

const char* kindName(const Shape& shape) {
  // The order of Shape's alternatives.
  static constexpr const char* names[] = {"infinite_plane", "box", "sphere", "disc", "triangle", "quad", "quadric"};
  static_assert(std::size(names) == std::variant_size_v<Shape>);
  return names[shape.index()];
}

std::string solidName(const World& world, std::uint32_t index) {
  if (index >= world.solids.size()) {
    const CustomSolid& custom = world.customSolids[index - world.solids.size()];
    return custom.name.empty() ? numbered("custom ", index) : custom.name;
  }
  const SolidEntry solid = world.solids[index];
  return solid.name.empty() ? kindName(solid.shape) + numbered(" ", index) : solid.name;
}

}  // namespace solidcast
