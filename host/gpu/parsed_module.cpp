#include "host/gpu/parsed_module.h"

#include <utility>

namespace solidcast::gpu {

Instruction make(spv::Op op, std::vector<std::uint32_t> operands) {
  operands.insert(operands.begin(), static_cast<std::uint32_t>(operands.size() + 1) << 16 | op);
  return {op, std::move(operands)};
}

std::vector<std::uint32_t> successors(const Block& block) {
  std::vector<std::uint32_t> to;
  const Instruction& end = block.code.back();
  if (end.op == spv::OpBranch) to = {end.at(1)};
  if (end.op == spv::OpBranchConditional) to = {end.at(2), end.at(3)};
  if (end.op == spv::OpSwitch) {
    to = {end.at(2)};
    for (std::size_t k = 4; k < end.words.size(); k += 2) to.push_back(end.at(k));
  }
  return to;
}

ParsedModule::ParsedModule(std::span<const std::uint32_t> spirv) : header(spirv.begin(), spirv.begin() + 5) {
  Function* function = nullptr;
  for (std::size_t i = 5; i < spirv.size();) {
    std::size_t length = spirv[i] >> 16;
    Instruction in{static_cast<spv::Op>(spirv[i] & 0xffff), {spirv.begin() + i, spirv.begin() + i + length}};
    i += length;
    if (in.op == spv::OpFunction) function = &functions.emplace_back();
    if (!function) {
      globals.push_back(std::move(in));
    } else if (in.op == spv::OpFunctionEnd) {
      function = nullptr;
    } else if (in.op == spv::OpLabel) {
      function->blocks.push_back({in.at(1), {}});
    } else if (function->blocks.empty()) {
      function->head.push_back(std::move(in));
    } else {
      function->blocks.back().code.push_back(std::move(in));
    }
  }
}

std::vector<std::uint32_t> ParsedModule::words() const {
  std::vector<std::uint32_t> out = header;
  auto put = [&](const Instruction& in) { out.insert(out.end(), in.words.begin(), in.words.end()); };
  for (const Instruction& in : globals) put(in);
  for (const Function& function : functions) {
    for (const Instruction& in : function.head) put(in);
    for (const Block& block : function.blocks) {
      put(make(spv::OpLabel, {block.label}));
      for (const Instruction& in : block.code) put(in);
    }
    put(make(spv::OpFunctionEnd, {}));
  }
  return out;
}

}  // namespace solidcast::gpu
