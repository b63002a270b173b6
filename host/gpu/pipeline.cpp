#include <algorithm>
#include <glslang/SPIRV/spirv.hpp>

#include "host/error.h"
#include "host/gpu/core.h"
#include "host/gpu/shaders.h"

namespace solidcast::gpu {
namespace {

/// Whether a module with this capability runs on the device as it was opened.
bool serves(const Core& core, std::uint32_t capability) {
  const auto subgroup = [&](VkSubgroupFeatureFlags operation) {
    return (core.subgroupOperations & operation) == operation;
  };
  switch (capability) {
    case spv::CapabilityMatrix:
    case spv::CapabilityShader:
    case spv::CapabilitySampledBuffer:
      return true;
    case spv::CapabilityFloat64:
      return core.info.float64;
    case spv::CapabilityInt64:
      return core.info.int64;
    case spv::CapabilityPhysicalStorageBufferAddresses:
      return core.info.bufferAddresses;
    case spv::CapabilityGroupNonUniform:
      return subgroup(VK_SUBGROUP_FEATURE_BASIC_BIT);
    case spv::CapabilityGroupNonUniformVote:
      return subgroup(VK_SUBGROUP_FEATURE_VOTE_BIT);
    case spv::CapabilityGroupNonUniformArithmetic:
      return subgroup(VK_SUBGROUP_FEATURE_ARITHMETIC_BIT);
    case spv::CapabilityGroupNonUniformBallot:
      return subgroup(VK_SUBGROUP_FEATURE_BALLOT_BIT);
    case spv::CapabilityGroupNonUniformShuffle:
      return subgroup(VK_SUBGROUP_FEATURE_SHUFFLE_BIT);
    case spv::CapabilityGroupNonUniformShuffleRelative:
      return subgroup(VK_SUBGROUP_FEATURE_SHUFFLE_RELATIVE_BIT);
    case spv::CapabilityGroupNonUniformClustered:
      return subgroup(VK_SUBGROUP_FEATURE_CLUSTERED_BIT);
    case spv::CapabilityGroupNonUniformQuad:
      return subgroup(VK_SUBGROUP_FEATURE_QUAD_BIT);
    default:
      return false;
  }
}

void requireDeviceCan(const Core& core, const ShaderInterface& shader) {
  for (std::uint32_t capability : shader.capabilities) {
    if (serves(core, capability)) continue;
    throw Error(Exit::noDevice,
                "the shader needs " + capabilityName(capability) + ", which " + core.info.name + " does not offer");
  }
  const DeviceLimits& limits = core.info.limits;
  std::uint64_t invocations = 1;
  for (int axis = 0; axis < 3; ++axis) {
    invocations *= shader.workGroupSize[axis];
    if (shader.workGroupSize[axis] > limits.maxWorkGroupSize[axis]) {
      throw Error(Exit::noDevice, std::string("the shader's workgroup is ") +
                                      std::to_string(shader.workGroupSize[axis]) + " wide in " + "xyz"[axis] +
                                      ", but " + core.info.name + " allows " +
                                      std::to_string(limits.maxWorkGroupSize[axis]));
    }
  }
  if (invocations > limits.maxWorkGroupInvocations) {
    throw Error(Exit::noDevice, "the shader's workgroup has " + std::to_string(invocations) + " invocations, but " +
                                    core.info.name + " allows " + std::to_string(limits.maxWorkGroupInvocations));
  }
  if (shader.pushConstantBytes > core.maxPushConstantsSize) {
    throw Error(Exit::noDevice, "the shader has " + std::to_string(shader.pushConstantBytes) +
                                    " bytes of push constants, but " + core.info.name + " allows " +
                                    std::to_string(core.maxPushConstantsSize));
  }
}

}  // namespace

Pipeline::Pipeline(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Pipeline::Pipeline(Pipeline&&) noexcept = default;
Pipeline& Pipeline::operator=(Pipeline&&) noexcept = default;
Pipeline::~Pipeline() = default;

Pipeline Device::makePipeline(std::span<const std::uint32_t> whole, const Specialisation& specialisation,
                              const std::string& name) {
  const Core& core = *impl_->core;
  auto impl = std::make_unique<Pipeline::Impl>();
  impl->core = impl_->core;
  readInterface(whole, specialisation);  // refuses what is no module of ours, before it is cut
  const std::vector<std::uint32_t> spirv = specialised(whole, {specialisation.begin(), specialisation.end()});
  impl->interface = readInterface(spirv, {});
  impl->spirvBytes = spirv.size() * sizeof spirv[0];
  const ShaderInterface& shader = impl->interface;
  requireDeviceCan(core, shader);
  if (impl_->watcher) impl_->watcher(name, whole, spirv);

  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const auto& binding : shader.bindings) {
    bindings.push_back({.binding = binding.number,
                        .descriptorType = descriptorType(binding.kind),
                        .descriptorCount = 1,
                        .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
                        .pImmutableSamplers = nullptr});
  }
  const VkDescriptorSetLayoutCreateInfo setInfo{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                .bindingCount = std::uint32_t(bindings.size()),
                                                .pBindings = bindings.data()};
  VkDescriptorSetLayout setLayout{};
  check(core.vkCreateDescriptorSetLayout(core.device, &setInfo, nullptr, &setLayout), "lay out bindings");
  impl->setLayout = {core.device, setLayout, core.vkDestroyDescriptorSetLayout};

  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, (shader.pushConstantBytes + 3) / 4 * 4};
  const VkPipelineLayoutCreateInfo layoutInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = 1,
                                              .pSetLayouts = &setLayout,
                                              .pushConstantRangeCount = range.size > 0 ? 1u : 0u,
                                              .pPushConstantRanges = &range};
  VkPipelineLayout layout{};
  check(core.vkCreatePipelineLayout(core.device, &layoutInfo, nullptr, &layout), "lay out a pipeline");
  impl->layout = {core.device, layout, core.vkDestroyPipelineLayout};

  const VkShaderModuleCreateInfo moduleInfo{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = impl->spirvBytes, .pCode = spirv.data()};
  VkShaderModule module{};
  check(core.vkCreateShaderModule(core.device, &moduleInfo, nullptr, &module), "load a shader module");
  const OfDevice<VkShaderModule> moduleOwner(core.device, module, core.vkDestroyShaderModule);

  const VkComputePipelineCreateInfo pipelineInfo{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                                 .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                                           .pNext = nullptr,
                                                           .flags = 0,
                                                           .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                                                           .module = module,
                                                           .pName = shader.entryPoint.c_str(),
                                                           .pSpecializationInfo = nullptr},
                                                 .layout = layout};
  VkPipeline pipeline{};
  const VkResult result = core.vkCreateComputePipelines(core.device, {}, 1, &pipelineInfo, nullptr, &pipeline);
  if (result != VK_SUCCESS) {
    throw Error(Exit::shader,
                core.info.name + " does not take the shader module (Vulkan result " + std::to_string(result) + ")");
  }
  impl->pipeline = {core.device, pipeline, core.vkDestroyPipeline};
  return Pipeline(std::move(impl));
}

std::size_t Pipeline::spirvBytes() const { return impl_->spirvBytes; }

}  // namespace solidcast::gpu
