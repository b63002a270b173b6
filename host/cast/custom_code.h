// Users' own GLSL (docs/custom-glsl.md): a file and its parameters to SPIR-V, with messages that name the user's own lines.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/cast/caster.h"
#include "host/cast/loop_guard.h"
#include "host/scene/world.h"

namespace solidcast {

enum class CustomKind { integrator, solid };

/// One file compiled as an integrator or a solid; parameters' values are not part of it, their names and types are.
class CustomModule {
 public:
  /// Throws gpu::CompileError `file:line: error: ...` where the file cannot be read, does not compile, lacks its
  /// function, or has it with another signature.
  CustomModule(CustomKind kind, const Scene& scene, const CustomCode& code, const CastOptions& options);

  const std::vector<std::uint32_t>& spirv() const { return spirv_; }
  const LoopGuard& guard() const { return guard_; }
  /// The user's file and all of theirs that it includes.
  std::vector<std::filesystem::path> files() const;
  /// Whether compiling again would give the same: same files with the same texts, and the same parameters.
  bool serves(CustomKind kind, const Scene& scene, const CustomCode& code) const;

 private:
  struct Text {
    std::filesystem::path file;
    std::string text;
  };
  CustomKind kind_;
  std::filesystem::path file_;
  std::string parameters_;   // as GLSL
  std::vector<Text> texts_;  // as they were compiled
  std::vector<std::uint32_t> spirv_;
  LoopGuard guard_;
};

/// Rows of the uniform block Values (shaders/custom/user.glsl), one a parameter, at least one.
std::vector<float> customValues(const CustomCode& code);

/// Whether pictures of the scene need users' code: solids always, an integrator only for the radiance.
bool needsCustom(const Scene& scene, bool radiance);

}  // namespace solidcast
