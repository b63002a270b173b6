// Uniform buffers turned into constants of the module. What a driver may not do for a buffer, it does for constants:
// llvmpipe spends a compared and branched-around load on every number of a uniform buffer, and a lane-by-lane gather
// inside a loop; a constant is an operand of the arithmetic.
#include <cstring>
#include <functional>
#include <glslang/SPIRV/spirv.hpp>
#include <map>

#include "host/error.h"
#include "host/gpu/shaders.h"

namespace solidcast::gpu {
namespace {

using Words = std::vector<std::uint32_t>;
using Operands = std::span<const std::uint32_t>;

void each(std::span<const std::uint32_t> spirv, const std::function<void(spv::Op, Operands)>& f) {
  for (std::size_t i = 5; i < spirv.size(); i += spirv[i] >> 16)
    f(static_cast<spv::Op>(spirv[i] & 0xffff), spirv.subspan(i + 1, (spirv[i] >> 16) - 1));
}

void put(Words& out, spv::Op op, const Words& operands) {
  out.push_back(static_cast<std::uint32_t>(operands.size() + 1) << 16 | op);
  out.insert(out.end(), operands.begin(), operands.end());
}

class Baker {
 public:
  explicit Baker(std::span<const std::uint32_t> spirv) : spirv_(spirv), bound_(spirv[3]) {
    each(spirv, [&](spv::Op op, Operands w) {
      switch (op) {
        case spv::OpDecorate:
          if (w[1] == spv::DecorationBinding) bindings_[w[0]] = w[2];
          break;
        case spv::OpTypePointer:
        case spv::OpTypeArray:
        case spv::OpTypeStruct:
        case spv::OpTypeVector:
        case spv::OpTypeFloat:
          types_[w[0]] = {w.begin() + 1, w.end()};
          break;
        case spv::OpTypeInt:
          if (w[1] == 32 && w[2] == 0) uint_ = w[0];
          break;
        case spv::OpVariable:
          if (w[2] == spv::StorageClassUniform) variables_[w[1]] = w[0];
          break;
        default:
          break;
      }
    });
  }

  /// Makes a variable with these contents for the uniform buffer of this binding; a module without it stays as it is.
  void add(std::uint32_t binding, std::span<const std::byte> contents) {
    for (auto [variable, pointer] : variables_) {
      if (bindings_.at(variable) != binding) continue;
      const Words& block = types_.at(types_.at(pointer)[1]);
      if (block.size() != 1 || types_.at(block[0]).size() != 2)
        throw Error(Exit::shader, "binding " + std::to_string(binding) + " is not a block of one array");
      constants_[variable] = arrayOf(types_.at(block[0])[0], contents);
    }
  }

  Words words() {
    Words code = code_();
    Words out(spirv_.begin(), spirv_.begin() + 5);
    bool placed = false;
    each(code, [&](spv::Op op, Operands w) {
      if (op == spv::OpFunction && !placed) {
        out.insert(out.end(), globals_.begin(), globals_.end());
        placed = true;
      }
      put(out, op, {w.begin(), w.end()});
    });
    out[3] = bound_;
    return out;
  }

 private:
  /// The module with its accesses to the buffers turned to the new variables, and its loops marked.
  Words code_() {
    Words out(spirv_.begin(), spirv_.begin() + 5);
    each(spirv_, [&](spv::Op op, Operands w) {
      Words operands(w.begin(), w.end());
      if (op == spv::OpAccessChain && constants_.contains(w[2])) {
        operands[0] = privatePointer(types_.at(w[0])[1]);
        operands[2] = constants_.at(w[2]);
        operands.erase(operands.begin() + 3);  // the block's member
      }
      if (op == spv::OpLoopMerge && w[2] == spv::LoopControlMaskNone) operands[2] = spv::LoopControlUnrollMask;
      put(out, op, operands);
    });
    return out;
  }

  std::uint32_t fresh() { return bound_++; }

  std::uint32_t privatePointer(std::uint32_t to) {
    auto [it, isNew] = pointers_.try_emplace(to, 0);
    if (isNew) {
      it->second = fresh();
      put(globals_, spv::OpTypePointer, {it->second, spv::StorageClassPrivate, to});
    }
    return it->second;
  }

  std::uint32_t constant(std::uint32_t type, const Words& bits) {
    auto [it, isNew] = numbers_.try_emplace({type, bits}, 0);
    if (isNew) {
      it->second = fresh();
      Words operands = {type, it->second};
      operands.insert(operands.end(), bits.begin(), bits.end());
      put(globals_, spv::OpConstant, operands);
    }
    return it->second;
  }

  /// A private variable: an array of `vector` (vec4 or dvec4) with these contents.
  std::uint32_t arrayOf(std::uint32_t vector, std::span<const std::byte> contents) {
    std::uint32_t component = types_.at(vector)[0], count = types_.at(vector)[1];
    std::size_t words = types_.at(component)[0] / 32, stride = words * 4 * count;
    Words all;
    for (std::size_t at = 0; at + stride <= contents.size(); at += stride) {
      Words parts = {vector, 0};
      for (std::size_t k = 0; k < count; ++k) {
        Words bits(words);
        std::memcpy(bits.data(), contents.data() + at + k * words * 4, words * 4);
        parts.push_back(constant(component, bits));
      }
      parts[1] = fresh();
      put(globals_, spv::OpConstantComposite, parts);
      all.push_back(parts[1]);
    }
    if (uint_ == 0) {
      uint_ = fresh();
      put(globals_, spv::OpTypeInt, {uint_, 32, 0});
    }
    std::uint32_t length = constant(uint_, {static_cast<std::uint32_t>(all.size())});
    std::uint32_t type = fresh(), value = fresh(), variable = fresh();
    put(globals_, spv::OpTypeArray, {type, vector, length});
    all.insert(all.begin(), {type, value});
    put(globals_, spv::OpConstantComposite, all);
    std::uint32_t pointer = privatePointer(type);
    put(globals_, spv::OpVariable, {pointer, variable, spv::StorageClassPrivate, value});
    return variable;
  }

  std::span<const std::uint32_t> spirv_;
  std::uint32_t bound_, uint_ = 0;
  std::map<std::uint32_t, std::uint32_t> bindings_, variables_, constants_, pointers_;  // by id
  std::map<std::uint32_t, Words> types_;                                                // operands by id
  std::map<std::pair<std::uint32_t, Words>, std::uint32_t> numbers_;
  Words globals_;
};

}  // namespace

std::vector<std::uint32_t> baked(std::span<const std::uint32_t> spirv,
                                 const std::map<std::uint32_t, std::span<const std::byte>>& contents) {
  Baker baker(spirv);
  for (const auto& [binding, bytes] : contents) baker.add(binding, bytes);
  return baker.words();
}

}  // namespace solidcast::gpu
