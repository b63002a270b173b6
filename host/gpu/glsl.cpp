// GLSL to SPIR-V in process, by glslang. Its C interface cannot include files, so this uses the C++ one.
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "host/error.h"
#include "host/gpu/shaders.h"

namespace solidcast::gpu {
namespace {

namespace fs = std::filesystem;

std::string readFile(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || fs::is_directory(file)) {
    throw Error(Exit::shader, file.string() + ": error: the shader file cannot be read");
  }
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Looks beside the including file, then in the folders; remembers every file that was read.
class Includer : public glslang::TShader::Includer {
 public:
  Includer(const std::vector<fs::path>& folders, std::vector<fs::path>& files) : folders_(folders), files_(files) {}

  IncludeResult* includeLocal(const char* header, const char* includer, size_t depth) override {
    constexpr size_t deepest = 64;
    if (depth > deepest) return failed("nested deeper than 64 files; does a file include itself? ");
    std::vector<fs::path> places{fs::path(includer).parent_path()};
    places.insert(places.end(), folders_.begin(), folders_.end());
    std::string looked;
    for (const fs::path& place : places) {
      const fs::path file = (place / header).lexically_normal();
      if (fs::is_regular_file(file)) {
        if (std::find(files_.begin(), files_.end(), file) == files_.end()) files_.push_back(file);
        auto* text = new std::string(readFile(file));
        return new IncludeResult(file.string(), text->data(), text->size(), text);
      }
      looked += (looked.empty() ? "" : ", ") + (place.empty() ? "." : place.string());
    }
    return failed("no such file; looked in " + looked + " ");
  }

  IncludeResult* includeSystem(const char*, const char*, size_t) override { return nullptr; }

  void releaseInclude(IncludeResult* result) override {
    if (!result) return;
    delete static_cast<std::string*>(result->userData);
    delete result;
  }

 private:
  /// An empty name tells glslang that the text is an error message.
  static IncludeResult* failed(const std::string& message) {
    auto* text = new std::string(message);
    return new IncludeResult("", text->data(), text->size(), text);
  }

  const std::vector<fs::path>& folders_;
  std::vector<fs::path>& files_;
};

/// glslang's `ERROR: path:line: 'token' : message` becomes `path:line: error: 'token': message`. Warnings and the
/// closing count of errors are dropped; what has no place gets the file's name.
std::string reshaped(const std::string& log, const std::string& name) {
  static const std::regex placed(R"(^ERROR: (.*?):(\d+): (?:'(.*?)' : +)?(.*)$)");
  static const std::regex count(R"(^ERROR: \d+ compilation errors\..*$)");
  std::istringstream lines(log);
  std::string line, out;
  std::smatch part;
  while (std::getline(lines, line)) {
    if (std::regex_match(line, count) || !line.starts_with("ERROR: ")) continue;
    if (!out.empty()) out += '\n';
    if (std::regex_match(line, part, placed)) {
      out += part[1].str() + ":" + part[2].str() + ": error: ";
      if (part[3].length() > 0) out.append(1, '\'').append(part[3]).append("': ");
      out += part[4];
    } else {
      out += name + ": error: " + line.substr(7);
    }
  }
  return out.empty() ? name + ": error: glslang gave no reason: " + log : out;
}

}  // namespace

CompiledModule compileText(const std::string& text, const std::string& name, const Defines& defines,
                           const std::vector<fs::path>& folders) {
  struct Process {
    Process() { glslang::InitializeProcess(); }
    ~Process() { glslang::FinalizeProcess(); }
  };
  static const Process process;

  CompiledModule module;
  Includer includer(folders, module.files);
  std::string preamble;
  for (const auto& [macro, value] : defines) preamble += "#define " + macro + " " + value + "\n";

  glslang::TShader shader(EShLangCompute);
  const char* const texts[] = {text.c_str()};
  const char* const names[] = {name.c_str()};
  shader.setStringsWithLengthsAndNames(texts, nullptr, names, 1);
  shader.setPreamble(preamble.c_str());
  shader.setEnvInput(glslang::EShSourceGlsl, EShLangCompute, glslang::EShClientVulkan, 100);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  constexpr auto rules = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
  constexpr int versionIfNoneGiven = 460;
  if (!shader.parse(GetDefaultResources(), versionIfNoneGiven, false, rules, includer)) {
    throw Error(Exit::shader, reshaped(shader.getInfoLog(), name));
  }
  glslang::TProgram program;
  program.addShader(&shader);
  if (!program.link(rules)) throw Error(Exit::shader, reshaped(program.getInfoLog(), name));

  glslang::SpvOptions options;
  options.disableOptimizer = true;
  glslang::GlslangToSpv(*program.getIntermediate(EShLangCompute), module.spirv, &options);
  return module;
}

CompiledModule compile(const fs::path& file, const Defines& defines, const std::vector<fs::path>& folders) {
  CompiledModule module = compileText(readFile(file), file.string(), defines, folders);
  module.files.insert(module.files.begin(), file);
  return module;
}

}  // namespace solidcast::gpu
