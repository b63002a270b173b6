// GLSL to SPIR-V, compiled now from a folder that somebody edits or from text; and what is done with modules before the
// driver sees them. Modules compiled at build time are in host/carried.
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../error.h"

namespace solidcast::gpu {

using Defines = std::vector<std::pair<std::string, std::string>>;

struct CompiledModule {
  std::vector<std::uint32_t> spirv;
  std::vector<std::filesystem::path> files;  // the file itself and everything it included
};

/// What does not compile, with the files that were read or looked for until then: one of them must change first.
class CompileError : public Error {
 public:
  CompileError(const std::string& line, std::vector<std::filesystem::path> files)
      : Error(Exit::shader, line), files_(std::move(files)) {}
  const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  std::vector<std::filesystem::path> files_;
};

/// Compiles `file` (a .comp) in process; `#include "x"` is looked up beside the including file, then in `folders`.
/// Throws CompileError with one line `path:line: error: message` (first error first, further ones on lines of their own).
CompiledModule compile(const std::filesystem::path& file, const Defines& defines,
                       const std::vector<std::filesystem::path>& folders = {});

/// The same from text; `name` stands for the file in messages.
CompiledModule compileText(const std::string& text, const std::string& name, const Defines& defines,
                           const std::vector<std::filesystem::path>& folders = {});

struct SourceText {
  std::string name, text;  // the name stands for the file in messages
};
/// Where included texts come from, and what is done to them.
struct Includes {
  std::vector<std::filesystem::path> folders;
  std::map<std::string, SourceText> given;                  // by header, in place of a file
  std::function<std::string(const SourceText&)> edit = {};  // every included text is what this makes of it
};
CompiledModule compileText(const SourceText& source, const Defines& defines, const Includes& includes);

/// The module as the driver gets it (Device::makePipeline() calls this): constants set and folded, dead branches,
/// functions and buffers gone, loops of known length written out where that can be (parsed_module.h). Takes about a millisecond.
std::vector<std::uint32_t> specialised(std::span<const std::uint32_t> spirv,
                                       const std::vector<std::pair<std::uint32_t, std::uint32_t>>& constants);

/// The module with these contents, by binding, in the place of its uniform buffers (blocks of one array of vec4 or
/// dvec4), and its loops marked for unrolling. Results do not change; the pipeline serves only these contents.
std::vector<std::uint32_t> baked(std::span<const std::uint32_t> spirv,
                                 const std::map<std::uint32_t, std::span<const std::byte>>& contents);

/// Empty, or spirv-val's message.
std::string validationError(std::span<const std::uint32_t> spirv);

/// Disassembly with names, for people and tests.
std::string disassemble(std::span<const std::uint32_t> spirv);

}  // namespace solidcast::gpu
