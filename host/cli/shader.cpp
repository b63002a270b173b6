// `solidcast shader`: what the driver is given for a scene - specialised, and with constants where the plan bakes them.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "host/cli/options.h"
#include "host/cli/verbs.h"
#include "host/error.h"
#include "host/gpu/instruction_counts.h"
#include "host/gpu/shaders.h"
#include "host/image/output_file.h"

namespace solidcast::cli {
namespace {

constexpr char kShaderFooter[] =
    R"(glsl is not the source: it is the specialised SPIR-V turned back into GLSL by spirv-cross, which must be installed.
The source is in the folder shaders. disassembly and spirv are the very words. stats is JSON: instructions by class,
before and after specialisation, and what was left out. Several modules (a scene with users' own GLSL has more than
one) follow each other, but as spirv each gets a file of its own, a.spv -> a.NAME.spv.

Examples:
  solidcast shader scenes/a_solids.json --emit stats
  solidcast shader scenes/a_solids.json --emit glsl --method fast --plan baked -o fast.glsl
  solidcast shader scene.json --emit spirv -o scene.spv && spirv-val scene.spv)";

struct Shader {
  std::string scene, emit = "glsl", output = "-";
  ImageOptions image;
  CastingOptions casting;
};

struct Module {
  std::string name;
  std::vector<std::uint32_t> whole, given;
};

/// Makes all pipelines of a picture, casts nothing.
std::vector<Module> modulesOf(const Shader& shader, CastStats& stats) {
  Scene scene = loadWithWarnings(shader.scene);
  apply(shader.image, scene);
  Channels channels;
  channels.rgb8 = true;
  const RenderJob job = makeJob(shader.image, scene, channels);
  const std::unique_ptr<gpu::Device> device = openDevice(shader.casting);
  std::vector<Module> modules;
  device->watchModules(
      [&](const std::string& name, std::span<const std::uint32_t> whole, std::span<const std::uint32_t> given) {
        modules.push_back({name, {whole.begin(), whole.end()}, {given.begin(), given.end()}});
      });
  const ImageCaster caster(*device, scene, job, shader.casting.cast);
  stats = caster.stats();
  auto search = stats.modules.begin();
  for (Module& module : modules)
    if (module.name.empty()) module.name = *search++;  // one a pass
  return modules;
}

/// A file of its own that goes with the object.
struct TemporaryFile {
  explicit TemporaryFile(std::span<const std::uint32_t> words) : path(std::filesystem::temp_directory_path()) {
    path += "/solidcast-XXXXXX";
    const int file = ::mkstemp(path.data());
    if (file < 0) throw Error(Exit::output, path + ": a temporary file cannot be made");
    const auto bytes = std::as_bytes(words);
    const bool whole = ::write(file, bytes.data(), bytes.size()) == static_cast<::ssize_t>(bytes.size());
    ::close(file);
    if (whole) return;
    ::unlink(path.c_str());
    throw Error(Exit::output, path + ": a temporary file cannot be written");
  }
  ~TemporaryFile() { ::unlink(path.c_str()); }
  TemporaryFile(const TemporaryFile&) = delete;
  std::string path;
};

std::string glslOf(const Module& module) {
  const TemporaryFile file(module.given);
  // The path has no quotes unless the temporary folder's name has.
  const std::string command = "spirv-cross --vulkan-semantics --version 450 '" + file.path + "' 2>&1";
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(::popen(command.c_str(), "r"), [](FILE*) { return 0; });
  if (!pipe) throw Error(Exit::shader, "spirv-cross cannot be started");
  std::string text;
  std::array<char, 1 << 16> block;
  for (std::size_t n; (n = std::fread(block.data(), 1, block.size(), pipe.get())) > 0;) text.append(block.data(), n);
  if (const int status = ::pclose(pipe.get()); status != 0)
    throw Error(Exit::shader, status >> 8 == 127 ? "spirv-cross is not installed, expected it for --emit glsl"
                                                 : module.name + ": spirv-cross: " + text);
  return text;
}

std::string statsOf(const std::vector<Module>& modules, const CastStats& stats, const std::string& scene) {
  nlohmann::ordered_json json{{"scene", scene}, {"plan", stats.planName}};
  for (const Module& module : modules) {
    nlohmann::ordered_json counts;
    const auto before = gpu::instructionCounts(module.whole), after = gpu::instructionCounts(module.given);
    std::uint64_t whole = 0, given = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
      counts[before[i].first] = {{"whole", before[i].second}, {"given", after[i].second}};
      whole += before[i].second, given += after[i].second;
    }
    json["modules"].push_back({{"name", module.name},
                               {"whole_bytes", module.whole.size() * 4},
                               {"given_bytes", module.given.size() * 4},
                               {"whole_instructions", whole},
                               {"given_instructions", given},
                               {"instructions_by_class", counts}});
  }
  json["left_out"] = stats.leftOut;
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

void write(const std::string& path, const void* bytes, std::size_t size) {
  OutputFile file(path, false);
  file.append(bytes, size);
  file.finish();
}

/// a.spv -> a.NAME.spv, with nothing in NAME that a file's name should not have.
std::string pathFor(const std::string& path, std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  std::filesystem::path file(path);
  return file.replace_extension(name + file.extension().string()).string();
}

void run(const Shader& shader) {
  CastStats stats;
  const std::vector<Module> modules = modulesOf(shader, stats);
  if (shader.emit == "spirv") {
    if (modules.size() > 1 && shader.output == "-")
      throw Error(Exit::usage, "--emit spirv: the scene takes " + std::to_string(modules.size()) +
                                   " modules, expected -o FILE for names of their own");
    for (const Module& module : modules)
      write(modules.size() == 1 ? shader.output : pathFor(shader.output, module.name), module.given.data(),
            module.given.size() * 4);
    return;
  }
  std::string text;
  if (shader.emit == "stats") text = statsOf(modules, stats, shader.scene);
  else
    for (const Module& module : modules) {
      const bool glsl = shader.emit == "glsl";
      text += (glsl ? "// " : "; ") + module.name + (glsl ? ", from the specialised SPIR-V by spirv-cross\n" : "\n");
      text += glsl ? glslOf(module) : gpu::disassemble(module.given);
    }
  write(shader.output, text.data(), text.size());
}

}  // namespace

void addShader(CLI::App& app) {
  auto shader = std::make_shared<Shader>();
  CLI::App* verb = app.add_subcommand("shader", "write the shaders that the driver is given for a scene");
  verb->footer(kShaderFooter);
  verb->add_option("SCENE", shader->scene, "scene file (JSON) or mesh (.ply, .obj); - is standard input")->required();
  verb->add_option("--emit", shader->emit, "in which form (default glsl)")
      ->check(CLI::IsMember({"glsl", "spirv", "disassembly", "stats"}))
      ->type_name("glsl|spirv|disassembly|stats");
  verb->add_option("-o,--output", shader->output, "file to write; - is standard output (default -)")->type_name("FILE");
  addImageOptions(*verb, shader->image);
  addCastingOptions(*verb, shader->casting);
  addPlan(*verb, shader->casting);
  verb->callback([shader] { run(*shader); });
}

}  // namespace solidcast::cli
