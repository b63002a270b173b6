// What a module is made of: its instructions by class.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace solidcast::gpu {

/// Counts in a fixed order: "arithmetic", "comparison", "conversion", "memory", "composite", "control", "calls",
/// "other" count in functions; "declarations" is all that is outside of them (types, constants, names, decorations).
/// Throws Exit::shader for what is no SPIR-V.
std::vector<std::pair<std::string, std::uint64_t>> instructionCounts(std::span<const std::uint32_t> spirv);

}  // namespace solidcast::gpu
