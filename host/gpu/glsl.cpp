// GLSL to SPIR-V in process, by glslang. Its C interface cannot include files, so this uses the C++ one.
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <utility>

#include "host/error.h"
#include "host/gpu/shaders.h"

namespace solidcast::gpu {
namespace {

namespace fs = std::filesystem;

std::string readFile(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || fs::is_directory(file)) {
    throw CompileError(file.string() + ": error: the shader file cannot be read", {file});
  }
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Looks beside the including file, then in the folders; remembers every file that was read. glslang asks for the
/// `local` place first (`#include "x"` alone), and for the `system` places where that gave nothing.
class Includer : public glslang::TShader::Includer {
 public:
  Includer(const Includes& rules, std::vector<fs::path>& files) : rules_(rules), files_(files) {}

  /// Places where nothing was found: a file that appears there changes what is included.
  const std::vector<fs::path>& missing() const { return missing_; }

  IncludeResult* includeLocal(const char* header, const char* includer, size_t depth) override {
    if (const auto given = rules_.given.find(header); given != rules_.given.end()) return edited(given->second);
    const fs::path beside = fs::path(includer).parent_path();
    looked_ = beside.empty() ? std::string(".") : beside.string();
    return depth > deepest ? nullptr : found(beside / header);
  }

  IncludeResult* includeSystem(const char* header, const char*, size_t depth) override {
    if (depth > deepest) return failed("nested deeper than 64 files, perhaps a file includes itself;");
    for (const fs::path& folder : rules_.folders) {
      if (IncludeResult* result = found(folder / header)) return result;
      looked_ += (looked_.empty() ? "" : ", ") + folder.string();
    }
    return failed("no such file in " + std::exchange(looked_, "") + ";");
  }

  void releaseInclude(IncludeResult* result) override {
    if (!result) return;
    delete static_cast<std::string*>(result->userData);
    delete result;
  }

 private:
  static constexpr size_t deepest = 64;

  IncludeResult* found(const fs::path& place) {
    const fs::path file = place.lexically_normal();
    if (!fs::is_regular_file(file)) {
      missing_.push_back(file);
      return nullptr;
    }
    if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(file);
    return edited({file.string(), readFile(file)});
  }
  IncludeResult* edited(const SourceText& source) const {
    return made(source.name, rules_.edit ? rules_.edit(source) : source.text);
  }
  /// glslang takes a result without a name for an error message; it adds "for header name: x".
  static IncludeResult* failed(const std::string& message) { return made("", message); }

  static IncludeResult* made(const std::string& name, std::string content) {
    auto text = std::make_unique<std::string>(std::move(content));
    auto* result = new IncludeResult(name, text->data(), text->size(), text.get());
    text.release();  // releaseInclude() has it from here
    return result;
  }

  const Includes& rules_;
  std::vector<fs::path>& files_;
  std::vector<fs::path> missing_;
  std::string looked_;  // for the message
};

/// Where the `:line:` of "path:line: message" begins; npos where there is none. The path may contain anything.
std::size_t lineNumberAt(const std::string& message) {
  for (std::size_t colon = message.find(':'); colon != std::string::npos; colon = message.find(':', colon + 1)) {
    const std::size_t end = message.find_first_not_of("0123456789", colon + 1);
    if (end != std::string::npos && end > colon + 1 && message.compare(end, 2, ": ") == 0) return colon;
  }
  return std::string::npos;
}

/// glslang's `ERROR: path:line: 'token' : message` becomes `path:line: error: 'token': message`. Warnings and
/// glslang's closing remarks are dropped; what has no place gets the file's name.
std::string reshaped(const std::string& log, const std::string& name) {
  const std::string prefix = "ERROR: ";
  std::istringstream lines(log);
  std::string out;
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(prefix)) continue;
    line.erase(line.find_last_not_of(' ') + 1).erase(0, prefix.size());
    std::string place = name, message = line;
    if (const std::size_t number = lineNumberAt(line); number != std::string::npos) {
      const std::size_t end = line.find(": ", number + 1);
      place = line.substr(0, end);
      message = line.substr(end + 2);
    }
    if (message.find("compilation errors.") != std::string::npos || message == "compilation terminated") continue;
    if (message.starts_with("'' : ")) message.erase(0, 5);
    if (message.starts_with("'")) {
      if (const std::size_t end = message.find("' : "); end != std::string::npos) message.erase(end + 1, 1);
    }
    message.erase(0, message.find_first_not_of(' '));
    out.append(out.empty() ? "" : "\n").append(place).append(": error: ").append(message);
  }
  return out.empty() ? name + ": error: glslang gave no reason: " + log : out;
}

}  // namespace

CompiledModule compileText(const SourceText& source, const Defines& defines, const Includes& includes) {
  struct Process {
    Process() { glslang::InitializeProcess(); }
    ~Process() { glslang::FinalizeProcess(); }
  };
  static const Process process;

  CompiledModule module;
  Includer includer(includes, module.files);
  const std::string& name = source.name;
  std::string preamble;
  for (const auto& [macro, value] : defines) preamble += "#define " + macro + " " + value + "\n";

  glslang::TShader shader(EShLangCompute);
  const char* const texts[] = {source.text.c_str()};
  const char* const names[] = {name.c_str()};
  shader.setStringsWithLengthsAndNames(texts, nullptr, names, 1);
  shader.setPreamble(preamble.c_str());
  shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  constexpr auto rules = EShMessages(EShMsgSpvRules | EShMsgVulkanRules | EShMsgCascadingErrors);
  constexpr int versionIfNoneGiven = 460;
  if (!shader.parse(GetDefaultResources(), versionIfNoneGiven, false, rules, includer)) {
    std::vector<fs::path> files = module.files;
    files.insert(files.end(), includer.missing().begin(), includer.missing().end());
    throw CompileError(reshaped(shader.getInfoLog(), name), std::move(files));
  }
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(rules)) throw CompileError(reshaped(program.getInfoLog(), name), module.files);

  glslang::SpvOptions options;
  options.disableOptimizer = true;
  glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), module.spirv, &options);
  return module;
}

CompiledModule compileText(const std::string& text, const std::string& name, const Defines& defines,
                           const std::vector<fs::path>& folders) {
  return compileText({name, text}, defines, {folders, {}});
}

CompiledModule compile(const fs::path& file, const Defines& defines, const std::vector<fs::path>& folders) {
  const std::string text = readFile(file);
  try {
    CompiledModule module = compileText(text, file.string(), defines, folders);
    module.files.insert(module.files.begin(), file);
    return module;
  } catch (const CompileError& error) {
    std::vector<fs::path> files = error.files();
    files.insert(files.begin(), file);
    throw CompileError(error.what(), std::move(files));
  }
}

}  // namespace solidcast::gpu
