#include <algorithm>
#include <chrono>

#include "host/error.h"
#include "host/gpu/core.h"

namespace solidcast::gpu {

namespace {

ShaderInterface::Kind kindOf(BufferUse use) {
  return use == BufferUse::uniform  ? ShaderInterface::Kind::uniform
         : use == BufferUse::texels ? ShaderInterface::Kind::texels
                                    : ShaderInterface::Kind::storage;
}

}  // namespace

VkDescriptorType descriptorType(ShaderInterface::Kind kind) {
  switch (kind) {
    case ShaderInterface::Kind::uniform:
      return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    case ShaderInterface::Kind::texels:
      return VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    default:
      return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  }
}

Runner::Runner(std::shared_ptr<Core> core) : core_(std::move(core)) {
  const Core& c = *core_;
  const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                         .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
                                         .queueFamilyIndex = c.queueFamily};
  VkCommandPool pool{};
  check(c.vkCreateCommandPool(c.device, &poolInfo, nullptr, &pool), "make a command pool");
  commandPool_ = {c.device, pool, c.vkDestroyCommandPool};
  const VkCommandBufferAllocateInfo commandsInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 .commandPool = pool,
                                                 .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                 .commandBufferCount = 1};
  check(c.vkAllocateCommandBuffers(c.device, &commandsInfo, &commands_), "make a command buffer");

  const VkFenceCreateInfo fenceInfo{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence{};
  check(c.vkCreateFence(c.device, &fenceInfo, nullptr, &fence), "make a fence");
  fence_ = {c.device, fence, c.vkDestroyFence};
  if (c.timestampBits > 0) {
    const VkQueryPoolCreateInfo queryInfo{
        .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryType = VK_QUERY_TYPE_TIMESTAMP, .queryCount = 2};
    VkQueryPool queries{};
    check(c.vkCreateQueryPool(c.device, &queryInfo, nullptr, &queries), "make a query pool");
    timestamps_ = {c.device, queries, c.vkDestroyQueryPool};
  }
}

/// The dispatch with its buffers in the order of the shader's bindings, after everything that could be wrong.
Runner::Bound Runner::checked(const Dispatch& dispatch) const {
  Bound bound{dispatch.pipeline->impl_.get(), {}};
  for (const auto& binding : bound.pipeline->interface.bindings) {
    const std::string name = "binding " + std::to_string(binding.number) + " (" + binding.name + ")";
    const Buffer* buffer = binding.number < dispatch.buffers.size() ? dispatch.buffers[binding.number] : nullptr;
    if (!buffer || !buffer->impl_) throw Error(Exit::shader, "the shader's " + name + " was given no buffer");
    if (kindOf(buffer->impl_->use) != binding.kind) {
      throw Error(Exit::shader,
                  "the shader's " + name + " is " + kindName(binding.kind) + ", but was given one of another kind");
    }
    bound.buffers.push_back(buffer->impl_.get());
  }
  const std::size_t pushed = dispatch.pushConstants.size(), needed = bound.pipeline->interface.pushConstantBytes;
  if (pushed < needed || (needed == 0 && pushed > 0)) {
    throw Error(Exit::shader, "the shader takes " + std::to_string(needed) +
                                  " bytes of push constants, but was given " + std::to_string(pushed));
  }
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t limit = core_->info.limits.maxWorkGroupCount[axis];
    if (dispatch.groups[axis] <= limit) continue;
    throw Error(Exit::usage, "a dispatch of " + std::to_string(dispatch.groups[axis]) + " workgroups in " +
                                 "xyz"[axis] + " is needed, but " + core_->info.name + " allows " +
                                 std::to_string(limit));
  }
  return bound;
}

/// Gives back all sets of the last run, and makes room for at least these.
void Runner::reserveDescriptors(std::size_t sets, std::size_t buffers) {
  const Core& c = *core_;
  if (descriptorPool_.get() && sets <= setCapacity_ && buffers <= bufferCapacity_) {
    check(c.vkResetDescriptorPool(c.device, descriptorPool_.get(), 0), "reset a descriptor pool");
    return;
  }
  setCapacity_ = std::max<std::size_t>({sets, 2 * setCapacity_, 16});
  bufferCapacity_ = std::max<std::size_t>({buffers, 2 * bufferCapacity_, 64});
  const VkDescriptorPoolSize sizes[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, std::uint32_t(bufferCapacity_)},
                                        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, std::uint32_t(bufferCapacity_)},
                                        {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, std::uint32_t(bufferCapacity_)}};
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = std::uint32_t(setCapacity_),
                                        .poolSizeCount = 3,
                                        .pPoolSizes = sizes};
  VkDescriptorPool pool{};
  check(c.vkCreateDescriptorPool(c.device, &info, nullptr, &pool), "make a descriptor pool");
  descriptorPool_ = {c.device, pool, c.vkDestroyDescriptorPool};
}

VkDescriptorSet Runner::descriptorSet(const Bound& bound) {
  const Core& c = *core_;
  const VkDescriptorSetLayout layout = bound.pipeline->setLayout.get();
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = descriptorPool_.get(),
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &layout};
  VkDescriptorSet set{};
  check(c.vkAllocateDescriptorSets(c.device, &info, &set), "make a descriptor set");
  std::vector<VkDescriptorBufferInfo> ranges(bound.buffers.size());
  std::vector<VkBufferView> views(bound.buffers.size());
  std::vector<VkWriteDescriptorSet> writes;
  for (std::size_t i = 0; i < bound.buffers.size(); ++i) {
    const auto& binding = bound.pipeline->interface.bindings[i];
    ranges[i] = {bound.buffers[i]->buffer.get(), 0, VK_WHOLE_SIZE};
    views[i] = bound.buffers[i]->view.get();
    writes.push_back({.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                      .pNext = nullptr,
                      .dstSet = set,
                      .dstBinding = binding.number,
                      .dstArrayElement = 0,
                      .descriptorCount = 1,
                      .descriptorType = descriptorType(binding.kind),
                      .pImageInfo = nullptr,
                      .pBufferInfo = &ranges[i],
                      .pTexelBufferView = &views[i]});
  }
  c.vkUpdateDescriptorSets(c.device, std::uint32_t(writes.size()), writes.data(), 0, nullptr);
  return set;
}

void Runner::record(std::span<const Dispatch> dispatches, std::span<const Bound> bound) {
  const Core& c = *core_;
  check(c.vkResetCommandPool(c.device, commandPool_.get(), 0), "reset a command pool");
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(c.vkBeginCommandBuffer(commands_, &begin), "record commands");
  if (timestamps_.get()) {
    c.vkCmdResetQueryPool(commands_, timestamps_.get(), 0, 2);
    c.vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT, timestamps_.get(), 0);
  }
  const VkMemoryBarrier written{
      .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
      .srcAccessMask = VK_ACCESS_SHADER_WRITE_BIT,
      .dstAccessMask = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_HOST_READ_BIT};
  const Bound* last = nullptr;
  for (std::size_t i = 0; i < dispatches.size(); ++i) {
    const Dispatch& dispatch = dispatches[i];
    const Pipeline::Impl& pipeline = *bound[i].pipeline;
    const bool samePipeline = last && last->pipeline == &pipeline;
    if (!samePipeline) c.vkCmdBindPipeline(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline.get());
    if (!bound[i].buffers.empty() && !(samePipeline && last->buffers == bound[i].buffers)) {
      const VkDescriptorSet set = descriptorSet(bound[i]);
      c.vkCmdBindDescriptorSets(commands_, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.layout.get(), 0, 1, &set, 0,
                                nullptr);
    }
    last = &bound[i];
    if (const std::uint32_t bytes = pipeline.interface.pushConstantBytes; bytes > 0) {
      c.vkCmdPushConstants(commands_, pipeline.layout.get(), VK_SHADER_STAGE_COMPUTE_BIT, 0, bytes,
                           dispatch.pushConstants.data());
    }
    c.vkCmdDispatch(commands_, dispatch.groups[0], dispatch.groups[1], dispatch.groups[2]);
    // For the next dispatch, for the next run, and for the host.
    c.vkCmdPipelineBarrier(commands_, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                           VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &written, 0,
                           nullptr, 0, nullptr);
  }
  if (timestamps_.get()) {
    c.vkCmdWriteTimestamp(commands_, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, timestamps_.get(), 1);
  }
  check(c.vkEndCommandBuffer(commands_), "record commands");
}

double Runner::run(std::span<const Dispatch> dispatches, const std::function<void()>& meanwhile) {
  const Core& c = *core_;
  std::vector<Bound> bound;
  std::size_t buffers = 0;
  for (const Dispatch& dispatch : dispatches) {
    bound.push_back(checked(dispatch));
    buffers += bound.back().buffers.size();
  }
  reserveDescriptors(dispatches.size(), buffers);
  record(dispatches, bound);

  const auto start = std::chrono::steady_clock::now();
  const VkSubmitInfo submit{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands_};
  const VkFence fence = fence_.get();
  check(c.vkQueueSubmit(c.queue, 1, &submit, fence), "submit work to the device");
  if (meanwhile) meanwhile();
  check(c.vkWaitForFences(c.device, 1, &fence, VK_TRUE, UINT64_MAX), "wait for the device");
  check(c.vkResetFences(c.device, 1, &fence), "reset a fence");
  if (!timestamps_.get()) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }
  std::uint64_t ticks[2] = {};
  check(c.vkGetQueryPoolResults(c.device, timestamps_.get(), 0, 2, sizeof ticks, ticks, sizeof ticks[0],
                                VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "read timestamps");
  const std::uint64_t valid = c.timestampBits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << c.timestampBits) - 1;
  return double((ticks[1] - ticks[0]) & valid) * c.info.limits.timestampPeriod * 1e-6;
}

}  // namespace solidcast::gpu
