// The modules compiled at build time and carried in the binary, as listed in shaders/CMakeLists.txt.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace solidcast::gpu {

/// A module by its name in CMakeLists.txt's list (e.g. "pixels_exact"); throws Exit::shader if unknown.
std::span<const std::uint32_t> carriedModule(std::string_view name);

/// Names of all carried modules.
std::vector<std::string_view> carriedModules();

/// GLSL of shaders/custom that is compiled together with users' own, by names without endings.
struct CarriedText {
  const char* name;
  std::string_view text;
};
extern const CarriedText kCarriedTexts[];
extern const std::size_t kCarriedTextCount;

struct CarriedModule {
  std::string_view name;
  std::span<const std::uint32_t> spirv;
};

/// What the build writes of that list.
std::vector<CarriedModule> carriedRegistry();

}  // namespace solidcast::gpu
