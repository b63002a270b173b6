#include "host/gpu/vulkan.h"

#include <dlfcn.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "host/error.h"
#include "host/gpu/select.h"

namespace solidcast::gpu {
namespace {

constexpr const char* validationLayer = "VK_LAYER_KHRONOS_validation";

/// The loader's entry points. The loader stays open until the program ends: drivers do not like to be unloaded.
struct Loader {
  PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr = nullptr;
#define X(name) PFN_##name name = nullptr;
  SOLIDCAST_GLOBAL_FUNCTIONS(X)
#undef X

  Loader() {
    // Nobody else's choice is overruled: 0 leaves a variable that is set alone.
    if (const std::string idle = driversWithoutHardware("/dev");
        !idle.empty() && !std::getenv("VK_LOADER_DRIVERS_SELECT"))
      setenv("VK_LOADER_DRIVERS_DISABLE", idle.c_str(), 0);
    void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library) throw Error(Exit::noDevice, noDeviceMessage("the loader libvulkan.so.1 is not installed"));
    vkGetInstanceProcAddr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
    if (!vkGetInstanceProcAddr) throw Error(Exit::noDevice, noDeviceMessage("libvulkan.so.1 is no Vulkan loader"));
#define X(name) name = reinterpret_cast<PFN_##name>(vkGetInstanceProcAddr(nullptr, #name));
    SOLIDCAST_GLOBAL_FUNCTIONS(X)
#undef X
    if (!vkEnumerateInstanceVersion)
      throw Error(Exit::noDevice, noDeviceMessage("the loader is older than Vulkan 1.1"));
  }
};

const Loader& loader() {
  static const Loader once;
  return once;
}

bool layerInstalled(const char* name) {
  std::uint32_t count = 0;
  check(loader().vkEnumerateInstanceLayerProperties(&count, nullptr), "list layers");
  std::vector<VkLayerProperties> layers(count);
  check(loader().vkEnumerateInstanceLayerProperties(&count, layers.data()), "list layers");
  for (const auto& layer : layers) {
    if (std::strcmp(layer.layerName, name) == 0) return true;
  }
  return false;
}

bool wantsValidation(Validation validation) {
  if (validation == Validation::off) return false;
  if (validation == Validation::automatic) {
    const char* wish = std::getenv("SOLIDCAST_VALIDATION");
    return wish && std::strcmp(wish, "1") == 0 && layerInstalled(validationLayer);
  }
  if (layerInstalled(validationLayer)) return true;
  throw Error(Exit::usage, std::string("validation is on, but the layer ") + validationLayer +
                               " is not installed (Debian: apt-get install vulkan-validationlayers); "
                               "without it use --validation auto or off");
}

const char* typeName(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "cpu";
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete gpu";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated gpu";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual gpu";
    default:
      return "other";
  }
}

const char* resultName(VkResult result) {
  switch (result) {
    case VK_NOT_READY:
      return "VK_NOT_READY";
    case VK_TIMEOUT:
      return "VK_TIMEOUT";
    case VK_INCOMPLETE:
      return "VK_INCOMPLETE";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
      return "VK_ERROR_OUT_OF_HOST_MEMORY";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
      return "VK_ERROR_OUT_OF_DEVICE_MEMORY";
    case VK_ERROR_INITIALIZATION_FAILED:
      return "VK_ERROR_INITIALIZATION_FAILED";
    case VK_ERROR_DEVICE_LOST:
      return "VK_ERROR_DEVICE_LOST";
    case VK_ERROR_MEMORY_MAP_FAILED:
      return "VK_ERROR_MEMORY_MAP_FAILED";
    case VK_ERROR_LAYER_NOT_PRESENT:
      return "VK_ERROR_LAYER_NOT_PRESENT";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
      return "VK_ERROR_EXTENSION_NOT_PRESENT";
    case VK_ERROR_FEATURE_NOT_PRESENT:
      return "VK_ERROR_FEATURE_NOT_PRESENT";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
      return "VK_ERROR_INCOMPATIBLE_DRIVER";
    case VK_ERROR_TOO_MANY_OBJECTS:
      return "VK_ERROR_TOO_MANY_OBJECTS";
    case VK_ERROR_INVALID_SHADER_NV:
      return "VK_ERROR_INVALID_SHADER_NV";
    default:
      return "an error without a name here";
  }
}

std::string versionText(std::uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

}  // namespace

void check(VkResult result, const char* what) {
  if (result == VK_SUCCESS) return;
  throw Error(Exit::noDevice, std::string("Vulkan: could not ") + what + ": " + resultName(result) + " (" +
                                  std::to_string(result) + ")");
}

Instance::Instance(Validation validation) {
  const auto start = std::chrono::steady_clock::now();
  validating_ = wantsValidation(validation);

  VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "solidcast";
  application.apiVersion = VK_API_VERSION_1_2;  // what we may use; devices of 1.1 serve
  VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;

  VkDebugUtilsMessengerCreateInfoEXT messages{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  messages.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messages.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  messages.pfnUserCallback = onMessage;
  messages.pUserData = this;
  const VkValidationFeatureEnableEXT enables[] = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  const VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messages, 1, enables, 0, nullptr};
  const char* const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
  if (validating_) {
    info.pNext = &features;
    info.enabledLayerCount = 1;
    info.ppEnabledLayerNames = &validationLayer;
    info.enabledExtensionCount = 1;
    info.ppEnabledExtensionNames = extensions;
  }

  const VkResult result = loader().vkCreateInstance(&info, nullptr, &instance_);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) throw Error(Exit::noDevice, noDeviceMessage("no driver is usable"));
  check(result, "create an instance");
  const auto address = [this](const char* name) { return loader().vkGetInstanceProcAddr(instance_, name); };
#define X(name) name = reinterpret_cast<PFN_##name>(address(#name));
  SOLIDCAST_INSTANCE_FUNCTIONS(X)
#undef X
  if (validating_) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(address("vkCreateDebugUtilsMessengerEXT"));
    destroyMessenger_ =
        reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(address("vkDestroyDebugUtilsMessengerEXT"));
    check(create(instance_, &messages, nullptr, &messenger_), "listen to validation messages");
  }
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Instance::~Instance() {
  if (messenger_) destroyMessenger_(instance_, messenger_, nullptr);
  vkDestroyInstance(instance_, nullptr);
}

VkBool32 Instance::onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT type,
                             const VkDebugUtilsMessengerCallbackDataEXT* data, void* self) {
  // GENERAL messages come from the loader about other people's drivers; only the layer's own count.
  if (!(type & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT)) return VK_FALSE;
  ++static_cast<Instance*>(self)->messages_;
  std::fprintf(stderr, "Vulkan validation: %s\n", data->pMessage);
  return VK_FALSE;
}

std::vector<VkPhysicalDevice> Instance::devices() const {
  std::uint32_t count = 0;
  // Drivers without hardware may make this fail as a whole: for us that is no device, not another error.
  VkResult result = vkEnumeratePhysicalDevices(instance_, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  if (result == VK_SUCCESS && count > 0) result = vkEnumeratePhysicalDevices(instance_, &count, devices.data());
  if (result != VK_SUCCESS || count == 0) throw Error(Exit::noDevice, noDeviceMessage("no driver offers a device"));
  return devices;
}

DeviceInfo Instance::describe(VkPhysicalDevice device, int index) const {
  VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceMaintenance3Properties maintenance{.sType =
                                                         VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES};
  VkPhysicalDeviceSubgroupProperties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
  VkPhysicalDeviceProperties2 all{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
  vkGetPhysicalDeviceProperties2(device, &all);
  all.pNext = &maintenance;
  maintenance.pNext = &subgroup;
  if (all.properties.apiVersion >= VK_API_VERSION_1_2) subgroup.pNext = &driver;
  vkGetPhysicalDeviceProperties2(device, &all);
  VkPhysicalDeviceFeatures2 features{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceBufferDeviceAddressFeatures addresses{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_BUFFER_DEVICE_ADDRESS_FEATURES};
  if (all.properties.apiVersion >= VK_API_VERSION_1_2) features.pNext = &addresses;
  vkGetPhysicalDeviceFeatures2(device, &features);
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(device, &memory);

  const VkPhysicalDeviceProperties& properties = all.properties;
  const VkPhysicalDeviceLimits& limits = properties.limits;
  DeviceInfo info;
  info.index = index;
  info.name = properties.deviceName;
  info.driver = driver.driverName[0] ? driver.driverName : "driver " + std::to_string(properties.driverVersion);
  info.driverInfo = driver.driverInfo;
  info.apiVersion = versionText(properties.apiVersion);
  info.type = typeName(properties.deviceType);
  info.float64 = features.features.shaderFloat64;
  info.int64 = features.features.shaderInt64;
  info.bufferAddresses = addresses.bufferDeviceAddress;
  info.limits.maxUniformBufferRange = limits.maxUniformBufferRange;
  info.limits.maxStorageBufferRange = limits.maxStorageBufferRange;
  info.limits.maxTexelBufferElements = limits.maxTexelBufferElements;
  info.limits.maxWorkGroupInvocations = limits.maxComputeWorkGroupInvocations;
  for (int axis = 0; axis < 3; ++axis) {
    info.limits.maxWorkGroupCount[axis] = limits.maxComputeWorkGroupCount[axis];
    info.limits.maxWorkGroupSize[axis] = limits.maxComputeWorkGroupSize[axis];
  }
  info.limits.maxMemoryAllocationSize = maintenance.maxMemoryAllocationSize;
  for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    info.limits.heapSize = std::max<std::uint64_t>(info.limits.heapSize, memory.memoryHeaps[i].size);
  }
  info.limits.subgroupSize = subgroup.subgroupSize;
  info.limits.timestampPeriod = limits.timestampComputeAndGraphics ? limits.timestampPeriod : 0;
  return info;
}

}  // namespace solidcast::gpu
