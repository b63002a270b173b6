// `solidcast watch`: a scene that is rendered again whenever it, its meshes or its shaders are saved.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include "host/cli/interrupt.h"
#include "host/cli/options.h"
#include "host/cli/verbs.h"
#include "host/error.h"
#include "host/image/writer.h"
#include "host/watch/compare.h"
#include "host/watch/files.h"
#include "host/watch/server.h"
#include "host/watch/session.h"

namespace solidcast::cli {
namespace {

constexpr char kWatchFooter[] =
    R"(Renders whenever the scene, a mesh that it names, or, with --shaders, a shader or a file that one includes is saved.
What cannot be read or compiled is said with file, line and source, and the last good image stays; the next save that
is right replaces it. Ctrl-C ends the watch with exit code 0.

Examples:
  solidcast watch scenes/a_solids.json
  solidcast watch scenes/a_solids.json -o live.png --size 320x240
  solidcast watch scenes/a_solids.json --shaders shaders
  solidcast watch scenes/a_solids.json --serve)";

struct Watch {
  std::string scene, output;
  std::optional<int> port;  // of the page
  ImageOptions image;
  CastingOptions casting;
};

/// " 34.2" and the like.
std::string milliseconds(double ms) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", ms);
  return text;
}

void reportProblems(const watch::Session& session) {
  std::string text;
  for (const watch::Problem& problem : session.problems()) text += asText(problem);
  std::fputs(text.c_str(), stderr);
}

void reportFrame(const watch::Session& session, const std::string& output) {
  for (const std::string& warning : session.warnings()) note("warning: " + warning);
  const auto frame = session.frame();
  const watch::Phases& p = frame->phases;
  const double whole = p.read_ms + p.prepare_ms + p.cast_ms + p.write_ms;
  note(output + " (" + std::to_string(frame->number) + "): " + milliseconds(whole) + " ms: read " +
       milliseconds(p.read_ms) + ", prepare " + milliseconds(p.prepare_ms) + ", cast " + milliseconds(p.cast_ms) +
       ", write " + milliseconds(p.write_ms) + "; pipelines made: " + std::to_string(p.pipelines));
}

/// What can never become right by an edit ends the watch before it begins.
void checkStart(const Watch& options) {
  if (options.scene == "-")
    throw Error(Exit::usage, "watch: standard input is no file that can be saved, expected a scene file");
  if (options.output == "-")
    throw Error(Exit::usage, "-o: standard output holds one image, expected a file that each image replaces");
  imageFormat(options.output);
  std::error_code ignored;
  if (!std::filesystem::exists(options.scene, ignored))
    throw Error(Exit::usage, options.scene + ": no such file, expected a scene file");
  const std::string& folder = options.casting.cast.shaderFolder;
  if (!folder.empty() && !std::filesystem::is_directory(folder, ignored))
    throw Error(Exit::usage, "--shaders: " + folder + " is no folder, expected one with pixels.comp");
}

void run(const CLI::App& verb, Watch& options) {
  if (verb.count("--precision") > 0 && !options.port)
    throw Error(Exit::usage, "--precision: chooses the number type of the CPU reference, expected --serve with it");
  if (options.output.empty()) options.output = std::filesystem::path(options.scene).stem().string() + ".png";
  checkStart(options);
  const std::unique_ptr<gpu::Device> device = openDevice(options.casting);
  const UntilInterrupt interrupt;
  watch::Session::Options wishes;
  wishes.scene = options.scene;
  wishes.output = options.output;
  wishes.view.integrator = options.image.integrator;
  wishes.view.method = options.casting.cast.method;
  wishes.cast = options.casting.cast;
  wishes.precision = options.casting.precision;
  wishes.prepare = [&options](Scene& scene, const std::string& integrator, const Channels& channels) {
    ImageOptions image = options.image;
    image.integrator = integrator;
    apply(image, scene);
    return makeJob(image, scene, channels);
  };
  watch::Session session(*device, wishes);
  watch::FileWatcher watcher;
  watch::Board board;
  std::optional<watch::BackgroundReference> reference;
  std::optional<watch::Server> server;
  if (options.port) {
    reference.emplace(board, options.casting.precision);
    server.emplace(board, *options.port);
    note("open " + server->url());
  }
  std::vector<std::filesystem::path> changed;
  const int wakers[] = {interrupt.readable(), board.readable()};
  for (bool first = true; interrupt.number() == 0; first = false) {
    if (first || !changed.empty()) {
      const auto start = std::filesystem::file_time_type::clock::now();
      const bool fresh = session.update(changed);
      watcher.watch(session.files(), start);
      if (fresh) reportFrame(session, options.output);
      if (session.state() != Exit::fine && watcher.quiet()) reportProblems(session);
    }
    board.serve(session);
    board.put(session);
    changed = watcher.wait(wakers);
  }
  note("watch ended");
}

}  // namespace

void addWatch(CLI::App& app) {
  auto options = std::make_shared<Watch>();
  CLI::App* verb = app.add_subcommand("watch", "render a scene again whenever it is edited");
  verb->footer(kWatchFooter);
  verb->add_option("SCENE", options->scene, "scene file (JSON) or mesh (.ply, .obj)")->required();
  verb->add_option("-o,--output", options->output,
                   "image file (default: the scene's name with .png, in the current folder)")
      ->type_name("FILE");
  verb->add_option_function<std::string>(
          "--serve",
          [options](const std::string& text) {
            int port = -1;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
            if (error != std::errc() || end != text.data() + text.size() || port < 0 || port > 65535)
              throw Error(Exit::usage, "--serve: \"" + text + "\" is no port, expected 0 (any free one) to 65535");
            options->port = port;
          },
          std::string(
              "show it in a browser on this machine: image, errors, camera, the CPU reference beside it, pixels "
              "explained; 0 is any free port (default ") +
              kUsualPort + ")")
      ->type_name("[PORT]");
  addImageOptions(*verb, options->image);
  addCastingOptions(*verb, options->casting);
  verb->callback([verb, options] { run(*verb, *options); });
}

}  // namespace solidcast::cli
