// `solidcast generate`: a scene file of random solids, the same for the same seed, for measurements on large scenes.
#include <CLI/CLI.hpp>
#include <memory>

#include "host/cli/verbs.h"
#include "host/error.h"
#include "host/image/output_file.h"
#include "host/scene/random.h"
#include "host/scene/write.h"

namespace solidcast::cli {
namespace {

constexpr char kGenerateFooter[] =
    R"(The solids fill a ball of radius 10 around zero, seen from (0, 0, 30). Same arguments, same bytes.

Examples:
  solidcast generate --count 100000 --seed 1 -o spheres.json
  solidcast generate --kind mixed --count 1000 | solidcast render - -o mixed.png)";

struct Generate {
  std::string kind = "sphere", output = "-";
  std::uint32_t count = 1000;
  std::uint64_t seed = 1;
};

void generate(const Generate& options) {
  OutputFile file(options.output, false);
  const std::string comment =
      std::to_string(options.count) + " random solids, kind " + options.kind + ", seed " +
      std::to_string(options.seed) +
      ", made by solidcast generate. One should see a ball of them (of planes: a bowl with facets).";
  writeScene(randomScene(options.kind, options.count, options.seed), comment,
             [&](std::string_view text) { file.append(text.data(), text.size()); });
  file.finish();
}

}  // namespace

void addGenerate(CLI::App& app) {
  auto options = std::make_shared<Generate>();
  CLI::App* verb = app.add_subcommand("generate", "write a scene of random solids");
  verb->footer(kGenerateFooter);
  verb->add_option("--kind", options->kind, "kind of the solids, or mixed")
      ->check(CLI::IsMember(randomKinds()))
      ->capture_default_str();
  verb->add_option("--count", options->count, "number of solids, up to 10 million")
      ->check(CLI::Range(0, 10'000'000))
      ->capture_default_str();
  verb->add_option("--seed", options->seed, "start of the random numbers")->capture_default_str();
  verb->add_option("-o,--output", options->output, "scene file to write; - is standard output")->capture_default_str();
  verb->callback([options] { generate(*options); });
}

}  // namespace solidcast::cli
