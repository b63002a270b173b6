// A Vulkan device behind a plain interface: compute pipelines, buffers, dispatches with timestamps.
// Only host/gpu includes Vulkan headers (they are slow to compile).
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace solidcast::gpu {

enum class Validation { automatic, on, off };  // automatic: on where the layer is installed and SOLIDCAST_VALIDATION=1

struct DeviceLimits {
  std::uint32_t maxUniformBufferRange, maxStorageBufferRange, maxTexelBufferElements, maxWorkGroupInvocations;
  std::uint32_t maxWorkGroupCount[3], maxWorkGroupSize[3];
  std::uint64_t maxMemoryAllocationSize, heapSize;
  std::uint32_t subgroupSize;
  float timestampPeriod;  // ns per tick; 0: no timestamps
};

struct DeviceInfo {
  int index = 0;  // as counted by the Vulkan loader
  std::string name, driver, driverInfo, apiVersion;
  std::string type;  // "cpu", "discrete gpu", "integrated gpu", "virtual gpu", "other"
  bool float64 = false, int64 = false, bufferAddresses = false;
  DeviceLimits limits{};
};

/// Every Vulkan device of the machine. Throws Exit::noDevice when there is no loader or driver, with what was looked for.
std::vector<DeviceInfo> listDevices();

/// Values by constant_id; every SPIR-V specialisation constant of the project is 32 bits wide.
using Specialisation = std::map<std::uint32_t, std::uint32_t>;

class Buffer {  // host-visible, persistently mapped; moved, never copied
 public:
  Buffer();
  Buffer(Buffer&&) noexcept;
  Buffer& operator=(Buffer&&) noexcept;
  ~Buffer();
  std::span<std::byte> bytes() const;  // the mapping; empty for a default-made buffer
  /// Of a uniform buffer, for shaders that read it by a reference among their push constants; it must outlive their run.
  /// Only on devices with bufferAddresses.
  std::uint64_t address() const;
  template <class T>
  std::span<T> as() const {
    return {reinterpret_cast<T*>(bytes().data()), bytes().size() / sizeof(T)};
  }

 private:
  friend class Device;
  friend class Runner;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// `readback` is a storage buffer that shaders write and the host reads: on a discrete GPU it lies in cached host
/// memory, the others in the device's own memory where that can be mapped.
/// `texels` is read by number as rows of four 32-bit words (usamplerBuffer): what lanes load from places of their own
/// comes quickest from there (docs/performance-notes.md).
enum class BufferUse { uniform, storage, readback, texels };

class Pipeline {
 public:
  Pipeline(Pipeline&&) noexcept;
  Pipeline& operator=(Pipeline&&) noexcept;
  ~Pipeline();
  std::size_t spirvBytes() const;  // of the module as the driver got it, specialised

 private:
  friend class Device;
  friend class Runner;
  struct Impl;
  explicit Pipeline(std::unique_ptr<Impl>);
  std::unique_ptr<Impl> impl_;
};

struct Dispatch {
  const Pipeline* pipeline;
  std::vector<const Buffer*> buffers;  // by binding number; nullptr where the shader has no such binding
  std::span<const std::byte> pushConstants;
  std::uint32_t groups[3] = {1, 1, 1};
};

class Device {
 public:
  struct Options {
    std::string select = "";  // "", number, part of a name, "cpu", "gpu"; "" takes a GPU before a CPU
    Validation validation = Validation::automatic;
  };
  explicit Device(const Options&);
  ~Device();
  Device(const Device&) = delete;

  const DeviceInfo& info() const;
  bool validationActive() const;
  /// Number of validation messages of warning or error severity so far (each was printed on standard error).
  int validationMessages() const;

  /// Contents are undefined. A size beyond the device's limits throws Exit::usage with both numbers.
  Buffer makeBuffer(std::size_t bytes, BufferUse use);
  std::uint64_t bytesAllocated() const;  // by makeBuffer, alive now
  std::uint64_t peakBytes() const;

  /// The set-0 bindings (kind and number) and push constant size are read from the SPIR-V itself.
  /// `needsFloat64` and the like are read from its capabilities: missing ones throw Exit::noDevice with the feature's name.
  /// A workgroup beyond the device's limits throws Exit::noDevice with both numbers; SPIR-V that is no compute module
  /// Exit::shader.
  /// The driver gets the module specialised: without the code and bindings that the constants rule out.
  /// `name` is for whoever watches modules.
  Pipeline makePipeline(std::span<const std::uint32_t> whole, const Specialisation& specialisation = {},
                        const std::string& name = "");

  /// From now on `watcher` sees every module that a pipeline is made of: whole, and the very words the driver gets.
  using ModuleWatcher = std::function<void(const std::string& name, std::span<const std::uint32_t> whole,
                                           std::span<const std::uint32_t> given)>;
  void watchModules(ModuleWatcher watcher);

  /// Runs the dispatches in order, each after the writes of the one before; waits for the end.
  /// Returns GPU time in ms by timestamps (wall time where there are none). Push constants may be longer than the
  /// shader's block (a host struct's padding), never shorter. Not for several threads at once.
  /// Throws Exit::shader where buffers or push constants do not fit the shader, Exit::usage (with both numbers) for
  /// more groups than the device allows.
  /// `meanwhile` is called when they have been submitted; it must not touch what they write.
  double run(std::span<const Dispatch> dispatches, const std::function<void()>& meanwhile = {});

  double instanceMilliseconds() const;
  double deviceMilliseconds() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace solidcast::gpu
