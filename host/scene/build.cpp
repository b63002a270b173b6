#include "host/scene/build.h"

#include <utility>

namespace solidcast {

std::uint32_t addSolid(World& world, Shape shape, std::string name, std::uint32_t group) {
  const auto index = static_cast<std::uint32_t>(world.solids.size());
  world.solids.push_back({std::move(name), shape, group});
  world.groups[group].members.push_back({false, index});
  return index;
}

std::uint32_t addGroup(World& world, std::string name, std::uint32_t parent) {
  const auto index = static_cast<std::uint32_t>(world.groups.size());
  world.groups.push_back({std::move(name), parent, {}});
  world.groups[parent].members.push_back({true, index});
  return index;
}

}  // namespace solidcast
