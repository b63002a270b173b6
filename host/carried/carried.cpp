#include "host/carried/carried.h"

#include <string>

#include "host/error.h"

namespace solidcast::gpu {

std::span<const std::uint32_t> carriedModule(std::string_view name) {
  std::string known;
  for (const CarriedModule& module : carriedRegistry()) {
    if (module.name == name) return module.spirv;
    known += (known.empty() ? "" : ", ") + std::string(module.name);
  }
  throw Error(Exit::shader, "no shader module \"" + std::string(name) + "\" in this program; there is: " + known);
}

std::vector<std::string_view> carriedModules() {
  std::vector<std::string_view> names;
  for (const CarriedModule& module : carriedRegistry()) names.push_back(module.name);
  return names;
}

}  // namespace solidcast::gpu
