// Counts the rounds of loops in users' own GLSL: a loop without end hangs a GPU, and lavapipe cuts it off in silence.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/gpu/shaders.h"

namespace solidcast {

/// Every loop is asked once a round, in its condition: `for (a; b; c)` becomes `for (a; solidcast_guard(N) && (b); c)`,
/// `while (b)`, with or without a `do`, becomes `while (solidcast_guard(N) && (b))`; N says where it stands, and
/// solidcast_guard (shaders/custom/user.glsl) counts. As only the heads are touched, bodies may be anything, and so may
/// macros around them. Lines stay where they are.
class LoopGuard {
 public:
  /// The text with its loops guarded. Throws Error(Exit::shader) `name:line: error: ...` for a head that it cannot read.
  std::string guarded(const gpu::SourceText& source);

  /// "my.glsl:12" of an N, which takes the low 22 bits.
  std::string place(std::uint32_t number) const;

 private:
  static constexpr std::uint32_t lineBits = 16, fileBits = 6;
  std::vector<std::string> files_;
};

/// GLSL with comments as blanks: the same length, the same lines.
std::string withoutComments(const std::string& glsl);

}  // namespace solidcast
