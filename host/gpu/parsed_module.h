// A SPIR-V module taken apart into globals, functions, blocks and instructions, for what is done to modules before the
// driver sees them (specialise.cpp, unroll.cpp).
#pragma once
#include <cstdint>
#include <glslang/SPIRV/spirv.hpp>
#include <span>
#include <unordered_map>
#include <vector>

namespace solidcast::gpu {

struct Instruction {
  spv::Op op;
  std::vector<std::uint32_t> words;  // with the first, which holds length and opcode
  std::uint32_t at(std::size_t i) const { return words[i]; }
};

Instruction make(spv::Op op, std::vector<std::uint32_t> operands);

struct Block {
  std::uint32_t label = 0;
  std::vector<Instruction> code;  // after the label, terminator last
};
/// Labels that a block's end leads to.
std::vector<std::uint32_t> successors(const Block& block);

struct Function {
  std::vector<Instruction> head;  // OpFunction and parameters
  std::vector<Block> blocks;
  std::uint32_t id() const { return head[0].at(2); }
};

struct ParsedModule {
  explicit ParsedModule(std::span<const std::uint32_t> spirv);
  std::vector<std::uint32_t> words() const;

  std::vector<std::uint32_t> header;  // header[3]: all ids are below
  std::vector<Instruction> globals;
  std::vector<Function> functions;
};

/// Values of constants of 32 bits and of bools, by id.
using Known = std::unordered_map<std::uint32_t, std::uint32_t>;

/// Loops that count from one known number to another, with all their state in phis (as spirv-opt leaves it): written out
/// round by round, and integers that are known then turned to constants. Loops marked DontUnroll, of more than 256 rounds, or
/// with anything in them that is not known there, stay.
void unrollLoops(ParsedModule& module, Known& known);

}  // namespace solidcast::gpu
