// Specialisation in this process: constants set, branches on them decided, and all code, functions and buffers that can
// no longer be reached dropped, before the driver sees the module.
//
// Drivers fold specialisation constants too, but only after they have translated and inlined everything: on lavapipe a
// pipeline for the course's scene takes 2 to 3 times as long from the whole module. SPIRV-Tools' optimizer does the same
// and much more, in over 100 ms; this takes one. It knows what glslang emits for this project's shaders:
// 32-bit constants, structured selections, no switch on a specialisation constant. What it does not know it leaves alone.
#define SPV_ENABLE_UTILITY_CODE  // which instructions have results
#include <glslang/SPIRV/spirv.hpp>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "host/gpu/parsed_module.h"
#include "host/gpu/shaders.h"

namespace solidcast::gpu {
namespace {

void rename(Instruction& i, spv::Op op) {
  i.op = op;
  i.words[0] = (i.words[0] & 0xffff0000u) | op;
}

class Specialiser {
 public:
  explicit Specialiser(std::span<const std::uint32_t> spirv) : module_(spirv) {}

  void setConstants(const std::unordered_map<std::uint32_t, std::uint32_t>& values) {
    std::unordered_map<std::uint32_t, std::uint32_t> specIds;  // result id -> constant_id
    std::erase_if(module_.globals, [&](const Instruction& in) {
      bool spec = in.op == spv::OpDecorate && in.at(2) == spv::DecorationSpecId;
      if (spec) specIds[in.at(1)] = in.at(3);
      return spec;
    });
    for (Instruction& in : module_.globals) {
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

  void decideBranches() {
    for (Function& function : module_.functions) {
      for (Block& block : function.blocks) decideBranch(block);
      keepReachableBlocks(function);
    }
  }

  /// Functions, types, constants, variables and names that nothing needs any more.
  void dropUnreachable() {
    keepReachableFunctions();
    keepUsedGlobals();
    dropNamesOfNothing();
  }

  void unroll() { unrollLoops(module_, known_); }

  std::vector<std::uint32_t> words() const { return module_.words(); }

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

  static void keepReachableBlocks(Function& function) {
    if (function.blocks.empty()) return;
    std::unordered_map<std::uint32_t, const Block*> byLabel;
    for (const Block& block : function.blocks) byLabel[block.label] = &block;
    std::unordered_set<std::uint32_t> reached;
    std::vector<std::uint32_t> open = {function.blocks[0].label};
    while (!open.empty()) {
      std::uint32_t label = open.back();
      open.pop_back();
      if (!reached.insert(label).second) continue;
      for (std::uint32_t next : successors(*byLabel.at(label))) open.push_back(next);
    }
    // A header's merge and continue blocks are named, so they must stay; nothing of them if they are not reached.
    std::unordered_map<std::uint32_t, Instruction> named;
    for (std::uint32_t label : reached) {
      const Block& block = *byLabel.at(label);
      if (block.code.size() < 2) continue;
      const Instruction& merge = block.code[block.code.size() - 2];
      if (merge.op != spv::OpSelectionMerge && merge.op != spv::OpLoopMerge) continue;
      if (!reached.contains(merge.at(1))) named.try_emplace(merge.at(1), make(spv::OpUnreachable, {}));
      if (merge.op == spv::OpLoopMerge && !reached.contains(merge.at(2)))
        named.insert_or_assign(merge.at(2), make(spv::OpBranch, {label}));  // even if a selection merges there
    }
    std::erase_if(function.blocks,
                  [&](const Block& block) { return !reached.contains(block.label) && !named.contains(block.label); });
    for (Block& block : function.blocks)
      if (auto end = named.find(block.label); end != named.end()) block.code = {end->second};
    // Parents that are gone, or that no longer lead here, leave the phis. Of one that is only named, no value matters.
    std::unordered_map<std::uint32_t, std::unordered_set<std::uint32_t>> parents;
    for (const Block& block : function.blocks)
      for (std::uint32_t next : successors(block)) parents[next].insert(block.label);
    for (Block& block : function.blocks)
      for (Instruction& in : block.code) {
        if (in.op != spv::OpPhi) continue;
        std::vector<std::uint32_t> operands = {in.at(1), in.at(2)};
        for (std::size_t k = 3; k + 1 < in.words.size(); k += 2)
          if (const std::uint32_t parent = in.at(k + 1);
              parents[block.label].contains(parent) && !named.contains(parent))
            operands.insert(operands.end(), {in.at(k), parent});
        for (std::uint32_t parent : parents[block.label])
          if (named.contains(parent)) operands.insert(operands.end(), {in.at(2), parent});
        in = make(spv::OpPhi, operands);
      }
  }

  void keepReachableFunctions() {
    std::unordered_map<std::uint32_t, const Function*> byId;
    for (const Function& function : module_.functions) byId[function.id()] = &function;
    std::unordered_set<std::uint32_t> kept;
    std::vector<std::uint32_t> open;
    for (const Instruction& in : module_.globals)
      if (in.op == spv::OpEntryPoint) open.push_back(in.at(2));
    while (!open.empty()) {
      std::uint32_t id = open.back();
      open.pop_back();
      if (!kept.insert(id).second) continue;
      for (const Block& block : byId.at(id)->blocks)
        for (const Instruction& in : block.code)
          if (in.op == spv::OpFunctionCall) open.push_back(in.at(3));
    }
    std::erase_if(module_.functions, [&](const Function& function) { return !kept.contains(function.id()); });
  }

  /// Types, constants and variables (buffers among them) that nothing names any more. (Every word counts as a name: a
  /// number that happens to equal an id keeps it, which is harmless.)
  void keepUsedGlobals() {
    std::unordered_set<std::uint32_t> named;
    auto name = [&](const Instruction& in) { named.insert(in.words.begin() + 1, in.words.end()); };
    for (const Function& function : module_.functions) {
      for (const Instruction& in : function.head) name(in);
      for (const Block& block : function.blocks)
        for (const Instruction& in : block.code) name(in);
    }
    std::vector<Instruction> kept;
    for (auto in = module_.globals.rbegin(); in != module_.globals.rend(); ++in) {  // uses stand after definitions
      bool result = false, type = false;
      spv::HasResultAndType(in->op, &result, &type);
      if (result && in->op != spv::OpExtInstImport && in->op != spv::OpString && !named.contains(in->at(type ? 2 : 1)))
        continue;
      if (!isAnnotation(*in)) name(*in);
      kept.push_back(std::move(*in));
    }
    module_.globals.assign(std::make_move_iterator(kept.rbegin()), std::make_move_iterator(kept.rend()));
  }

  void dropNamesOfNothing() {
    std::unordered_set<std::uint32_t> defined;
    auto define = [&](const Instruction& in) {
      bool result = false, type = false;
      spv::HasResultAndType(in.op, &result, &type);
      if (result) defined.insert(in.at(type ? 2 : 1));
    };
    for (const Instruction& in : module_.globals)
      if (!isAnnotation(in)) define(in);
    for (const Function& function : module_.functions) {
      for (const Instruction& in : function.head) define(in);
      for (const Block& block : function.blocks) {
        defined.insert(block.label);
        for (const Instruction& in : block.code) define(in);
      }
    }
    std::erase_if(module_.globals,
                  [&](const Instruction& in) { return isAnnotation(in) && !defined.contains(in.at(1)); });
    for (Instruction& in : module_.globals) {  // from SPIR-V 1.4 on, an entry point names all buffers
      if (in.op != spv::OpEntryPoint) continue;
      std::size_t end = 3;  // of its own name
      while (in.at(end++) >> 24 != 0) continue;
      std::erase_if(in.words,
                    [&, i = std::size_t{0}](std::uint32_t id) mutable { return i++ >= end && !defined.contains(id); });
      in.words[0] = static_cast<std::uint32_t>(in.words.size()) << 16 | in.op;
    }
  }
  static bool isAnnotation(const Instruction& in) {
    return in.op == spv::OpName || in.op == spv::OpMemberName || in.op == spv::OpDecorate ||
           in.op == spv::OpMemberDecorate;
  }

  ParsedModule module_;
  Known known_;
  std::uint32_t boolType_ = 0;
};

}  // namespace

std::vector<std::uint32_t> specialised(std::span<const std::uint32_t> spirv,
                                       const std::vector<std::pair<std::uint32_t, std::uint32_t>>& constants) {
  Specialiser module(spirv);
  module.setConstants({constants.begin(), constants.end()});
  module.decideBranches();
  module.unroll();
  module.dropUnreachable();
  return module.words();
}

}  // namespace solidcast::gpu
