// The program: one verb a file; whatever a verb throws becomes one line on standard error and an exit code here.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <iostream>
#include <new>
#include <numeric>

#include "host/cli/heap.h"
#include "host/cli/options.h"
#include "host/cli/verbs.h"
#include "host/error.h"
#include "host/image/output_file.h"

namespace solidcast::cli {
namespace {

constexpr char kMainFooter[] = R"(Examples:
  solidcast render scenes/a_solids.json -o a.png
  solidcast compare scenes/a_solids.json
  solidcast compare gpu.pfm cpu.pfm -o difference.png
  echo "0 0 10  0 0 -1" | solidcast query scenes/a_solids.json --rays -
  solidcast devices

Exit codes: 0 fine; 1 images differ beyond the budget; 2 wrong arguments, or a scene, ray or image file that cannot
be used; 3 no usable Vulkan device; 4 a shader does not compile or is not valid; 5 an output could not be written.)";

/// Levenshtein distance: how many letters to change, insert or delete.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

/// ", did you mean X" when a known word is near, else nothing.
std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  std::size_t best = std::min<std::size_t>(3, word.size() / 2 + 1);
  std::string hint;
  for (const std::string& candidate : known)
    if (const std::size_t distance = editDistance(word, candidate); distance < best) {
      best = distance;
      hint = ", did you mean " + candidate;
    }
  return hint;
}

std::vector<std::string> verbNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

/// The first word that is no option must be a verb; CLI11 would only say that one is required.
void checkVerb(const CLI::App& app, int argc, char** argv) {
  const std::vector<std::string> names = verbNames(app);
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  if (argc < 2) throw Error(Exit::usage, "no verb given, expected one of " + list + " (see solidcast --help)");
  const std::string word = argv[1];
  if (word.starts_with("-") || std::find(names.begin(), names.end(), word) != names.end()) return;
  throw Error(Exit::usage, "unknown verb \"" + word + "\"" + nearest(word, names) + ", expected one of " + list);
}

std::string describe(const CLI::ParseError& error, const CLI::App& app) {
  std::string line = error.what();
  const auto verbs = app.get_subcommands();
  const CLI::App& verb = verbs.empty() ? app : *verbs.back();
  // A mistyped option also leaves the right one missing: the word that nobody knows tells more.
  const std::vector<std::string> extras = app.remaining(true);
  if (!extras.empty()) {
    const std::string word = extras.front().substr(0, extras.front().find('='));
    std::vector<std::string> known;
    for (const CLI::Option* option : verb.get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    line = "\"" + word + "\" was not expected" + (word.starts_with("-") ? nearest(word, known) : "");
  }
  return line + " (see solidcast " + (verbs.empty() ? "" : verb.get_name() + " ") + "--help)";
}

int fail(Exit code, std::string line) {
  // A compiler's further errors keep lines of their own; everything else is one line.
  if (code != Exit::shader) std::replace(line.begin(), line.end(), '\n', ' ');
  note((code == Exit::differs ? "" : "error: ") + line);
  return static_cast<int>(code);
}

int run(int argc, char** argv) {
  CLI::App app("Ray caster for exact solids on Vulkan compute, checked against a scalar CPU reference.", "solidcast");
  app.set_version_flag("--version", "solidcast " SOLIDCAST_VERSION);
  app.set_help_flag("-h,--help", "print this help and exit");
  app.footer(kMainFooter);
  app.require_subcommand(1);
  app.get_formatter()->column_width(36);
  addRender(app);
  addCompare(app);
  addQuery(app);
  addDevices(app);
  addGenerate(app);
  addStudy(app);
  addBench(app);
  addWatch(app);
  addShader(app);
  try {
    checkVerb(app, argc, argv);
    std::vector<std::string> words = withLeftOutValues({argv + 1, argv + argc});
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app.parse(std::move(words));
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked);
  } catch (const CLI::ParseError& error) { return fail(Exit::usage, describe(error, app)); }
  std::cout.flush();
  if (!std::cout) return fail(Exit::output, "standard output: cannot be written");
  return static_cast<int>(Exit::fine);
}

/// Ctrl-C and the like end the program as ever, but leave no half-written file.
void tidyUpAndEnd(int number) {
  removeUnfinishedOutputs();
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace
}  // namespace solidcast::cli

int main(int argc, char** argv) {
  using namespace solidcast;
  cli::useLargePages();
  for (int number : {SIGINT, SIGTERM, SIGHUP}) std::signal(number, cli::tidyUpAndEnd);
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit is a failed write
  std::signal(SIGPIPE, SIG_IGN);  // a reader that goes away is a failed write, not a death in silence
  try {
    return cli::run(argc, argv);
  } catch (const Error& error) { return cli::fail(error.code(), error.what()); } catch (const std::bad_alloc&) {
    return cli::fail(Exit::usage, "out of memory: the scene or the image is too large for this machine");
  } catch (const std::exception& error) { return cli::fail(Exit::usage, error.what()); }
}
