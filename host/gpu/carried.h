// What the build writes for the modules listed in shaders/CMakeLists.txt.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace solidcast::gpu {

struct CarriedModule {
  std::string_view name;
  std::span<const std::uint32_t> spirv;
};

std::vector<CarriedModule> carriedRegistry();

}  // namespace solidcast::gpu
