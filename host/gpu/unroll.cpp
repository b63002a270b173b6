// Loops of known length written out before the driver sees them. lavapipe does it too, but one loop after the other, and
// goes over the whole shader with all of its passes after each: most of what a pipeline took.
//
// A loop here is what glslang and spirv-opt make of `for (i = a; i < b; i += c)` without break, continue or return:
//     header:  phis; more code; i < b; OpLoopMerge exit continue; branch to the body or to exit
//     body and continue, which branches back to the header, and is the only one that does
// Each round is a copy with names of its own. The phis are gone: in the first round they are what they came in with, then
// what the round before hands on. The header is copied once more after the last round, for what it calculates.
#define SPV_ENABLE_UTILITY_CODE  // which instructions have results
#include <algorithm>
#include <glslang/SPIRV/spirv.hpp>
#include <map>
#include <optional>
#include <unordered_set>
#include <utility>

#include "host/gpu/parsed_module.h"

namespace solidcast::gpu {
namespace {

/// What ids are called instead. They are small and dense, so that this is a table.
class Names {
 public:
  void set(std::uint32_t id, std::uint32_t name) {
    if (id >= of_.size()) of_.resize(2 * id);
    if (of_[id] == 0) renamed_.push_back(id);
    of_[id] = name;
  }
  std::uint32_t operator()(std::uint32_t id) const { return id < of_.size() && of_[id] != 0 ? of_[id] : id; }
  void clear() {
    for (std::uint32_t id : renamed_) of_[id] = 0;
    renamed_.clear();
  }

 private:
  std::vector<std::uint32_t> of_, renamed_;  // 0: as it is
};
constexpr std::size_t mostInstructions = 1 << 16;  // of a loop written out
constexpr std::uint32_t mostRounds = 256;

std::uint32_t resultOf(const Instruction& in) {
  bool result = false, type = false;
  spv::HasResultAndType(in.op, &result, &type);
  return result ? in.at(type ? 2 : 1) : 0;
}

bool isBetween(spv::Op op, spv::Op first, spv::Op last) { return op >= first && op <= last; }

/// Which words of an instruction name others, its own type and result aside: [from, to), and [more, end). Nothing where
/// that is not known here: the numbers among an instruction's words look like names.
struct Operands {
  std::size_t from, to, more;
};
std::optional<Operands> operandsOf(const Instruction& in) {
  const std::size_t end = in.words.size();
  switch (in.op) {
    case spv::OpReturn:
    case spv::OpUnreachable:
    case spv::OpUndef:
      return Operands{end, end, end};
    case spv::OpVariable:  // a storage class, then what it starts with
      return Operands{end, end, 4};
    case spv::OpBranch:
    case spv::OpSelectionMerge:
      return Operands{1, 2, end};
    case spv::OpStore:
    case spv::OpLoopMerge:
      return Operands{1, 3, end};
    case spv::OpBranchConditional:
      return Operands{1, 4, end};
    case spv::OpLoad:
    case spv::OpCompositeExtract:
    case spv::OpArrayLength:
      return Operands{3, 4, end};
    case spv::OpCompositeInsert:
    case spv::OpVectorShuffle:
      return Operands{3, 5, end};
    case spv::OpExtInst:
      return Operands{3, 4, 5};
    case spv::OpFunctionCall:
    case spv::OpAccessChain:
    case spv::OpInBoundsAccessChain:
    case spv::OpVectorExtractDynamic:
    case spv::OpVectorInsertDynamic:
    case spv::OpCompositeConstruct:
    case spv::OpCopyObject:
    case spv::OpTranspose:
    case spv::OpPhi:
      return Operands{3, end, end};
    default:
      if (isBetween(in.op, spv::OpConvertFToU, spv::OpBitcast) ||
          isBetween(in.op, spv::OpSNegate, spv::OpSMulExtended) ||
          isBetween(in.op, spv::OpAny, spv::OpFUnordGreaterThanEqual) ||
          isBetween(in.op, spv::OpShiftRightLogical, spv::OpBitCount) ||
          isBetween(in.op, spv::OpAtomicIIncrement, spv::OpAtomicXor))
        return Operands{3, end, end};
      return std::nullopt;
  }
}

template <class F>
void eachOperand(Instruction& in, F f) {
  const auto operands = operandsOf(in);
  for (std::size_t k = operands->from; k < operands->to; ++k) f(in.words[k]);
  for (std::size_t k = operands->more; k < in.words.size(); ++k) f(in.words[k]);
}

class Unroller {
 public:
  Unroller(ParsedModule& module, Known& known) : module_(module), known_(known) {
    for (std::size_t i = 0; i < module.globals.size(); ++i) {
      const Instruction& in = module.globals[i];
      if (in.op == spv::OpDecorate) decorations_[in.at(1)].push_back(in), lastDecoration_ = i;
      if (in.op == spv::OpTypeInt && in.at(2) == 32) integers_.insert(in.at(1));
      if (in.op == spv::OpConstant && in.words.size() == 4) constants_[{in.at(1), in.at(3)}] = in.at(2);
    }
  }

  void run() {
    for (Function& function : module_.functions) {
      bool some = false;
      if (!isUnderstood(function)) continue;
      // The last first: inner loops have their headers after those of the loops around them.
      for (std::size_t i = function.blocks.size(); i-- > 0;) some = unroll(function, i) || some;
      if (some) fold(function);
    }
    const auto place = module_.globals.begin() + static_cast<std::ptrdiff_t>(lastDecoration_ + 1);
    module_.globals.insert(place, added_.begin(), added_.end());
  }

 private:
  struct Loop {
    std::unordered_set<std::uint32_t> labels;  // of its blocks
    std::uint32_t inside = 0, exit = 0, rounds = 0;
  };

  static bool isUnderstood(const Function& function) {
    for (const Block& block : function.blocks)
      for (const Instruction& in : block.code)
        if (!operandsOf(in)) return false;
    return true;
  }

  std::optional<std::uint32_t> value(std::uint32_t id) const {
    const auto it = known_.find(id);
    return it == known_.end() ? std::nullopt : std::optional(it->second);
  }

  /// The loop with this header, where it is one of those that can be written out.
  std::optional<Loop> loopAt(const Function& function, const Block& header) const {
    const std::size_t n = header.code.size();
    if (n < 3 || header.code[n - 2].op != spv::OpLoopMerge || header.code[n - 1].op != spv::OpBranchConditional)
      return {};
    const Instruction &merge = header.code[n - 2], &end = header.code[n - 1];
    if (merge.at(3) & spv::LoopControlDontUnrollMask || end.at(3) != merge.at(1)) return {};
    Loop loop{{header.label}, end.at(2), merge.at(1)};
    std::unordered_map<std::uint32_t, const Block*> byLabel;
    for (const Block& block : function.blocks) byLabel[block.label] = &block;
    std::size_t instructions = n;
    std::uint32_t back = 0;  // the block that goes back to the header
    // Ways to the continue block. A second one, out of a selection, would lead nowhere once the loop is gone.
    std::size_t continuing = 0;
    for (std::vector<std::uint32_t> open = {loop.inside}; !open.empty();) {
      const std::uint32_t label = open.back();
      open.pop_back();
      if (label == loop.exit) return {};
      if (!loop.labels.insert(label).second) continue;
      const Block& block = *byLabel.at(label);
      const std::vector<std::uint32_t> next = successors(block);
      if (next.empty()) return {};
      for (std::uint32_t to : next) {
        continuing += to == merge.at(2);
        if (to != header.label) open.push_back(to);
        else if (std::exchange(back, label) != 0) return {};
      }
      instructions += block.code.size();
    }
    const auto rounds = roundsOf(function, header, loop);
    if (back == 0 || continuing > 1 || !rounds || instructions * (*rounds + 1) > mostInstructions) return {};
    loop.rounds = *rounds;
    return loop;
  }

  static const Instruction* definition(const std::vector<Instruction>& code, std::uint32_t id) {
    for (const Instruction& in : code)
      if (resultOf(in) == id) return &in;
    return nullptr;
  }

  /// What a phi of the header comes in with, and what a round hands on.
  static std::pair<std::uint32_t, std::uint32_t> comesAndGoes(const Instruction& phi, const Loop& loop) {
    const bool backFirst = loop.labels.contains(phi.at(4));
    return {phi.at(backFirst ? 5 : 3), phi.at(backFirst ? 3 : 5)};
  }

  std::optional<std::uint32_t> roundsOf(const Function& function, const Block& header, const Loop& loop) const {
    const Instruction* condition = definition(header.code, header.code.back().at(1));
    if (!condition || (condition->op != spv::OpULessThan && condition->op != spv::OpSLessThan)) return {};
    const Instruction* phi = definition(header.code, condition->at(3));
    const auto end = value(condition->at(4));
    if (!phi || !end) return {};
    for (const Instruction& in : header.code)
      if (in.op == spv::OpPhi && in.words.size() != 7) return {};
    if (phi->op != spv::OpPhi) return {};
    const auto [comes, goes] = comesAndGoes(*phi, loop);
    const Instruction* step = nullptr;
    for (const Block& block : function.blocks)
      if (loop.labels.contains(block.label) && !step) step = definition(block.code, goes);
    if (!step || step->op != spv::OpIAdd || step->at(3) != phi->at(2)) return {};
    const auto from = value(comes), by = value(step->at(4));
    if (!from || !by || *by == 0) return {};
    std::uint32_t rounds = 0;
    // The order of signed numbers is that of unsigned ones with the highest bit turned over.
    const std::uint32_t sign = condition->op == spv::OpSLessThan ? 1u << 31 : 0;
    for (std::uint32_t i = *from; (i ^ sign) < (*end ^ sign); i += *by)
      if (++rounds > mostRounds) return {};
    return rounds;
  }

  std::uint32_t fresh() { return module_.header[3]++; }

  /// A new name for what `id` names, with its decorations.
  std::uint32_t another(std::uint32_t id) {
    const std::uint32_t name = fresh();
    if (const auto it = decorations_.find(id); it != decorations_.end())
      for (Instruction decoration : it->second) {
        decoration.words[1] = name;
        added_.push_back(std::move(decoration));
      }
    return name;
  }

  bool unroll(Function& function, std::size_t index) {
    const auto found = loopAt(function, function.blocks[index]);
    if (!found) return false;
    const Loop& loop = *found;
    std::vector<Block> before, body, after;
    for (std::size_t i = 0; i < function.blocks.size(); ++i) {
      Block& block = function.blocks[i];
      (loop.labels.contains(block.label) ? body : i < index ? before : after).push_back(std::move(block));
    }
    const Block& header = body.front();
    Names &now = names_[0], &previous = names_[1];
    previous.clear();
    std::uint32_t label = header.label;  // of this round's header: the first keeps its name
    for (std::uint32_t round = 0;; ++round) {
      const bool first = round == 0, last = round == loop.rounds;
      const std::uint32_t nextLabel = last ? 0 : fresh();
      now.clear();
      for (const Instruction& in : header.code)
        if (in.op == spv::OpPhi) {
          const auto [comes, goes] = comesAndGoes(in, loop);
          now.set(in.at(2), first ? comes : previous(goes));
        }
      for (std::size_t b = 0; b < (last ? 1 : body.size()); ++b) {
        now.set(body[b].label, b == 0 ? label : first ? body[b].label : fresh());
        for (const Instruction& in : body[b].code)
          if (const std::uint32_t id = resultOf(in); id != 0 && !(b == 0 && in.op == spv::OpPhi))
            now.set(id, first ? id : another(id));
      }
      for (std::size_t b = 0; b < (last ? 1 : body.size()); ++b) {
        Block& copy = before.emplace_back(Block{now(body[b].label), {}});
        for (const Instruction& in : body[b].code) {
          const bool ends = in.op == spv::OpBranch || in.op == spv::OpBranchConditional;
          if (b == 0 && (in.op == spv::OpPhi || in.op == spv::OpLoopMerge)) continue;
          if (b == 0 && ends) {
            copy.code.push_back(make(spv::OpBranch, {last ? loop.exit : now(loop.inside)}));
            continue;
          }
          Instruction& out = copy.code.emplace_back(in);
          eachOperand(out, [&](std::uint32_t& id) { id = ends && id == header.label ? nextLabel : now(id); });
          if (const std::uint32_t id = resultOf(in)) out.words[out.words[1] == id ? 1 : 2] = now(id);
        }
      }
      if (last) break;
      std::swap(now, previous);
      label = nextLabel;
    }
    // Elsewhere the loop's names mean the last round's; the header's label does only where a phi says where it came from.
    const auto adapt = [&](Block& block) {
      for (Instruction& in : block.code)
        eachOperand(in, [&](std::uint32_t& id) {
          if (id != header.label) id = now(id);
          else if (in.op == spv::OpPhi) id = label;
        });
    };
    std::for_each(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(index), adapt);
    std::for_each(after.begin(), after.end(), adapt);
    before.insert(before.end(), std::make_move_iterator(after.begin()), std::make_move_iterator(after.end()));
    function.blocks = std::move(before);
    return true;
  }

  std::uint32_t constant(std::uint32_t type, std::uint32_t value) {
    auto [it, isNew] = constants_.try_emplace({type, value}, 0);
    if (isNew) {
      it->second = fresh();
      module_.globals.push_back(make(spv::OpConstant, {type, it->second, value}));
      known_[it->second] = value;
    }
    return it->second;
  }

  /// Phis that one way leads to, and integers that are known: gone, and their names with them.
  void fold(Function& function) {
    Names& same = names_[0];
    same.clear();
    for (Block& block : function.blocks)
      std::erase_if(block.code, [&](Instruction& in) {
        eachOperand(in, [&](std::uint32_t& id) { id = same(id); });
        if (in.op == spv::OpPhi && in.words.size() == 5) {
          same.set(in.at(2), in.at(3));
          return true;
        }
        if ((in.op != spv::OpIAdd && in.op != spv::OpIMul) || !integers_.contains(in.at(1))) return false;
        const auto a = value(in.at(3)), b = value(in.at(4));
        if (!a || !b) return false;
        same.set(in.at(2), constant(in.at(1), in.op == spv::OpIAdd ? *a + *b : *a * *b));
        return true;
      });
    for (Block& block : function.blocks)  // what comes round a loop that stayed
      for (Instruction& in : block.code)
        if (in.op == spv::OpPhi) eachOperand(in, [&](std::uint32_t& id) { id = same(id); });
  }

  ParsedModule& module_;
  Known& known_;
  std::unordered_map<std::uint32_t, std::vector<Instruction>> decorations_;
  Names names_[2];
  std::unordered_set<std::uint32_t> integers_;  // types, of 32 bits
  std::size_t lastDecoration_ = 0;
  std::vector<Instruction> added_;                                              // decorations of copies
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> constants_;  // by type and value
};

}  // namespace

void unrollLoops(ParsedModule& module, Known& known) { Unroller(module, known).run(); }

}  // namespace solidcast::gpu
