// What SPIRV-Tools does for us: is a module valid, how does it read.
#include <spirv-tools/libspirv.hpp>

#include "host/error.h"
#include "host/gpu/shaders.h"

namespace solidcast::gpu {
namespace {

/// The first Vulkan that takes the module's version of SPIR-V.
spv_target_env environmentOf(std::span<const std::uint32_t> spirv) {
  return spirv.size() > 1 && spirv[1] > 0x10300 ? SPV_ENV_VULKAN_1_2 : SPV_ENV_VULKAN_1_1;
}

/// Collects errors as "word 12: message; ...".
spvtools::MessageConsumer collectErrors(std::string& out) {
  return [&out](spv_message_level_t level, const char*, const spv_position_t& position, const char* message) {
    if (level > SPV_MSG_ERROR) return;
    if (!out.empty()) out += "; ";
    out += "word " + std::to_string(position.index) + ": " + message;
  };
}

}  // namespace

std::string validationError(std::span<const std::uint32_t> spirv) {
  spvtools::SpirvTools tools(environmentOf(spirv));
  std::string errors;
  tools.SetMessageConsumer(collectErrors(errors));
  if (tools.Validate(spirv.data(), spirv.size())) return {};
  return errors.empty() ? "not valid, and spirv-val gives no reason" : errors;
}

std::string disassemble(std::span<const std::uint32_t> spirv) {
  spvtools::SpirvTools tools(environmentOf(spirv));
  std::string errors, text;
  tools.SetMessageConsumer(collectErrors(errors));
  constexpr std::uint32_t style = SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES | SPV_BINARY_TO_TEXT_OPTION_INDENT;
  if (!tools.Disassemble(spirv.data(), spirv.size(), &text, style)) {
    throw Error(Exit::shader, "the shader module cannot be read: " + errors);
  }
  return text;
}

}  // namespace solidcast::gpu
