#include "host/gpu/shader_interface.h"

#include <algorithm>
#include <glslang/SPIRV/spirv.hpp>

#include "host/error.h"

namespace solidcast::gpu {
namespace {

[[noreturn]] void refuse(const std::string& why) { throw Error(Exit::shader, "shader module: " + why); }

std::string text(std::span<const std::uint32_t> words) {
  const char* begin = reinterpret_cast<const char*>(words.data());
  return {begin, std::find(begin, begin + words.size_bytes(), '\0')};
}

struct Type {
  spv::Op op = spv::OpNop;
  std::vector<std::uint32_t> operands;  // after the result id
};
struct Variable {
  std::uint32_t id = 0, pointerType = 0;
  spv::StorageClass storage{};
};
/// Decorations of an id or of one struct member: the first literal of each.
using Decorations = std::map<std::uint32_t, std::uint32_t>;

/// The instructions we care about, gathered in one pass over the module.
struct Module {
  std::map<std::uint32_t, Type> types;
  std::map<std::uint32_t, std::uint32_t> constants;                // scalar ids: value, or default
  std::map<std::uint32_t, std::vector<std::uint32_t>> composites;  // constituents
  std::map<std::uint32_t, std::string> names;
  std::map<std::uint32_t, Decorations> decorations;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Decorations> memberDecorations;
  std::vector<Variable> variables;

  explicit Module(std::span<const std::uint32_t> spirv, ShaderInterface& out);
  void add(spv::Op op, std::span<const std::uint32_t> operands, ShaderInterface& out);
  std::uint32_t byteSize(std::uint32_t type, std::uint32_t matrixStride = 0) const;
  bool isTexelBuffer(std::uint32_t type) const;
};

Module::Module(std::span<const std::uint32_t> spirv, ShaderInterface& out) {
  constexpr std::size_t headerWords = 5;
  if (spirv.size() < headerWords || spirv[0] != spv::MagicNumber) refuse("this is no SPIR-V");
  for (std::size_t at = headerWords; at < spirv.size();) {
    const std::size_t words = spirv[at] >> spv::WordCountShift;
    if (words == 0 || at + words > spirv.size()) refuse("cut off at word " + std::to_string(at));
    add(spv::Op(spirv[at] & spv::OpCodeMask), spirv.subspan(at + 1, words - 1), out);
    at += words;
  }
}

void Module::add(spv::Op op, std::span<const std::uint32_t> w, ShaderInterface& out) {
  switch (op) {
    case spv::OpCapability:
      out.capabilities.push_back(w[0]);
      break;
    case spv::OpEntryPoint:
      if (w[0] != spv::ExecutionModelGLCompute) refuse("its entry point is no compute shader");
      out.entryPoint = text(w.subspan(2));
      break;
    case spv::OpExecutionMode:
      if (w[1] == spv::ExecutionModeLocalSize) std::copy_n(w.begin() + 2, 3, out.workGroupSize.begin());
      break;
    case spv::OpName:
      names[w[0]] = text(w.subspan(1));
      break;
    case spv::OpDecorate:
      decorations[w[0]][w[1]] = w.size() > 2 ? w[2] : 0;
      break;
    case spv::OpMemberDecorate:
      memberDecorations[{w[0], w[1]}][w[2]] = w.size() > 3 ? w[3] : 0;
      break;
    case spv::OpTypeBool:
    case spv::OpTypeInt:
    case spv::OpTypeFloat:
    case spv::OpTypeVector:
    case spv::OpTypeMatrix:
    case spv::OpTypeArray:
    case spv::OpTypeRuntimeArray:
    case spv::OpTypeStruct:
    case spv::OpTypePointer:
    case spv::OpTypeImage:
    case spv::OpTypeSampledImage:
      types[w[0]] = {op, {w.begin() + 1, w.end()}};
      break;
    case spv::OpConstant:
    case spv::OpSpecConstant:
      constants[w[1]] = w[2];
      break;
    case spv::OpSpecConstantTrue:
      constants[w[1]] = 1;
      break;
    case spv::OpSpecConstantFalse:
      constants[w[1]] = 0;
      break;
    case spv::OpConstantComposite:
    case spv::OpSpecConstantComposite:
      composites[w[1]] = {w.begin() + 2, w.end()};
      break;
    case spv::OpVariable:
      variables.push_back({w[1], w[0], spv::StorageClass(w[2])});
      break;
    default:
      break;
  }
}

/// A sampler of a buffer: texels read by number.
bool Module::isTexelBuffer(std::uint32_t id) const {
  const Type& type = types.at(id);
  if (type.op == spv::OpTypeSampledImage) return isTexelBuffer(type.operands[0]);
  constexpr std::size_t dimension = 1, sampled = 5;
  return type.op == spv::OpTypeImage && type.operands[dimension] == spv::DimBuffer && type.operands[sampled] == 1;
}

/// Bytes from the start to the last member's end, as the offsets and strides in the module say.
std::uint32_t Module::byteSize(std::uint32_t id, std::uint32_t matrixStride) const {
  const Type& type = types.at(id);
  const auto& w = type.operands;
  switch (type.op) {
    case spv::OpTypeInt:
    case spv::OpTypeFloat:
      return w[0] / 8;
    case spv::OpTypePointer:  // a buffer's address
      return 8;
    case spv::OpTypeVector:
      return w[1] * byteSize(w[0]);
    case spv::OpTypeMatrix:
      return w[1] * matrixStride;
    case spv::OpTypeArray:
      return constants.at(w[1]) * decorations.at(id).at(spv::DecorationArrayStride);
    case spv::OpTypeStruct: {
      std::uint32_t end = 0;
      for (std::uint32_t i = 0; i < w.size(); ++i) {
        const Decorations& member = memberDecorations.at({id, i});
        const auto stride = member.find(spv::DecorationMatrixStride);
        end = std::max(end,
                       member.at(spv::DecorationOffset) + byteSize(w[i], stride == member.end() ? 0 : stride->second));
      }
      return end;
    }
    default:
      refuse("a push constant has a type without a size");
  }
}

}  // namespace

ShaderInterface readInterface(std::span<const std::uint32_t> spirv,
                              const std::map<std::uint32_t, std::uint32_t>& specialisation) {
  ShaderInterface out;
  Module module(spirv, out);
  if (out.entryPoint.empty()) refuse("it has no entry point");

  // Constants that the host may set.
  for (const auto& [id, decorations] : module.decorations) {
    const auto spec = decorations.find(spv::DecorationSpecId);
    if (spec == decorations.end()) continue;
    out.specialisationDefaults[spec->second] = module.constants[id];
    if (const auto set = specialisation.find(spec->second); set != specialisation.end()) {
      module.constants[id] = set->second;
    }
  }
  // A workgroup size made of constants overrides the execution mode.
  for (const auto& [id, decorations] : module.decorations) {
    const auto builtIn = decorations.find(spv::DecorationBuiltIn);
    if (builtIn == decorations.end() || builtIn->second != spv::BuiltInWorkgroupSize) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.workGroupSize[axis] = module.constants.at(module.composites.at(id).at(axis));
    }
  }

  for (const Variable& variable : module.variables) {
    const std::uint32_t block = module.types.at(variable.pointerType).operands[1];
    if (variable.storage == spv::StorageClassPushConstant) {
      out.pushConstantBytes = std::max(out.pushConstantBytes, module.byteSize(block));
    }
    const Decorations& own = module.decorations[variable.id];
    if (!own.contains(spv::DecorationBinding)) continue;
    std::string name = module.names[variable.id];
    if (name.empty()) name = module.names[block];
    const std::uint32_t number = own.at(spv::DecorationBinding);
    const bool storage = variable.storage == spv::StorageClassStorageBuffer ||
                         module.decorations[block].contains(spv::DecorationBufferBlock);
    const bool uniform = variable.storage == spv::StorageClassUniform && !storage;
    const bool texels = variable.storage == spv::StorageClassUniformConstant && module.isTexelBuffer(block);
    if (!storage && !uniform && !texels)
      refuse("binding " + std::to_string(number) + " (" + name + ") is not a buffer");
    if (const auto set = own.find(spv::DecorationDescriptorSet); set != own.end() && set->second != 0) {
      refuse("binding " + std::to_string(number) + " (" + name + ") is in set " + std::to_string(set->second) +
             "; only set 0 is used");
    }
    using Kind = ShaderInterface::Kind;
    out.bindings.push_back({number, storage ? Kind::storage : uniform ? Kind::uniform : Kind::texels, name});
  }
  std::sort(out.bindings.begin(), out.bindings.end(),
            [](const auto& a, const auto& b) { return std::pair(a.number, a.kind) < std::pair(b.number, b.kind); });
  // One buffer may be seen as several types (float and uint, say) at the same binding.
  const auto same = [](const auto& a, const auto& b) { return a.number == b.number && a.kind == b.kind; };
  out.bindings.erase(std::unique(out.bindings.begin(), out.bindings.end(), same), out.bindings.end());
  for (std::size_t i = 1; i < out.bindings.size(); ++i) {
    if (out.bindings[i].number == out.bindings[i - 1].number) {
      refuse("binding " + std::to_string(out.bindings[i].number) + " is both " + kindName(out.bindings[i - 1].kind) +
             " and " + kindName(out.bindings[i].kind) + " (" + out.bindings[i - 1].name + ", " + out.bindings[i].name +
             ")");
    }
  }
  return out;
}

const char* kindName(ShaderInterface::Kind kind) {
  switch (kind) {
    case ShaderInterface::Kind::storage:
      return "a storage buffer";
    case ShaderInterface::Kind::uniform:
      return "a uniform buffer";
    case ShaderInterface::Kind::texels:
      return "a texel buffer";
  }
  return "";
}

std::string capabilityName(std::uint32_t capability) {
  switch (capability) {
    case spv::CapabilityFloat16:
      return "Float16";
    case spv::CapabilityFloat64:
      return "Float64";
    case spv::CapabilityInt8:
      return "Int8";
    case spv::CapabilityInt16:
      return "Int16";
    case spv::CapabilityInt64:
      return "Int64";
    case spv::CapabilityInt64Atomics:
      return "Int64Atomics";
    case spv::CapabilityPhysicalStorageBufferAddresses:
      return "PhysicalStorageBufferAddresses";
    case spv::CapabilityGroupNonUniform:
      return "GroupNonUniform";
    case spv::CapabilityGroupNonUniformVote:
      return "GroupNonUniformVote";
    case spv::CapabilityGroupNonUniformArithmetic:
      return "GroupNonUniformArithmetic";
    case spv::CapabilityGroupNonUniformBallot:
      return "GroupNonUniformBallot";
    case spv::CapabilityGroupNonUniformShuffle:
      return "GroupNonUniformShuffle";
    case spv::CapabilityGroupNonUniformShuffleRelative:
      return "GroupNonUniformShuffleRelative";
    case spv::CapabilityGroupNonUniformClustered:
      return "GroupNonUniformClustered";
    case spv::CapabilityGroupNonUniformQuad:
      return "GroupNonUniformQuad";
    default:
      return "capability " + std::to_string(capability);
  }
}

}  // namespace solidcast::gpu
