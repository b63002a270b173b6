// `solidcast bench`: how fast, beside whom, as a report to paste.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <memory>

#include "host/bench/left_out.h"
#include "host/bench/processes.h"
#include "host/bench/race.h"
#include "host/bench/report.h"
#include "host/bench/scenes.h"
#include "host/cli/options.h"
#include "host/cli/progress.h"
#include "host/cli/verbs.h"
#include "host/error.h"

namespace solidcast::cli {
namespace {

constexpr char kBenchFooter[] =
    R"(All contestants cast the same rays, one turn each in every round, on all cores. A SCENE is a file, the name of a
bundled scene (a_solids), or random:KIND:COUNT[:SEED] as generate makes them. Without --method: fast and exact.
  dispatch  casting and storing 8-bit colours (ours by the device's clock; peers: tracing)
  build     ours: flattening, lists of tiles; peers: records, geometry and commit
  image     from arrays of solids to the finished image; ours with a pipeline that serves any such scene
  pixels off  more than 1 level from what exact shows
  first image  the same with compilation (disk cache of the driver warm), by phases
Peers: embree (Embree 3: rtcIntersect16 and rtcIntersect1; package libembree-dev), simd (hand-written AVX-512 or AVX2,
for small scenes), cpu (the reference; --precision), povray (POV-Ray 3.7 from start to PNG file, beside this program's
render from start to PNG file; package povray).

Examples:
  solidcast bench
  solidcast bench a_solids --size 1920x1080 --against embree,simd,cpu --runs 11
  solidcast bench random:sphere:100000 random:triangle:100000 --method fast --against embree
  solidcast bench a_solids --left-out --size 1920x1080
  solidcast bench scene.json --json | jq '.[] | [.method, .mrays_per_s]')";

struct Bench {
  std::vector<std::string> scenes, against;
  int width = 0, height = 0, runs = 5;
  bool json = false, leftOut = false;
  CastingOptions casting;
};

constexpr const char* kPeers[] = {"embree", "simd", "cpu", "povray"};

void checkPeers(const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::find(std::begin(kPeers), std::end(kPeers), name) == std::end(kPeers))
      throw Error(Exit::usage, "--against: \"" + name + "\" is unknown, expected embree, simd, cpu or povray");
}

std::vector<std::unique_ptr<bench::Peer>> peersFor(const Bench& options, const Scene& scene) {
  std::vector<std::unique_ptr<bench::Peer>> peers;
  const auto asked = [&](const char* name) {
    return std::find(options.against.begin(), options.against.end(), name) != options.against.end();
  };
  const int w = scene.width, h = scene.height;
  if (asked("embree")) {
    peers.push_back(bench::embreePeer(scene, w, h, true));
    peers.push_back(bench::embreePeer(scene, w, h, false));
  }
  if (asked("simd")) {
    peers.push_back(bench::simdPeer(scene, w, h, false));
    peers.push_back(bench::simdPeer(scene, w, h, true));
  }
  if (asked("cpu")) peers.push_back(bench::referencePeer(scene, w, h, options.casting.precision));
  if (asked("povray")) {
    for (const char* method : {"fast", "exact"}) peers.push_back(bench::renderProcess(scene, w, h, method));
    peers.push_back(bench::povrayProcess(scene, w, h));
  }
  return peers;
}

void run(const CLI::App& verb, const Bench& options) {
  checkPeers(options.against);
  if (options.leftOut && (options.json || !options.against.empty()))
    throw Error(Exit::usage, "--left-out: is a table of its own, expected neither --json nor --against with it");
  std::vector<bench::Entry> entries;
  if (verb.count("--method") > 0) {
    const char* names[] = {"naive", "fast", "exact"};
    entries.push_back({names[static_cast<int>(options.casting.cast.method)], options.casting.cast});
  } else {
    for (const auto& [name, method] : {std::pair{"fast", Method::fast}, std::pair{"exact", Method::exact}}) {
      entries.push_back({name, options.casting.cast});
      entries.back().options.method = method;
    }
  }
  std::vector<Scene> scenes;
  for (const std::string& name : options.scenes.empty() ? bench::carriedScenes() : options.scenes) {
    std::vector<std::string> warnings;
    scenes.push_back(bench::sceneNamed(name, warnings));
    for (const std::string& warning : warnings) note("warning: " + warning);
    if (options.width > 0) scenes.back().width = options.width, scenes.back().height = options.height;
    peersFor(options, scenes.back());  // what cannot be had is said before anything is measured
  }
  const std::unique_ptr<gpu::Device> device = openDevice(options.casting);
  if (!options.json) std::cout << bench::headText(device->info());
  std::vector<bench::SceneResults> all;
  for (const Scene& scene : scenes) {
    Progress bar;
    if (options.leftOut) {
      const CastOptions& cast = entries.front().options;
      std::cout << bench::leftOutText(*device, options.casting.device, scene, cast, options.runs, [&](double fraction) {
        bar.show(fraction, scene.file);
      }) << std::flush;
      continue;
    }
    bench::Race race(*device, scene, entries, peersFor(options, scene));
    all.push_back({scene.file, scene.width, scene.height, options.runs, scene.world.solids.size(),
                   race.run(options.runs, [&](double fraction) { bar.show(fraction, scene.file); })});
    if (!options.json) std::cout << bench::text(all.back()) << std::flush;
  }
  if (options.json) std::cout << bench::json(device->info(), all);
}

}  // namespace

void addBench(CLI::App& app) {
  auto options = std::make_shared<Bench>();
  CLI::App* verb = app.add_subcommand("bench", "measure speed, beside other ray casters");
  verb->footer(kBenchFooter);
  verb->add_option("SCENE", options->scenes, "scenes (default: the bundled ones)");
  verb->add_option("--against", options->against, "peers to measure beside: embree,simd,cpu,povray (default: none)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LIST");
  verb->add_option_function<std::string>(
          "--size",
          [options](const std::string& text) { std::tie(options->width, options->height) = parseSize("--size", text); },
          "pixels of the image (default: as the scene says)")
      ->type_name("WxH");
  verb->add_option("--runs", options->runs, "rounds that are counted")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  addCastingOptions(*verb, options->casting);
  addPlan(*verb, options->casting);
  verb->add_flag("--left-out", options->leftOut,
                 "instead: what it would cost to leave in what a scene does not need (--method, default fast)");
  verb->add_flag("--json", options->json, "print JSON on standard output, one object a scene and method");
  verb->callback([verb, options] { run(*verb, *options); });
}

}  // namespace solidcast::cli
