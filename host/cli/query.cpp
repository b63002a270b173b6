// `solidcast query`: casts any rays, one a line in, one JSON object a line out, in bounded memory.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "host/cli/options.h"
#include "host/cli/progress.h"
#include "host/cli/rays.h"
#include "host/cli/verbs.h"
#include "host/error.h"
#include "host/image/output_file.h"

namespace solidcast::cli {
namespace {

constexpr std::size_t kBlock = 65536;  // rays that are read, cast and printed together

constexpr char kQueryFooter[] =
    R"(Rays: one a line, "ox oy oz dx dy dz [tmax]", numbers decimal or hex float (0x1.8p+3), rounded to fp32; '#'
starts a comment. A hit needs 0 < t < tmax; t counts in lengths of the direction. Output, one line a ray, in order:
  {"ray":0,"hit":true,"t":7.5,"solid":"ball","index":2,"normal":[x,y,z],"local":[x,y,z],"position":[x,y,z]}
  {"ray":1,"hit":false}
"ray" counts rays from 0, "index" the scene's solids, depth first, from 0.

Examples:
  echo "0 0 10  0 0 -1" | solidcast query scenes/a_solids.json --rays -
  solidcast query scene.json --rays rays.txt --hex -o hits.jsonl
  solidcast query scene.json --rays rays.txt --backend cpu --precision f128)";

struct Query {
  std::string scene, rays, output = "-";
  float tMax = std::numeric_limits<float>::infinity();
  bool hex = false;
  Backend backend = Backend::gpu;
  CastingOptions casting;
};

using CastRays = std::function<void(std::span<const QueryRay>, std::span<QueryHit>)>;

/// Writes to standard output; false when its reader has gone away, so that there is nobody left to cast for.
bool toStandardOutput(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(STDOUT_FILENO, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0 && errno == EPIPE) return false;
    if (written < 0) throw Error(Exit::output, "standard output: cannot write: " + systemMessage(errno));
    text.remove_prefix(written);
  }
  return true;
}

/// The whole stream; `rays` holds the first `count` of it. `cast` is the GPU's or the reference's.
void stream(const Query& query, const World& world, RayReader& reader, std::vector<QueryRay>& rays, std::size_t count,
            OutputFile* file, const CastRays& cast) {
  std::vector<QueryHit> hits(rays.size());
  const HitFormatter formatter(world, query.hex);
  std::string text;
  Progress progress;
  const bool quiet = file == nullptr && isatty(STDOUT_FILENO) == 1;  // a bar among the lines helps nobody
  for (std::uint64_t first = 0; count > 0; count = reader.read(rays)) {
    cast({rays.data(), count}, {hits.data(), count});
    text.clear();
    for (std::size_t i = 0; i < count; ++i) formatter.append(text, first + i, hits[i]);
    if (file != nullptr) file->append(text.data(), text.size());
    else if (!toStandardOutput(text)) return;
    first += count;
    if (!quiet) progress.show(reader.fraction());
  }
  if (file != nullptr) file->finish();
}

void run(const CLI::App& verb, const Query& query) {
  checkBackend(verb, query.backend);
  if (query.scene == "-" && query.rays == "-")
    throw Error(Exit::usage, "--rays: standard input cannot hold both the scene and the rays, expected a file for one");
  const Scene scene = loadWithWarnings(query.scene);
  RayReader reader(query.rays, query.tMax);
  std::optional<OutputFile> opened;
  if (query.output != "-") opened.emplace(query.output, false);
  OutputFile* file = opened ? &*opened : nullptr;
  // The first block before the device, so that a bad ray is told at once.
  std::vector<QueryRay> rays(kBlock);
  const std::size_t count = reader.read(rays);
  const auto streamWith = [&](const CastRays& cast) { stream(query, scene.world, reader, rays, count, file, cast); };
  if (query.backend == Backend::cpu) {
    note(cpuName(query.casting.precision));
    streamWith([&](std::span<const QueryRay> some, std::span<QueryHit> hits) {
      reference::cast(scene.world, some, hits, query.casting.precision);
    });
    return;
  }
  const std::unique_ptr<gpu::Device> device = openDevice(query.casting);
  QueryCaster caster(*device, scene.world, query.casting.cast);
  printPlan(query.casting, caster.stats());
  streamWith([&](std::span<const QueryRay> some, std::span<QueryHit> hits) { caster.cast(some, hits); });
}

}  // namespace

void addQuery(CLI::App& app) {
  auto query = std::make_shared<Query>();
  CLI::App* verb = app.add_subcommand("query", "cast any rays at a scene");
  verb->footer(kQueryFooter);
  verb->add_option("SCENE", query->scene, "scene file (JSON) or mesh (.ply, .obj); - is standard input")->required();
  verb->add_option("--rays", query->rays, "file of rays; - is standard input")->required()->type_name("FILE|-");
  verb->add_option("-o,--output", query->output, "file for the hits; - is standard output (default -)")
      ->type_name("FILE");
  verb->add_option_function<std::string>(
          "--tmax",
          [query](const std::string& word) {
            if (const auto wrong = parseNumber(word, query->tMax)) throw Error(Exit::usage, "--tmax: " + *wrong);
            if (!(query->tMax >= 0))
              throw Error(Exit::usage, "--tmax: " + word + " is out of range, expected 0 or more");
          },
          "for rays that give none: hits at t below this count (default: no limit)")
      ->type_name("T");
  verb->add_flag("--hex", query->hex, "print numbers as strings of hex floats");
  addBackend(*verb, query->backend);
  addCastingOptions(*verb, query->casting);
  addPlan(*verb, query->casting);
  verb->callback([verb, query] { run(*verb, *query); });
}

}  // namespace solidcast::cli
