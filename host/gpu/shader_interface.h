// What a compute module wants from the host, read from the SPIR-V itself, so that no binding is typed twice.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace solidcast::gpu {

struct ShaderInterface {
  enum class Kind { storage, uniform, texels };
  struct Binding {
    std::uint32_t number = 0;
    Kind kind = Kind::storage;
    std::string name;  // as in the source, for messages; may be empty
  };
  std::string entryPoint;
  std::vector<Binding> bindings;            // of set 0, by number
  std::uint32_t pushConstantBytes = 0;      // 0: none
  std::vector<std::uint32_t> capabilities;  // SpvCapability numbers
  std::array<std::uint32_t, 3> workGroupSize{1, 1, 1};
  std::map<std::uint32_t, std::uint32_t> specialisationDefaults;  // by constant_id
};

/// `specialisation` (by constant_id) matters for the workgroup's size alone. Throws Exit::shader for what is no SPIR-V
/// compute module, and for resources that this project has no use for (images, samplers of any but texel buffers, sets above 0).
ShaderInterface readInterface(std::span<const std::uint32_t> spirv,
                              const std::map<std::uint32_t, std::uint32_t>& specialisation);

/// "Float64", ...; the number as text for the ones without a name here.
const char* kindName(ShaderInterface::Kind kind);  // "a storage buffer", ...
std::string capabilityName(std::uint32_t capability);

}  // namespace solidcast::gpu
