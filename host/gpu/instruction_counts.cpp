#include "host/gpu/instruction_counts.h"

#include <glslang/SPIRV/spirv.hpp>

#include "host/error.h"

namespace solidcast::gpu {
namespace {

enum Class { arithmetic, comparison, conversion, memory, composite, control, calls, other, declarations, classCount };
constexpr const char* names[classCount] = {"arithmetic", "comparison", "conversion", "memory",      "composite",
                                           "control",    "calls",      "other",      "declarations"};

bool within(spv::Op op, spv::Op first, spv::Op last) { return op >= first && op <= last; }

/// By the ranges in which SPIR-V numbers its instructions.
Class classOf(spv::Op op) {
  if (op == spv::OpExtInst || within(op, spv::OpSNegate, spv::OpSMulExtended) ||
      within(op, spv::OpShiftRightLogical, spv::OpBitCount))
    return arithmetic;
  if (within(op, spv::OpAny, spv::OpFUnordGreaterThanEqual)) return comparison;
  if (within(op, spv::OpConvertFToU, spv::OpBitcast)) return conversion;
  if (within(op, spv::OpVariable, spv::OpInBoundsPtrAccessChain) || within(op, spv::OpAtomicLoad, spv::OpAtomicXor))
    return memory;
  if (within(op, spv::OpVectorExtractDynamic, spv::OpTranspose)) return composite;
  if (within(op, spv::OpPhi, spv::OpUnreachable)) return control;
  if (within(op, spv::OpFunction, spv::OpFunctionCall)) return calls;
  return other;
}

}  // namespace

std::vector<std::pair<std::string, std::uint64_t>> instructionCounts(std::span<const std::uint32_t> spirv) {
  if (spirv.size() < 5 || spirv[0] != spv::MagicNumber) throw Error(Exit::shader, "this is no SPIR-V module");
  std::uint64_t counts[classCount] = {};
  bool inFunction = false;
  for (std::size_t i = 5; i < spirv.size();) {
    const auto op = static_cast<spv::Op>(spirv[i] & 0xffff);
    const std::size_t length = spirv[i] >> 16;
    if (length == 0) throw Error(Exit::shader, "word " + std::to_string(i) + " of the module is no instruction");
    if (op == spv::OpFunction) inFunction = true;
    ++counts[inFunction ? classOf(op) : declarations];
    if (op == spv::OpFunctionEnd) inFunction = false;
    i += length;
  }
  std::vector<std::pair<std::string, std::uint64_t>> list;
  for (int c = 0; c < classCount; ++c) list.emplace_back(names[c], counts[c]);
  return list;
}

}  // namespace solidcast::gpu
