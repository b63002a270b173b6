#include "host/gpu/device.h"

#include <algorithm>
#include <chrono>

#include "host/error.h"
#include "host/gpu/core.h"
#include "host/gpu/select.h"

namespace solidcast::gpu {

// --- the device itself ----------------------------------------------------------------------------

Core::Core(const Device::Options& options) : instance(options.validation) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<VkPhysicalDevice> devices = instance.devices();
  std::vector<DeviceInfo> infos;
  for (VkPhysicalDevice each : devices) infos.push_back(instance.describe(each, int(infos.size())));
  const std::size_t chosen = selectDevice(infos, options.select);
  physical = devices[chosen];
  info = infos[chosen];

  VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
  instance.vkGetPhysicalDeviceProperties2(physical, &properties);
  if (properties.properties.apiVersion < VK_API_VERSION_1_1) {
    throw Error(Exit::noDevice, "device " + info.name + " offers Vulkan " + info.apiVersion + "; 1.1 is needed");
  }
  properties.pNext = &subgroup;
  instance.vkGetPhysicalDeviceProperties2(physical, &properties);
  maxPushConstantsSize = properties.properties.limits.maxPushConstantsSize;
  if (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) subgroupOperations = subgroup.supportedOperations;
  instance.vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  findQueueFamily();

  // These three cost nothing where they exist; modules that use them are checked one by one.
  const VkPhysicalDeviceFeatures features{.shaderFloat64 = info.float64, .shaderInt64 = info.int64};
  VkPhysicalDeviceBufferDeviceAddressFeatures addresses{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES, .bufferDeviceAddress = VK_TRUE};
  const float priority = 1;
  const VkDeviceQueueCreateInfo queueInfo{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                          .queueFamilyIndex = queueFamily,
                                          .queueCount = 1,
                                          .pQueuePriorities = &priority};
  const VkDeviceCreateInfo deviceInfo{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = info.bufferAddresses ? &addresses : nullptr,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queueInfo,
                                      .pEnabledFeatures = &features};
  check(instance.vkCreateDevice(physical, &deviceInfo, nullptr, &device), "open the device");
#define X(name) name = reinterpret_cast<PFN_##name>(instance.vkGetDeviceProcAddr(device, #name));
  SOLIDCAST_DEVICE_FUNCTIONS(X)
#undef X
  vkGetDeviceQueue(device, queueFamily, 0, &queue);
  milliseconds = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Core::~Core() {
  if (device) vkDestroyDevice(device, nullptr);
}

/// The first family that computes; one with timestamps before one without.
void Core::findQueueFamily() {
  std::uint32_t count = 0;
  instance.vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  instance.vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  bool found = false;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!(families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
    if (found && (timestampBits > 0 || families[i].timestampValidBits == 0)) continue;
    found = true;
    queueFamily = i;
    timestampBits = families[i].timestampValidBits;
  }
  if (!found) throw Error(Exit::noDevice, "device " + info.name + " has no queue that computes");
  if (timestampBits == 0) info.limits.timestampPeriod = 0;
}

std::vector<DeviceInfo> listDevices() {
  const Instance instance(Validation::off);
  std::vector<DeviceInfo> list;
  for (VkPhysicalDevice device : instance.devices()) list.push_back(instance.describe(device, int(list.size())));
  return list;
}

Device::Device(const Options& options) {
  auto core = std::make_shared<Core>(options);
  impl_ = std::make_unique<Impl>(core, Runner(core));
}
Device::~Device() = default;

const DeviceInfo& Device::info() const { return impl_->core->info; }
bool Device::validationActive() const { return impl_->core->instance.validating(); }
int Device::validationMessages() const { return impl_->core->instance.messages(); }
void Device::watchModules(ModuleWatcher watcher) { impl_->watcher = std::move(watcher); }
std::uint64_t Device::bytesAllocated() const { return impl_->core->bytesAllocated; }
std::uint64_t Device::peakBytes() const { return impl_->core->peakBytes; }
double Device::instanceMilliseconds() const { return impl_->core->instance.milliseconds(); }
double Device::deviceMilliseconds() const { return impl_->core->milliseconds; }
double Device::run(std::span<const Dispatch> dispatches, const std::function<void()>& meanwhile) {
  return impl_->runner.run(dispatches, meanwhile);
}

// --- buffers --------------------------------------------------------------------------------------

namespace {

/// Memory types that serve, best first. All are mapped and coherent; what differs is on which side they are quick.
std::vector<std::uint32_t> memoryTypes(const Core& core, std::uint32_t allowed, BufferUse use) {
  constexpr VkMemoryPropertyFlags needed = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  const bool ownMemory = core.info.type == "discrete gpu" && use != BufferUse::readback;
  const VkMemoryPropertyFlags first =
      ownMemory ? VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT : VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  std::vector<std::uint32_t> types;
  for (std::uint32_t i = 0; i < core.memory.memoryTypeCount; ++i) {
    if ((allowed >> i & 1) && (core.memory.memoryTypes[i].propertyFlags & needed) == needed) types.push_back(i);
  }
  std::stable_partition(types.begin(), types.end(),
                        [&](std::uint32_t i) { return core.memory.memoryTypes[i].propertyFlags & first; });
  return types;
}

void requireAtMost(std::uint64_t bytes, std::uint64_t limit, const char* what, const Core& core) {
  if (bytes <= limit) return;
  throw Error(Exit::usage, std::string(what) + " of " + std::to_string(bytes) + " bytes is needed, but " +
                               core.info.name + " allows " + std::to_string(limit));
}

}  // namespace

Buffer::Buffer() = default;
Buffer::Buffer(Buffer&&) noexcept = default;
Buffer& Buffer::operator=(Buffer&&) noexcept = default;
Buffer::~Buffer() = default;

std::span<std::byte> Buffer::bytes() const {
  return impl_ ? std::span<std::byte>(impl_->mapping, impl_->bytes) : std::span<std::byte>();
}

std::uint64_t Buffer::address() const {
  const Core& core = *impl_->core;
  const VkBufferDeviceAddressInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
                                       .buffer = impl_->buffer.get()};
  return core.vkGetBufferDeviceAddress(core.device, &info);
}

Buffer Device::makeBuffer(std::size_t bytes, BufferUse use) {
  Core& core = *impl_->core;
  const bool uniform = use == BufferUse::uniform, texels = use == BufferUse::texels;
  constexpr std::uint64_t texelBytes = 16;
  if (uniform) {
    requireAtMost(bytes, core.info.limits.maxUniformBufferRange, "a uniform buffer", core);
  } else if (texels) {
    requireAtMost(bytes, core.info.limits.maxTexelBufferElements * texelBytes, "a texel buffer", core);
  } else {
    requireAtMost(bytes, core.info.limits.maxStorageBufferRange, "a storage buffer", core);
  }
  requireAtMost(bytes, core.info.limits.maxMemoryAllocationSize, "an allocation", core);

  auto impl = std::make_unique<Buffer::Impl>();
  impl->core = impl_->core;
  impl->bytes = bytes;
  impl->use = use;
  const bool addressed = uniform && core.info.bufferAddresses;
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .size = std::max<std::size_t>(bytes, 16),  // Vulkan has no empty buffers
                                .usage = VkBufferUsageFlags(uniform  ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT
                                                            : texels ? VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT
                                                                     : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) |
                                         VkBufferUsageFlags(addressed ? VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT : 0)};
  VkBuffer buffer{};
  check(core.vkCreateBuffer(core.device, &info, nullptr, &buffer), "make a buffer");
  impl->buffer = {core.device, buffer, core.vkDestroyBuffer};

  VkMemoryRequirements needs{};
  core.vkGetBufferMemoryRequirements(core.device, buffer, &needs);
  VkResult result = VK_ERROR_OUT_OF_DEVICE_MEMORY;
  VkDeviceMemory memory{};
  for (std::uint32_t type : memoryTypes(core, needs.memoryTypeBits, use)) {
    const VkMemoryAllocateFlagsInfo flags{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
                                          .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT};
    const VkMemoryAllocateInfo allocation{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                          .pNext = addressed ? &flags : nullptr,
                                          .allocationSize = needs.size,
                                          .memoryTypeIndex = type};
    result = core.vkAllocateMemory(core.device, &allocation, nullptr, &memory);
    if (result == VK_SUCCESS) break;
  }
  if (result != VK_SUCCESS) {
    throw Error(Exit::usage, core.info.name + " has no memory left for a buffer of " + std::to_string(needs.size) +
                                 " bytes; " + std::to_string(core.bytesAllocated) + " bytes are in use");
  }
  impl->memory = {core.device, memory, core.vkFreeMemory};
  impl->allocated = needs.size;
  core.bytesAllocated += needs.size;
  core.peakBytes = std::max(core.peakBytes, core.bytesAllocated);
  check(core.vkBindBufferMemory(core.device, buffer, memory, 0), "bind a buffer to memory");
  if (texels) {
    const VkBufferViewCreateInfo viewInfo{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                          .buffer = buffer,
                                          .format = VK_FORMAT_R32G32B32A32_UINT,
                                          .range = std::max(bytes / texelBytes, std::size_t{1}) * texelBytes};
    VkBufferView view{};
    check(core.vkCreateBufferView(core.device, &viewInfo, nullptr, &view), "view a buffer as texels");
    impl->view = {core.device, view, core.vkDestroyBufferView};
  }
  void* mapping = nullptr;
  check(core.vkMapMemory(core.device, memory, 0, VK_WHOLE_SIZE, 0, &mapping), "map memory");
  impl->mapping = static_cast<std::byte*>(mapping);

  Buffer out;
  out.impl_ = std::move(impl);
  return out;
}

}  // namespace solidcast::gpu
