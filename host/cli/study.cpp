// `solidcast study`: error against run time, as a table, as data and as a page with plots.
#include "host/study/study.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <memory>

#include "host/cli/interrupt.h"
#include "host/cli/options.h"
#include "host/cli/progress.h"
#include "host/cli/verbs.h"
#include "host/error.h"
#include "host/image/output_file.h"
#include "host/scene/load.h"

namespace solidcast::cli {
namespace {

constexpr char kStudyFooter[] =
    R"(Without SCENE, --solid or --catalogue: all solids, the catalogue and the scene of seven solids.
Writes study.html (open it in a browser; it needs no network), study.csv and study.json into DIR. Ctrl-C ends the
study early; the files then hold what was measured by then.

Examples:
  solidcast study -o report
  solidcast study --solid sphere --rays 20000 -o report
  solidcast study scenes/showpiece.json -o report
  solidcast study --catalogue -o report)";

struct Options {
  std::string scene, solid, folder;
  bool catalogue = false;
  std::uint32_t rays = 100'000;
  std::uint64_t seed = 1;
  int runs = 25;
  CastingOptions casting;
};

void write(const std::filesystem::path& path, const std::string& text) {
  OutputFile file(path.string(), false);
  file.append(text.data(), text.size());
  file.finish();
}

void writeAll(const study::Study& study, const std::filesystem::path& folder) {
  write(folder / "study.csv", toCsv(study));
  write(folder / "study.json", toJson(study));
  write(folder / "study.html", toHtml(study));
}

std::optional<oracle::Kind> kindOf(const std::string& name) {
  for (const oracle::Kind kind : oracle::kKinds)
    if (name == oracle::nameOf(kind)) return kind;
  return std::nullopt;
}

study::Request requestOf(const Options& options) {
  study::Request request;
  request.rays = options.rays, request.seed = options.seed, request.runs = options.runs;
  request.kind = kindOf(options.solid);
  const bool some = !options.scene.empty() || request.kind || options.catalogue;
  request.families = request.sweeps = !some || request.kind;
  request.catalogue = !some || options.catalogue;
  if (!options.scene.empty()) {
    request.scenes.push_back(loadWithWarnings(options.scene));
  } else if (!some) {
    request.scenes.push_back(aSolids());
    request.scenes.back().file = "a_solids";
  }
  return request;
}

std::string commandOf(const Options& options) {
  std::string command = "solidcast study";
  if (!options.scene.empty()) command += " " + options.scene;
  if (!options.solid.empty()) command += " --solid " + options.solid;
  if (options.catalogue) command += " --catalogue";
  return command + " --rays " + std::to_string(options.rays) + " --seed " + std::to_string(options.seed) + " --runs " +
         std::to_string(options.runs);
}

void run(const Options& options) {
  study::Study study;
  study.request = requestOf(options);
  study.command = commandOf(options);
  study.version = SOLIDCAST_VERSION;
  const std::filesystem::path folder = options.folder;
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (!std::filesystem::is_directory(folder))
    throw Error(Exit::output, options.folder + ": cannot be made a folder" + (failed ? ": " + failed.message() : ""));
  const std::unique_ptr<gpu::Device> device = openDevice(options.casting);
  int interrupted = 0;
  {
    const UntilInterrupt interrupt;
    Progress bar;
    auto written = std::chrono::steady_clock::time_point{};
    run(*device, study, [&](const study::Study& now, double fraction, const std::string& next) {
      bar.show(fraction, next);
      if (std::chrono::steady_clock::now() - written > std::chrono::seconds(2)) {
        writeAll(now, folder);
        written = std::chrono::steady_clock::now();
      }
      return interrupt.number() == 0;
    });
    writeAll(study, folder);
    interrupted = interrupt.number();
  }
  note((study.complete ? "wrote " : "interrupted; what was measured is in ") + (folder / "study.html").string());
  if (!study.complete) throw CLI::RuntimeError(128 + interrupted);
}

}  // namespace

void addStudy(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("study", "measure error against run time and report it");
  verb->footer(kStudyFooter);
  std::vector<std::string> kinds;
  for (const oracle::Kind kind : oracle::kKinds) kinds.emplace_back(oracle::nameOf(kind));
  auto* scene =
      verb->add_option("SCENE", options->scene, "scene file (JSON) or mesh (.ply, .obj): its picture, by every method");
  auto* solid = verb->add_option("--solid", options->solid, "only this kind of solid")->check(CLI::IsMember(kinds));
  auto* catalogue = verb->add_flag("--catalogue", options->catalogue, "only the catalogue of extreme cases");
  scene->excludes(solid)->excludes(catalogue);
  solid->excludes(catalogue);
  verb->add_option("--rays", options->rays, "rays a family")->check(CLI::Range(1, 100'000'000))->capture_default_str();
  verb->add_option("--seed", options->seed, "start of the random numbers")->capture_default_str();
  verb->add_option("--runs", options->runs, "dispatches that a time is the median of")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  verb->add_option("-o,--output", options->folder, "folder for the files; made where it is missing")
      ->required()
      ->type_name("DIR");
  verb->add_option("--device", options->casting.device, "number, part of a name, cpu or gpu");
  verb->callback([options] { run(*options); });
}

}  // namespace solidcast::cli
