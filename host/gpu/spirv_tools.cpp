// What SPIRV-Tools does for us: what is left of a module after specialisation, is it valid, how does it read.
#include <spirv-tools/libspirv.hpp>
#include <spirv-tools/optimizer.hpp>
#include <unordered_map>

#include "host/error.h"
#include "host/gpu/shaders.h"

namespace solidcast::gpu {
namespace {

constexpr spv_target_env environment = SPV_ENV_VULKAN_1_1;

/// Collects errors as "word 12: message; ...".
spvtools::MessageConsumer collectErrors(std::string& out) {
  return [&out](spv_message_level_t level, const char*, const spv_position_t& position, const char* message) {
    if (level > SPV_MSG_ERROR) return;
    if (!out.empty()) out += "; ";
    out += "word " + std::to_string(position.index) + ": " + message;
  };
}

}  // namespace

std::vector<std::uint32_t> specialised(std::span<const std::uint32_t> spirv,
                                       const std::vector<std::pair<std::uint32_t, std::uint32_t>>& constants) {
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
  for (const auto& [id, value] : constants) values[id] = {value};

  spvtools::Optimizer optimizer(environment);
  std::string errors;
  optimizer.SetMessageConsumer(collectErrors(errors));
  // First the constants become plain numbers ...
  optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
      .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
      .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
      .RegisterPass(spvtools::CreateUnifyConstantPass())
      // ... then everything is one function without memory in between ...
      .RegisterPass(spvtools::CreateWrapOpKillPass())
      .RegisterPass(spvtools::CreateMergeReturnPass())
      .RegisterPass(spvtools::CreateInlineExhaustivePass())
      .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
      .RegisterPass(spvtools::CreatePrivateToLocalPass())
      .RegisterPass(spvtools::CreateScalarReplacementPass())
      .RegisterPass(spvtools::CreateLocalAccessChainConvertPass())
      .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
      .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
      .RegisterPass(spvtools::CreateSSARewritePass())
      // ... so that what cannot happen is seen, and goes.
      .RegisterPass(spvtools::CreateCCPPass())
      .RegisterPass(spvtools::CreateSimplificationPass())
      .RegisterPass(spvtools::CreateDeadBranchElimPass())
      .RegisterPass(spvtools::CreateBlockMergePass())
      .RegisterPass(spvtools::CreateSimplificationPass())
      .RegisterPass(spvtools::CreateAggressiveDCEPass())
      .RegisterPass(spvtools::CreateDeadVariableEliminationPass())
      .RegisterPass(spvtools::CreateEliminateDeadConstantPass());
  std::vector<std::uint32_t> out;
  if (!optimizer.Run(spirv.data(), spirv.size(), &out)) {
    throw Error(Exit::shader, "the shader module cannot be specialised: " + errors);
  }
  return out;
}

std::string validationError(std::span<const std::uint32_t> spirv) {
  spvtools::SpirvTools tools(environment);
  std::string errors;
  tools.SetMessageConsumer(collectErrors(errors));
  if (tools.Validate(spirv.data(), spirv.size())) return {};
  return errors.empty() ? "not valid, and spirv-val gives no reason" : errors;
}

std::string disassemble(std::span<const std::uint32_t> spirv) {
  spvtools::SpirvTools tools(environment);
  std::string errors, text;
  tools.SetMessageConsumer(collectErrors(errors));
  constexpr std::uint32_t style = SPV_BINARY_TO_TEXT_OPTION_FRIENDLY_NAMES | SPV_BINARY_TO_TEXT_OPTION_INDENT;
  if (!tools.Disassemble(spirv.data(), spirv.size(), &text, style)) {
    throw Error(Exit::shader, "the shader module cannot be read: " + errors);
  }
  return text;
}

}  // namespace solidcast::gpu
