// Specialisation in this process: constants set, branches on them decided, and all code, functions and buffers that can
// no longer be reached dropped, before the driver sees the module.
//
// Drivers fold specialisation constants too, but only after they have translated and inlined everything: on lavapipe a
// pipeline for the course's scene takes 2 to 3 times as long from the whole module. SPIRV-Tools' optimizer does the same
// and much more, in over 100 ms; this does it in well under one. It knows what glslang emits for this project's shaders:
// 32-bit constants, structured selections, no switch on a specialisation constant. What it does not know it leaves alone.
#define SPV_ENABLE_UTILITY_CODE  // which instructions have results
#include <glslang/SPIRV/spirv.hpp>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "host/gpu/shaders.h"

namespace solidcast::gpu {
namespace {

struct Instruction {
  spv::Op op;
  std::vector<std::uint32_t> words;  // with the first, which holds length and opcode
  std::uint32_t at(std::size_t i) const { return words[i]; }
};

Instruction make(spv::Op op, std::vector<std::uint32_t> operands) {
  operands.insert(operands.begin(), static_cast<std::uint32_t>(operands.size() + 1) << 16 | op);
  return {op, std::move(operands)};
}
void rename(Instruction& i, spv::Op op) {
  i.op = op;
  i.words[0] = (i.words[0] & 0xffff0000u) | op;
}

struct Block {
  std::uint32_t label = 0;
  std::vector<Instruction> code;  // after the label, terminator last
};
struct Function {
  std::vector<Instruction> head;  // OpFunction and parameters
  std::vector<Block> blocks;
  std::uint32_t id() const { return head[0].at(2); }
};

class ParsedModule {
 public:
  explicit ParsedModule(std::span<const std::uint32_t> spirv) : header_(spirv.begin(), spirv.begin() + 5) {
    Function* function = nullptr;
    for (std::size_t i = 5; i < spirv.size();) {
      std::size_t length = spirv[i] >> 16;
      Instruction in{static_cast<spv::Op>(spirv[i] & 0xffff), {spirv.begin() + i, spirv.begin() + i + length}};
      i += length;
      if (in.op == spv::OpFunction) function = &functions_.emplace_back();
      if (!function) {
        globals_.push_back(std::move(in));
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

  void setConstants(const std::unordered_map<std::uint32_t, std::uint32_t>& values) {
    std::unordered_map<std::uint32_t, std::uint32_t> specIds;  // result id -> constant_id
    std::erase_if(globals_, [&](const Instruction& in) {
      bool spec = in.op == spv::OpDecorate && in.at(2) == spv::DecorationSpecId;
      if (spec) specIds[in.at(1)] = in.at(3);
      return spec;
    });
    for (Instruction& in : globals_) {
      auto given = [&]() -> std::optional<std::uint32_t> {
        auto id = specIds.find(in.at(2));
        auto value = id == specIds.end() ? values.end() : values.find(id->second);
        return value == values.end() ? std::nullopt : std::optional(value->second);
      };
      switch (in.op) {
        case spv::OpConstant:
          if (in.words.size() == 4) known_[in.at(2)] = in.at(3);
          break;
        case spv::OpConstantTrue:
        case spv::OpConstantFalse:
          known_[in.at(2)] = in.op == spv::OpConstantTrue;
          break;
        case spv::OpSpecConstant:
          if (in.words.size() == 4) known_[in.at(2)] = in.words[3] = given().value_or(in.at(3));
          rename(in, spv::OpConstant);
          break;
        case spv::OpSpecConstantTrue:
        case spv::OpSpecConstantFalse: {
          bool value = given().value_or(in.op == spv::OpSpecConstantTrue);
          known_[in.at(2)] = value;
          rename(in, value ? spv::OpConstantTrue : spv::OpConstantFalse);
          break;
        }
        case spv::OpSpecConstantComposite:
          rename(in, spv::OpConstantComposite);
          break;
        case spv::OpTypeBool:
          boolType_ = in.at(1);
          break;
        case spv::OpSpecConstantOp:
          fold(in);
          break;
        default:
          break;
      }
    }
  }

  void dropUnreachable() {
    for (Function& function : functions_) {
      for (Block& block : function.blocks) decideBranch(block);
      keepReachableBlocks(function);
    }
    keepReachableFunctions();
    keepUsedGlobals();
    dropNamesOfNothing();
  }

  std::vector<std::uint32_t> words() const {
    std::vector<std::uint32_t> out = header_;
    auto put = [&](const Instruction& in) { out.insert(out.end(), in.words.begin(), in.words.end()); };
    for (const Instruction& in : globals_) put(in);
    for (const Function& function : functions_) {
      for (const Instruction& in : function.head) put(in);
      for (const Block& block : function.blocks) {
        put(make(spv::OpLabel, {block.label}));
        for (const Instruction& in : block.code) put(in);
      }
      put(make(spv::OpFunctionEnd, {}));
    }
    return out;
  }

 private:
  std::optional<std::uint32_t> value(std::uint32_t id) const {
    auto it = known_.find(id);
    return it == known_.end() ? std::nullopt : std::optional(it->second);
  }

  /// An operation on constants: replaced by its value where that is known; left alone else.
  void fold(Instruction& in) {
    std::vector<std::uint32_t> v;
    for (std::size_t k = 4; k < in.words.size(); ++k) {
      auto known = value(in.at(k));
      if (!known) return;
      v.push_back(*known);
    }
    std::uint32_t result = 0;
    if (v.size() == 1) v.push_back(0);
    switch (static_cast<spv::Op>(in.at(3))) {
      case spv::OpIAdd:
        result = v[0] + v[1];
        break;
      case spv::OpISub:
        result = v[0] - v[1];
        break;
      case spv::OpIMul:
        result = v[0] * v[1];
        break;
      case spv::OpBitwiseAnd:
        result = v[0] & v[1];
        break;
      case spv::OpBitwiseOr:
        result = v[0] | v[1];
        break;
      case spv::OpIEqual:
      case spv::OpLogicalEqual:
        result = v[0] == v[1];
        break;
      case spv::OpINotEqual:
      case spv::OpLogicalNotEqual:
        result = v[0] != v[1];
        break;
      case spv::OpUGreaterThan:
        result = v[0] > v[1];
        break;
      case spv::OpUGreaterThanEqual:
        result = v[0] >= v[1];
        break;
      case spv::OpULessThan:
        result = v[0] < v[1];
        break;
      case spv::OpULessThanEqual:
        result = v[0] <= v[1];
        break;
      case spv::OpLogicalAnd:
        result = v[0] && v[1];
        break;
      case spv::OpLogicalOr:
        result = v[0] || v[1];
        break;
      case spv::OpLogicalNot:
        result = !v[0];
        break;
      default:
        return;
    }
    known_[in.at(2)] = result;
    if (in.at(1) == boolType_) {
      in = make(result ? spv::OpConstantTrue : spv::OpConstantFalse, {in.at(1), in.at(2)});
    } else {
      in = make(spv::OpConstant, {in.at(1), in.at(2), result});
    }
  }

  /// A selection whose condition is known becomes a plain branch. (Loops keep their headers.)
  void decideBranch(Block& block) {
    if (block.code.size() < 2 || block.code.back().op != spv::OpBranchConditional) return;
    auto condition = value(block.code.back().at(1));
    if (!condition || block.code[block.code.size() - 2].op != spv::OpSelectionMerge) return;
    std::uint32_t target = block.code.back().at(*condition ? 2 : 3);
    block.code.resize(block.code.size() - 2);
    block.code.push_back(make(spv::OpBranch, {target}));
  }

  static std::vector<std::uint32_t> successors(const Block& block) {
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

  static void keepReachableBlocks(Function& function) {
    if (function.blocks.empty()) return;
    std::unordered_map<std::uint32_t, const Block*> byLabel;
    for (const Block& block : function.blocks) byLabel[block.label] = &block;
    std::unordered_set<std::uint32_t> kept;
    std::vector<std::uint32_t> open = {function.blocks[0].label};
    while (!open.empty()) {
      std::uint32_t label = open.back();
      open.pop_back();
      if (!kept.insert(label).second) continue;
      const Block& block = *byLabel.at(label);
      for (std::uint32_t next : successors(block)) open.push_back(next);
      if (block.code.size() < 2) continue;  // a header's merge and continue blocks are named, so they must stay
      const Instruction& merge = block.code[block.code.size() - 2];
      if (merge.op == spv::OpSelectionMerge || merge.op == spv::OpLoopMerge) open.push_back(merge.at(1));
      if (merge.op == spv::OpLoopMerge) open.push_back(merge.at(2));
    }
    std::erase_if(function.blocks, [&](const Block& block) { return !kept.contains(block.label); });
    // Parents that are gone, or that no longer lead here, leave the phis.
    std::unordered_map<std::uint32_t, std::unordered_set<std::uint32_t>> parents;
    for (const Block& block : function.blocks)
      for (std::uint32_t next : successors(block)) parents[next].insert(block.label);
    for (Block& block : function.blocks)
      for (Instruction& in : block.code) {
        if (in.op != spv::OpPhi) continue;
        std::vector<std::uint32_t> operands = {in.at(1), in.at(2)};
        for (std::size_t k = 3; k + 1 < in.words.size(); k += 2)
          if (parents[block.label].contains(in.at(k + 1))) operands.insert(operands.end(), {in.at(k), in.at(k + 1)});
        in = make(spv::OpPhi, operands);
      }
  }

  void keepReachableFunctions() {
    std::unordered_map<std::uint32_t, const Function*> byId;
    for (const Function& function : functions_) byId[function.id()] = &function;
    std::unordered_set<std::uint32_t> kept;
    std::vector<std::uint32_t> open;
    for (const Instruction& in : globals_)
      if (in.op == spv::OpEntryPoint) open.push_back(in.at(2));
    while (!open.empty()) {
      std::uint32_t id = open.back();
      open.pop_back();
      if (!kept.insert(id).second) continue;
      for (const Block& block : byId.at(id)->blocks)
        for (const Instruction& in : block.code)
          if (in.op == spv::OpFunctionCall) open.push_back(in.at(3));
    }
    std::erase_if(functions_, [&](const Function& function) { return !kept.contains(function.id()); });
  }

  /// Types, constants and variables (buffers among them) that nothing names any more. (Every word counts as a name: a
  /// number that happens to equal an id keeps it, which is harmless.)
  void keepUsedGlobals() {
    std::unordered_set<std::uint32_t> named;
    auto name = [&](const Instruction& in) { named.insert(in.words.begin() + 1, in.words.end()); };
    for (const Function& function : functions_) {
      for (const Instruction& in : function.head) name(in);
      for (const Block& block : function.blocks)
        for (const Instruction& in : block.code) name(in);
    }
    std::vector<Instruction> kept;
    for (auto in = globals_.rbegin(); in != globals_.rend(); ++in) {  // uses stand after definitions
      bool result = false, type = false;
      spv::HasResultAndType(in->op, &result, &type);
      if (result && in->op != spv::OpExtInstImport && in->op != spv::OpString && !named.contains(in->at(type ? 2 : 1)))
        continue;
      if (!isAnnotation(*in)) name(*in);
      kept.push_back(std::move(*in));
    }
    globals_.assign(std::make_move_iterator(kept.rbegin()), std::make_move_iterator(kept.rend()));
  }

  void dropNamesOfNothing() {
    std::unordered_set<std::uint32_t> defined;
    auto define = [&](const Instruction& in) {
      bool result = false, type = false;
      spv::HasResultAndType(in.op, &result, &type);
      if (result) defined.insert(in.at(type ? 2 : 1));
    };
    for (const Instruction& in : globals_)
      if (!isAnnotation(in)) define(in);
    for (const Function& function : functions_) {
      for (const Instruction& in : function.head) define(in);
      for (const Block& block : function.blocks) {
        defined.insert(block.label);
        for (const Instruction& in : block.code) define(in);
      }
    }
    std::erase_if(globals_, [&](const Instruction& in) { return isAnnotation(in) && !defined.contains(in.at(1)); });
  }
  static bool isAnnotation(const Instruction& in) {
    return in.op == spv::OpName || in.op == spv::OpMemberName || in.op == spv::OpDecorate ||
           in.op == spv::OpMemberDecorate;
  }

  std::vector<std::uint32_t> header_;
  std::vector<Instruction> globals_;
  std::vector<Function> functions_;
  std::unordered_map<std::uint32_t, std::uint32_t> known_;  // constants of 32 bits and bools by id
  std::uint32_t boolType_ = 0;
};

}  // namespace

std::vector<std::uint32_t> specialised(std::span<const std::uint32_t> spirv,
                                       const std::vector<std::pair<std::uint32_t, std::uint32_t>>& constants) {
  ParsedModule module(spirv);
  module.setConstants({constants.begin(), constants.end()});
  module.dropUnreachable();
  return module.words();
}

}  // namespace solidcast::gpu
