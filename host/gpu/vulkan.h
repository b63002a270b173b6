// The Vulkan loader, opened at run time: what never casts a ray never loads a driver, and a machine without a loader
// gets a clear line. Only host/gpu/*.cpp include this file.
#pragma once
#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

#include <memory>
#include <utility>
#include <vector>

#include "host/gpu/device.h"

// Vulkan's structs are meant to be filled in part.
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

// Entry points by the level at which they are looked up.
#define SOLIDCAST_GLOBAL_FUNCTIONS(X) \
  X(vkCreateInstance)                 \
  X(vkEnumerateInstanceVersion)       \
  X(vkEnumerateInstanceLayerProperties)
#define SOLIDCAST_INSTANCE_FUNCTIONS(X)       \
  X(vkDestroyInstance)                        \
  X(vkEnumeratePhysicalDevices)               \
  X(vkGetPhysicalDeviceProperties2)           \
  X(vkGetPhysicalDeviceFeatures2)             \
  X(vkGetPhysicalDeviceMemoryProperties)      \
  X(vkGetPhysicalDeviceQueueFamilyProperties) \
  X(vkCreateDevice)                           \
  X(vkGetDeviceProcAddr)
#define SOLIDCAST_DEVICE_FUNCTIONS(X) \
  X(vkDestroyDevice)                  \
  X(vkGetDeviceQueue)                 \
  X(vkGetBufferDeviceAddress)         \
  X(vkAllocateMemory)                 \
  X(vkFreeMemory)                     \
  X(vkMapMemory)                      \
  X(vkCreateBuffer)                   \
  X(vkDestroyBuffer)                  \
  X(vkCreateBufferView)               \
  X(vkDestroyBufferView)              \
  X(vkGetBufferMemoryRequirements)    \
  X(vkBindBufferMemory)               \
  X(vkCreateShaderModule)             \
  X(vkDestroyShaderModule)            \
  X(vkCreateDescriptorSetLayout)      \
  X(vkDestroyDescriptorSetLayout)     \
  X(vkCreatePipelineLayout)           \
  X(vkDestroyPipelineLayout)          \
  X(vkCreateComputePipelines)         \
  X(vkDestroyPipeline)                \
  X(vkCreateDescriptorPool)           \
  X(vkDestroyDescriptorPool)          \
  X(vkResetDescriptorPool)            \
  X(vkAllocateDescriptorSets)         \
  X(vkUpdateDescriptorSets)           \
  X(vkCreateCommandPool)              \
  X(vkDestroyCommandPool)             \
  X(vkResetCommandPool)               \
  X(vkAllocateCommandBuffers)         \
  X(vkBeginCommandBuffer)             \
  X(vkEndCommandBuffer)               \
  X(vkCreateQueryPool)                \
  X(vkDestroyQueryPool)               \
  X(vkGetQueryPoolResults)            \
  X(vkCreateFence)                    \
  X(vkDestroyFence)                   \
  X(vkResetFences)                    \
  X(vkWaitForFences)                  \
  X(vkQueueSubmit)                    \
  X(vkCmdBindPipeline)                \
  X(vkCmdBindDescriptorSets)          \
  X(vkCmdPushConstants)               \
  X(vkCmdDispatch)                    \
  X(vkCmdPipelineBarrier)             \
  X(vkCmdResetQueryPool)              \
  X(vkCmdWriteTimestamp)

namespace solidcast::gpu {

/// Throws Exit::noDevice "Vulkan: could not WHAT: VK_ERROR_..." unless the result is VK_SUCCESS.
void check(VkResult result, const char* what);

/// A handle made from a device (or instance) and destroyed with it as first argument.
template <class Owner, class T>
class Owned {
 public:
  using Destroy = void(VKAPI_PTR*)(Owner, T, const VkAllocationCallbacks*);
  Owned() = default;
  Owned(Owner owner, T handle, Destroy destroy) : owner_(owner), handle_(handle), destroy_(destroy) {}
  Owned(Owned&& other) noexcept
      : owner_(other.owner_), handle_(std::exchange(other.handle_, T{})), destroy_(other.destroy_) {}
  Owned& operator=(Owned&& other) noexcept {
    std::swap(owner_, other.owner_);
    std::swap(handle_, other.handle_);
    std::swap(destroy_, other.destroy_);
    return *this;
  }
  ~Owned() {
    if (handle_) destroy_(owner_, handle_, nullptr);
  }
  T get() const { return handle_; }

 private:
  Owner owner_{};
  T handle_{};
  Destroy destroy_ = nullptr;
};
template <class T>
using OfDevice = Owned<VkDevice, T>;

/// A Vulkan instance with its functions, and the count of validation messages.
class Instance {
 public:
  /// Throws Exit::noDevice when there is no loader or no driver; Exit::usage for `on` without the layer.
  explicit Instance(Validation validation);
  ~Instance();
  Instance(const Instance&) = delete;

  VkInstance get() const { return instance_; }
  bool validating() const { return validating_; }
  int messages() const { return messages_; }
  double milliseconds() const { return milliseconds_; }

  /// In the loader's order; throws Exit::noDevice for none.
  std::vector<VkPhysicalDevice> devices() const;
  DeviceInfo describe(VkPhysicalDevice device, int index) const;

#define X(name) PFN_##name name = nullptr;
  SOLIDCAST_INSTANCE_FUNCTIONS(X)
#undef X

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                                  VkDebugUtilsMessageTypeFlagsEXT,
                                                  const VkDebugUtilsMessengerCallbackDataEXT*, void* self);
  VkInstance instance_{};
  VkDebugUtilsMessengerEXT messenger_{};
  PFN_vkDestroyDebugUtilsMessengerEXT destroyMessenger_ = nullptr;
  bool validating_ = false;
  int messages_ = 0;
  double milliseconds_ = 0;
};

}  // namespace solidcast::gpu
