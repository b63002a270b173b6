#include "host/cli/options.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <thread>

#include "host/cast/plan.h"
#include "host/error.h"
#include "host/scene/load.h"

namespace solidcast::cli {
namespace {

constexpr int kLargestSide = 100000;
constexpr int kMostSamples = 64;

/// An option whose value is one of a few words.
template <class T>
CLI::Option* addChoice(CLI::App& verb, const std::string& name, T& value,
                       const std::vector<std::pair<std::string, T>>& choices, const std::string& help) {
  std::string words;
  for (const auto& [word, unused] : choices) words += (words.empty() ? "" : "|") + word;
  const auto set = [&value, choices, name, words](const std::string& given) {
    for (const auto& [word, meaning] : choices)
      if (word == given) {
        value = meaning;
        return;
      }
    throw Error(Exit::usage, name + ": \"" + given + "\" is unknown, expected " + words);
  };
  return verb.add_option_function<std::string>(name, set, help)->type_name(words);
}

/// Splits text into exactly `count` whole numbers with `separator` between them.
bool wholeNumbers(const std::string& text, char separator, int* out, int count) {
  const char *at = text.data(), *end = at + text.size();
  for (int i = 0; i < count; ++i) {
    if (i > 0 && (at == end || *at++ != separator)) return false;
    const auto [next, error] = std::from_chars(at, end, out[i]);
    if (error != std::errc{}) return false;
    at = next;
  }
  return at == end;
}

}  // namespace

std::pair<int, int> parseSize(const std::string& option, const std::string& text) {
  int side[2];
  if (!wholeNumbers(text, 'x', side, 2) || std::min(side[0], side[1]) < 1 || std::max(side[0], side[1]) > kLargestSide)
    throw Error(Exit::usage, option + ": \"" + text + "\" is no image size, expected WIDTHxHEIGHT, each from 1 to " +
                                 std::to_string(kLargestSide) + ", e.g. 640x480");
  return {side[0], side[1]};
}

Crop parseCrop(const std::string& option, const std::string& text) {
  int value[4];
  if (!wholeNumbers(text, ',', value, 4) || value[0] < 0 || value[1] < 0 || value[2] < 1 || value[3] < 1)
    throw Error(Exit::usage, option + ": \"" + text +
                                 "\" is no part of an image, expected X,Y,WIDTH,HEIGHT in pixels from the top left "
                                 "corner, e.g. 100,50,64,64");
  return {value[0], value[1], value[2], value[3]};
}

std::pair<int, int> parsePixel(const std::string& option, const std::string& text) {
  int place[2];
  if (!wholeNumbers(text, ',', place, 2) || place[0] < 0 || place[1] < 0)
    throw Error(Exit::usage, option + ": \"" + text +
                                 "\" is no pixel, expected X,Y from the top left corner, each from 0 up, e.g. 320,240");
  return {place[0], place[1]};
}

void addImageOptions(CLI::App& verb, ImageOptions& options) {
  const auto setIntegrator = [&options](const std::string& given) {
    if (given != "casting" && given != "castingdist" && given != "custom" && !given.ends_with(".glsl"))
      throw Error(Exit::usage,
                  "--integrator: \"" + given + "\" is unknown, expected casting|castingdist|custom or a file *.glsl");
    options.integrator = given;
  };
  verb.add_option_function<std::string>(
          "--integrator", setIntegrator,
          "what a hit looks like: its cosine, the cosine times a colour by distance, the scene's own GLSL, or that of "
          "a file *.glsl, with the scene's parameters (default: as the scene says)")
      ->type_name("casting|castingdist|custom");
  verb.add_option_function<std::string>(
          "--size",
          [&options](const std::string& text) { std::tie(options.width, options.height) = parseSize("--size", text); },
          "pixels of the image; opening angles stay (default: as the scene says)")
      ->type_name("WxH");
  verb.add_option_function<std::string>(
          "--samples",
          [&options](const std::string& text) {
            if (!wholeNumbers(text, ' ', &options.samples, 1) || options.samples < 1 || options.samples > kMostSamples)
              throw Error(Exit::usage, "--samples: \"" + text + "\" is no number of samples, expected 1 to " +
                                           std::to_string(kMostSamples) + " (a grid of N x N in the pixel)");
          },
          "regular N x N grid in the pixel; 1 is its centre (default 1)")
      ->type_name("N");
  verb.add_flag("--two-sided", options.twoSided, "|d.n| instead of max(0, -d.n): open surfaces seen from behind");
  verb.add_option_function<std::string>(
          "--crop", [&options](const std::string& text) { options.crop = parseCrop("--crop", text); },
          "only this part; its pixels are the whole image's")
      ->type_name("X,Y,W,H");
}

void addCastingOptions(CLI::App& verb, CastingOptions& options) {
  verb.add_option("--device", options.device,
                  "Vulkan device by number, part of its name, cpu or gpu, see the verb devices "
                  "(default: a GPU before a CPU)")
      ->type_name("N|NAME|cpu|gpu");
  addChoice<Method>(verb, "--method", options.cast.method,
                    {{"naive", Method::naive}, {"fast", Method::fast}, {"exact", Method::exact}},
                    "arithmetic of the GPU side (default exact)");
  addChoice<Arithmetic>(verb, "--arithmetic", options.cast.arithmetic,
                        {{"auto", Arithmetic::automatic}, {"fp64", Arithmetic::fp64}, {"df32", Arithmetic::df32}},
                        "what exact computes with; auto takes fp64 where the device has it (default auto)");
  addChoice<reference::Precision>(
      verb, "--precision", options.precision,
      {{"f32", reference::Precision::f32}, {"f64", reference::Precision::f64}, {"f128", reference::Precision::f128}},
      "number type of the CPU reference (default f64)");
  verb.add_option("--shaders", options.cast.shaderFolder,
                  "compile the shaders from this folder instead of those carried in the program")
      ->type_name("DIR");
  addChoice<gpu::Validation>(
      verb, "--validation", options.validation,
      {{"auto", gpu::Validation::automatic}, {"on", gpu::Validation::on}, {"off", gpu::Validation::off}},
      "Vulkan validation layer; auto: where installed and SOLIDCAST_VALIDATION=1 (default auto)");
}

namespace {
constexpr char kShowPlan[] = "show";
}

void addPlan(CLI::App& verb, CastingOptions& options) {
  std::string names;
  for (const std::string& name : planNames()) names += (names.empty() ? "" : "|") + name;
  verb.add_option_function<std::string>(
          "--plan",
          [&options](const std::string& name) {
            if (name == kShowPlan) options.showPlan = true;
            else options.cast.plan = planByName(name);
          },
          "how solids are searched; without a name: print what was decided and why (default auto)")
      ->type_name("[" + names + "]");
}

void printPlan(const CastingOptions& options, const CastStats& stats) {
  if (!options.showPlan) return;
  for (const std::string& line : stats.plan) note("plan: " + line);
}

std::vector<std::string> withLeftOutValues(std::vector<std::string> words) {
  const std::vector<std::string> plans = planNames();
  const auto isPlan = [&plans](const std::string& word) {
    return std::find(plans.begin(), plans.end(), word) != plans.end();
  };
  const auto isNumber = [](const std::string& word) {
    return !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isdigit(c); });
  };
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool plan = words[i] == "--plan", serve = words[i] == "--serve";
    if (!plan && !serve) continue;
    if (i + 1 < words.size() && (plan ? isPlan(words[i + 1]) : isNumber(words[i + 1]))) {
      words[i] += "=" + words[i + 1];
      words.erase(words.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    } else {
      words[i] += std::string("=") + (plan ? kShowPlan : kUsualPort);
    }
  }
  return words;
}

void addBackend(CLI::App& verb, Backend& backend) {
  addChoice<Backend>(verb, "--backend", backend, {{"gpu", Backend::gpu}, {"cpu", Backend::cpu}},
                     "cast on a Vulkan device, or by the CPU reference (default gpu)");
}

void checkBackend(const CLI::App& verb, Backend backend) {
  if (backend == Backend::gpu) {
    if (verb.count("--precision") > 0)
      throw Error(Exit::usage,
                  "--precision: chooses the number type of the CPU reference, expected --backend cpu with it");
    return;
  }
  for (const char* option : {"--device", "--method", "--arithmetic", "--shaders", "--plan"})
    if (verb.get_option_no_throw(option) != nullptr && verb.count(option) > 0)
      throw Error(Exit::usage,
                  std::string(option) + ": has no meaning for the CPU reference, expected --backend gpu with it");
}

Scene loadWithWarnings(const std::string& file) {
  std::vector<std::string> warnings;
  Scene scene = loadScene(file, warnings);
  for (const std::string& warning : warnings) note("warning: " + warning);
  return scene;
}

void apply(const ImageOptions& options, Scene& scene) {
  if (options.integrator == "casting") scene.integrator = RayCastingIntegrator{};
  if (options.integrator == "castingdist") {
    if (!scene.distParameters)
      throw Error(Exit::usage, scene.file +
                                   ": the scene gives no distances and colours for --integrator castingdist, expected "
                                   "\"castingdist\": {near_color, near_dist, far_color, far_dist}");
    scene.integrator = *scene.distParameters;
  }
  const bool file = options.integrator.ends_with(".glsl");
  if (options.integrator == "custom" || file) {
    if (!file && !scene.customIntegrator)
      throw Error(Exit::usage, scene.file +
                                   ": the scene names no GLSL for --integrator custom, expected "
                                   "{\"type\": \"custom\", \"glsl\": FILE} in its list of integrators");
    CustomIntegrator custom = scene.customIntegrator.value_or(CustomIntegrator{});
    // World's names count from the scene's folder, the command line's from the current one.
    if (file) {
      const auto folder = std::filesystem::path(scene.file).parent_path();
      custom.code.file = std::filesystem::proximate(options.integrator, folder.empty() ? "." : folder).string();
    }
    scene.integrator = custom;
  }
  if (options.width > 0) {
    scene.width = options.width;
    scene.height = options.height;
  }
}

void keepToTheReference(Scene& scene) {
  if (!scene.world.customSolids.empty())
    throw Error(Exit::usage, scene.file + ": " + solidName(scene.world, std::uint32_t(scene.world.solids.size())) +
                                 " is a custom solid, which the reference does not know, expected none in the scene");
  if (!std::holds_alternative<CustomIntegrator>(scene.integrator)) return;
  note("the reference runs no GLSL: looked at is what was hit, with the integrator casting");
  scene.integrator = RayCastingIntegrator{};
}

RenderJob makeJob(const ImageOptions& options, const Scene& scene, const Channels& channels) {
  const Crop& crop = options.crop;
  if (crop.width > 0 && (crop.width > scene.width - crop.x || crop.height > scene.height - crop.y))
    throw Error(Exit::usage, "--crop: " + std::to_string(crop.x) + "," + std::to_string(crop.y) + "," +
                                 std::to_string(crop.width) + "," + std::to_string(crop.height) +
                                 " reaches outside the image, expected a part of " + std::to_string(scene.width) + "x" +
                                 std::to_string(scene.height));
  return {scene.width, scene.height, crop, options.samples, scene.twoSided || options.twoSided, channels};
}

std::unique_ptr<gpu::Device> openDevice(const CastingOptions& options) {
  auto device = std::make_unique<gpu::Device>(gpu::Device::Options{options.device, options.validation});
  const gpu::DeviceInfo& info = device->info();
  note("device " + std::to_string(info.index) + ": " + info.name + ", " +
       (info.driverInfo.empty() ? info.driver : info.driverInfo) + ", Vulkan " + info.apiVersion);
  return device;
}

std::string cpuName(reference::Precision precision) {
  const unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  return std::string("CPU reference, ") + precisionName(precision) + ", " + std::to_string(threads) +
         (threads == 1 ? " thread" : " threads");
}

const char* precisionName(reference::Precision precision) {
  switch (precision) {
    case reference::Precision::f32:
      return "f32";
    case reference::Precision::f64:
      return "f64";
    case reference::Precision::f128:
      return "f128";
  }
  return "";
}

void note(const std::string& line) {
  const std::string text = "solidcast: " + line + "\n";
  // A lost message is no reason to stop: nobody is there to be told.
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace solidcast::cli
