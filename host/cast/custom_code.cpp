#include "host/cast/custom_code.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <span>
#include <string_view>

#include "host/carried/carried.h"
#include "host/error.h"

namespace solidcast {
namespace {

namespace fs = std::filesystem;

struct Entry {
  const char *program, *function, *signature;
};
constexpr Entry entries[] = {
    {"custom/radiance.comp", "radiance", "vec3 radiance(Hit hit, Ray ray, Parameters p)"},
    {"custom/intersect.comp", "intersect",
     "bool intersect(Ray ray, float tMin, float tMax, Parameters p, out float t, out vec3 normal)"}};
const Entry& entryOf(CustomKind kind) { return entries[static_cast<int>(kind)]; }

fs::path placeOf(const Scene& scene, const CustomCode& code) {
  return (fs::path(scene.file).parent_path() / code.file).lexically_normal();
}

std::optional<std::string> read(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in || fs::is_directory(file)) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

std::string parametersGlsl(const CustomCode& code) {
  std::string members, values;
  for (std::size_t i = 0; i < code.parameters.size(); ++i) {
    const bool single = code.parameters[i].value.index() == 0;
    members += std::string(single ? "  float " : "  vec3 ") + code.parameters[i].name + ";\n";
    values += (i > 0 ? ", " : "") + ("solidcast_values[" + std::to_string(i)) + (single ? "].x" : "].xyz");
  }
  if (members.empty()) members = "  float solidcast_none;\n", values = "0.0";  // GLSL has no empty struct
  return "struct Parameters {\n" + members + "};\nParameters solidcast_parameters() { return Parameters(" + values +
         "); }\n";
}

/// glslang tells that the declared function has no body. That it is missing, or which line has it otherwise, tells more.
std::string explained(const std::string& message, const Entry& entry, const std::string& name,
                      const std::string& text) {
  const bool bodiless = message.find("No function definition (body) found") != std::string::npos;
  // Another type of result is found as soon as the function is: at its own line, in words about overloading.
  const bool returnType = message.find("overloaded functions must have the same return type") != std::string::npos;
  if (!bodiless && !returnType) return message;
  const std::string plain = withoutComments(text);
  const std::regex definition(std::string(R"(\b\w+\s+)") + entry.function + R"(\s*\()");
  std::smatch found;
  if (!std::regex_search(plain, found, definition))
    return name + ":1: error: there is no function " + entry.function + ", expected " + entry.signature;
  const auto line = 1 + std::count(plain.begin(), plain.begin() + found.position(), '\n');
  return name + ":" + std::to_string(line) + ": error: " + entry.function + " is declared otherwise, expected " +
         entry.signature;
}

}  // namespace

CustomModule::CustomModule(CustomKind kind, const Scene& scene, const CustomCode& code, const CastOptions& options)
    : kind_(kind), file_(placeOf(scene, code)), parameters_(parametersGlsl(code)) {
  const Entry& entry = entryOf(kind);
  const std::optional<std::string> own = read(file_);
  if (!own) throw gpu::CompileError(file_.string() + ": error: cannot be read, expected a file of GLSL", {file_});

  gpu::Includes includes;
  std::string program;
  for (const gpu::CarriedText& text : std::span(gpu::kCarriedTexts, gpu::kCarriedTextCount)) {
    const bool isProgram =
        std::string_view(text.name) == entries[0].function || std::string_view(text.name) == entries[1].function;
    std::string name = std::string("custom/") + text.name + (isProgram ? ".comp" : ".glsl"), content(text.text);
    if (!options.shaderFolder.empty())  // somebody's own version of these
      if (auto theirs = read(fs::path(options.shaderFolder) / name)) content = std::move(*theirs);
    if (name == entry.program) program = content;
    includes.given[name] = {name, std::move(content)};
  }
  const std::string name = file_.string();
  includes.given["solidcast:parameters"] = {"parameters of " + name, parameters_};
  includes.given["solidcast:code"] = {name, *own};
  includes.edit = [&](const gpu::SourceText& source) {
    const bool ours = includes.given.contains(source.name) || source.name.starts_with("parameters of ");
    if (ours) return source.text;
    texts_.push_back({source.name, source.text});
    return guard_.guarded(source);
  };
  const std::string rows = std::to_string(std::max<std::size_t>(1, code.parameters.size()));
  const auto refuse = [&](const std::string& message, std::vector<fs::path> looked) {
    for (const fs::path& file : files()) looked.push_back(file);
    throw gpu::CompileError(message, std::move(looked));
  };
  try {
    spirv_ = gpu::compileText({entry.program, program}, {{"VALUES", rows}}, includes).spirv;
  } catch (const gpu::CompileError& error) {
    refuse(explained(error.what(), entry, name, *own), error.files());
  } catch (const Error& error) { refuse(error.what(), {}); }  // a loop that cannot be guarded
  // What compiles can still break rules that only the driver would find.
  if (const std::string wrong = gpu::validationError(spirv_); !wrong.empty())
    refuse(name + ": error: not valid once compiled: " + wrong, {});
}

std::vector<fs::path> CustomModule::files() const {
  std::vector<fs::path> files;
  for (const Text& text : texts_) files.push_back(text.file);
  return files;
}

bool CustomModule::serves(CustomKind kind, const Scene& scene, const CustomCode& code) const {
  return kind == kind_ && placeOf(scene, code) == file_ && parametersGlsl(code) == parameters_ &&
         std::all_of(texts_.begin(), texts_.end(), [](const Text& text) { return read(text.file) == text.text; });
}

std::vector<float> customValues(const CustomCode& code) {
  std::vector<float> values;
  for (const GlslParameter& parameter : code.parameters) {
    if (const double* number = std::get_if<double>(&parameter.value)) {
      values.insert(values.end(), {static_cast<float>(*number), 0, 0, 0});
      continue;
    }
    for (const double number : std::get<Triple>(parameter.value)) values.push_back(static_cast<float>(number));
    values.push_back(0);
  }
  values.resize(std::max<std::size_t>(4, values.size()));
  return values;
}

bool needsCustom(const Scene& scene, bool radiance) {
  return !scene.world.customSolids.empty() || (radiance && std::holds_alternative<CustomIntegrator>(scene.integrator));
}

}  // namespace solidcast
