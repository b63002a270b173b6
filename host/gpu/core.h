// What lives behind Device, Buffer and Pipeline. They share the Core, so that they may die in any order.
#pragma once
#include "host/gpu/shader_interface.h"
#include "host/gpu/vulkan.h"

namespace solidcast::gpu {

struct Core {
  Core(const Device::Options& options);
  ~Core();
  Core(const Core&) = delete;

  Instance instance;  // dies last
  VkPhysicalDevice physical{};
  DeviceInfo info;
  VkPhysicalDeviceMemoryProperties memory{};
  std::uint32_t maxPushConstantsSize = 0;
  VkSubgroupFeatureFlags subgroupOperations = 0;  // 0 where compute shaders have none
  std::uint32_t queueFamily = 0, timestampBits = 0;
  VkDevice device{};
  VkQueue queue{};
  double milliseconds = 0;
  std::uint64_t bytesAllocated = 0, peakBytes = 0;

#define X(name) PFN_##name name = nullptr;
  SOLIDCAST_DEVICE_FUNCTIONS(X)
#undef X

 private:
  void findQueueFamily();
};

struct Buffer::Impl {
  std::shared_ptr<Core> core;
  OfDevice<VkDeviceMemory> memory;
  OfDevice<VkBuffer> buffer;    // dies before its memory
  OfDevice<VkBufferView> view;  // of texels
  std::size_t bytes = 0, allocated = 0;
  BufferUse use{};
  std::byte* mapping = nullptr;
  ~Impl() { core->bytesAllocated -= allocated; }
};

VkDescriptorType descriptorType(ShaderInterface::Kind kind);

struct Pipeline::Impl {
  std::shared_ptr<Core> core;
  ShaderInterface interface;
  OfDevice<VkDescriptorSetLayout> setLayout;
  OfDevice<VkPipelineLayout> layout;
  OfDevice<VkPipeline> pipeline;
  std::size_t spirvBytes = 0;
};

/// Records and submits; keeps its pools between calls, so that a call costs little beside the dispatches.
class Runner {
 public:
  explicit Runner(std::shared_ptr<Core> core);
  double run(std::span<const Dispatch> dispatches, const std::function<void()>& meanwhile);

 private:
  struct Bound {
    const Pipeline::Impl* pipeline = nullptr;
    std::vector<const Buffer::Impl*> buffers;
  };
  Bound checked(const Dispatch& dispatch) const;
  void reserveDescriptors(std::size_t sets, std::size_t buffers);
  VkDescriptorSet descriptorSet(const Bound& bound);
  void record(std::span<const Dispatch> dispatches, std::span<const Bound> bound);

  std::shared_ptr<Core> core_;
  OfDevice<VkCommandPool> commandPool_;
  VkCommandBuffer commands_{};
  OfDevice<VkQueryPool> timestamps_;
  OfDevice<VkFence> fence_;
  OfDevice<VkDescriptorPool> descriptorPool_;
  std::size_t setCapacity_ = 0, bufferCapacity_ = 0;
};

struct Device::Impl {
  std::shared_ptr<Core> core;
  Runner runner;
  ModuleWatcher watcher = {};
};

}  // namespace solidcast::gpu
