// `solidcast render`: a scene file to images, on a Vulkan device or by the CPU reference.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "host/cli/clock.h"
#include "host/cli/options.h"
#include "host/cli/pixel.h"
#include "host/cli/progress.h"
#include "host/cli/render_stats.h"
#include "host/cli/sequence.h"
#include "host/cli/verbs.h"
#include "host/error.h"
#include "host/image/writer.h"

namespace solidcast::cli {
namespace {

constexpr char kRenderFooter[] =
    R"(Images by the file's ending: .png (8 bit, truncated, no gamma), .pfm (float32, for comparing), .hdr (Radiance).
"-o -" writes a PNG to standard output. --aov writes further channels beside the image, out.pfm -> out.normal.pfm.
An image appears under its name only when it is whole.

Examples:
  solidcast render scenes/a_solids.json
  solidcast render scenes/a_solids.json -o a2-2.png --integrator castingdist
  solidcast render scene.json -o out.pfm --size 1920x1080 --samples 4 --aov normal,distance
  solidcast render scene.json -o part.png --crop 100,50,64,64 --backend cpu --precision f128
  solidcast render scene.json --frames 36 -o turn.png       (turn.01.png to turn.36.png)
  solidcast render scene.json --plan
  solidcast render scene.json --stats --json | jq .dispatch_ms
  solidcast render scene.json --pixel 320,240 --method fast)";

struct Render {
  std::string scene, output;
  std::vector<std::string> aov;
  PixelOption pixel;
  bool stats = false, json = false;
  Backend backend = Backend::gpu;
  ImageOptions image;
  CastingOptions casting;
  Sequence sequence;
};

struct Output {
  std::string path;
  ImageKind kind;
};

/// "scenes/a_solids.json" -> "a_solids.png" in the current folder.
std::string defaultOutput(const std::string& scene) {
  return scene == "-" ? "out.png" : std::filesystem::path(scene).stem().string() + ".png";
}

std::vector<Output> outputs(const Render& render) {
  const std::string path = render.output.empty() ? defaultOutput(render.scene) : render.output;
  std::vector<Output> list{{path, ImageKind::radiance}};
  for (const std::string& name : render.aov) {
    const ImageKind kind = imageKindByName(name);
    const bool known = std::any_of(list.begin(), list.end(), [kind](const Output& o) { return o.kind == kind; });
    if (!known) list.push_back({imagePathFor(path, kind), kind});
  }
  return list;
}

/// Casts jobs on the chosen backend; what is made for the first frame serves the others.
class Caster {
 public:
  Caster(const Render& render, const RenderJob& job, RenderStats& stats) : render_(render), job_(job), stats_(stats) {
    if (render.backend == Backend::gpu) device_ = openDevice(render.casting);
    else note(cpuName(render.casting.precision));
  }
  const gpu::Device* device() const { return device_.get(); }

  /// Fills in the statistics' casting part. `scene` must outlive the caster or the next call.
  void cast(const Scene& scene, const BandSink& sink, const CastProgress& progress) {
    if (!device_) {
      castOnCpu(scene, sink, progress);
      return;
    }
    if (gpu_) gpu_->setScene(scene);
    else gpu_.emplace(*device_, scene, job_, render_.casting.cast);
    gpu_->render(sink, progress);
    stats_.cast = gpu_->stats();
  }

 private:
  void castOnCpu(const Scene& scene, const BandSink& sink, const CastProgress& progress) {
    const double before = sinceProcessStart();
    double sinking = 0;
    std::mutex mutex;  // rows end on several threads
    const BandSink timed = [&](Band& band) {
      const double start = sinceProcessStart();
      sink(band);
      sinking += sinceProcessStart() - start;
    };
    reference::render(scene, job_, render_.casting.precision, timed, 0, [&](int done, int total) {
      const std::lock_guard lock(mutex);
      progress(static_cast<double>(done) / total);
    });
    stats_.cast.dispatch_ms += sinceProcessStart() - before - sinking;
    const std::uint64_t pixels = std::uint64_t(stats_.width) * std::uint64_t(stats_.height);
    stats_.cast.rays += pixels * std::uint64_t(job_.samples) * std::uint64_t(job_.samples);
  }

  const Render& render_;
  const RenderJob& job_;
  RenderStats& stats_;
  std::unique_ptr<gpu::Device> device_;
  std::optional<ImageCaster> gpu_;
};

std::vector<ImageWriter> openWriters(const std::vector<Output>& list, const Sequence& sequence, int frame,
                                     RenderStats& stats) {
  std::vector<ImageWriter> writers;
  for (const Output& output : list) {
    const std::string path = frameFile(output.path, sequence, frame);
    writers.emplace_back(path, stats.width, stats.height, output.kind);
    stats.outputs.push_back(path);
  }
  return writers;
}

void run(const CLI::App& verb, Render render) {
  if (render.pixel)
    return explain(verb,
                   {"--output", "--aov", "--stats", "--crop", "--samples", "--backend", "--frames", "--path", "--plan"},
                   render.scene, *render.pixel, render.image, render.casting, render.json);
  checkBackend(verb, render.backend);
  const std::vector<Output> list = outputs(render);
  if (render.json && list.front().path == "-")
    throw Error(Exit::usage,
                "--json: standard output cannot hold both the image and the JSON, expected -o FILE with it");

  RenderStats stats;
  const double beforeScene = sinceProcessStart();
  Scene first = loadWithWarnings(render.scene);
  apply(render.image, first);
  const std::vector<Camera> cameras = camerasOf(render.sequence, first, list.front().path);
  stats.scene_ms = sinceProcessStart() - beforeScene;

  Channels channels;
  for (const Output& output : list) addChannel(channels, imageFormat(output.path), output.kind);
  const RenderJob job = makeJob(render.image, first, channels);
  stats.width = job.crop.width > 0 ? job.crop.width : job.width;
  stats.height = job.crop.width > 0 ? job.crop.height : job.height;
  stats.frames = static_cast<int>(cameras.size());
  render.casting.cast.pictures = stats.frames;
  render.casting.cast.moving = stats.frames > 1;

  std::vector<ImageWriter> writers = openWriters(list, render.sequence, 0, stats);
  Caster caster(render, job, stats);
  std::optional<Progress> bar(std::in_place);
  Scene scene = std::move(first);
  const double beforeFrames = sinceProcessStart();
  for (int frame = 0; frame < stats.frames; ++frame) {
    if (frame > 0) writers = openWriters(list, render.sequence, frame, stats);
    scene.camera = cameras[static_cast<std::size_t>(frame)];
    const BandSink sink = [&](Band& band) {
      for (ImageWriter& writer : writers) writer.rows(band);
    };
    caster.cast(scene, sink, [&](double fraction) { bar->show((frame + fraction) / stats.frames); });
    for (ImageWriter& writer : writers) {
      writer.finish();
      stats.encode_ms += writer.encodeMilliseconds();
      stats.write_ms += writer.writeMilliseconds();
    }
  }
  stats.frames_ms = sinceProcessStart() - beforeFrames;
  bar.reset();
  if (stats.frames > 1) note(frameRate(stats.frames, stats.frames_ms));
  if (stats.cast.nanColours > 0)
    note("warning: " + std::to_string(stats.cast.nanColours) + " colours are not a number, shown in magenta");
  printPlan(render.casting, stats.cast);
  if (!render.stats && !render.json) return;
  const gpu::Device* device = caster.device();
  stats.scene = scene.file;
  stats.solids = scene.world.solids.size() + scene.world.customSolids.size();
  stats.deviceName = device ? device->info().name : cpuName(render.casting.precision);
  stats.driver = device ? device->info().driver + " " + device->info().driverInfo : "";
  stats.instance_ms = device ? device->instanceMilliseconds() : 0;
  stats.device_ms = device ? device->deviceMilliseconds() : 0;
  stats.deviceBytesPeak = device ? device->peakBytes() : 0;
  stats.whole_ms = sinceProcessStart();
  if (render.json) printJson(stats);
  else printTable(stats);
}

}  // namespace

void addRender(CLI::App& app) {
  auto render = std::make_shared<Render>();
  CLI::App* verb = app.add_subcommand("render", "render a scene to an image");
  verb->footer(kRenderFooter);
  verb->add_option("SCENE", render->scene, "scene file (JSON) or mesh (.ply, .obj); - is standard input")->required();
  verb->add_option("-o,--output", render->output,
                   "image file; - is standard output (default: the scene's name with .png, in the current folder)")
      ->type_name("FILE");
  verb->add_option("--aov", render->aov, "also write these channels: distance,normal,solid,local,position")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LIST");
  addBackend(*verb, render->backend);
  addImageOptions(*verb, render->image);
  addCastingOptions(*verb, render->casting);
  addPlan(*verb, render->casting);
  addSequence(*verb, render->sequence);
  addPixel(*verb, render->pixel);
  verb->add_flag("--stats", render->stats, "print phases, sizes, the plan and what was left out");
  verb->add_flag("--json", render->json,
                 "print the statistics, or of --pixel the explanation, as JSON on standard output");
  verb->callback([verb, render] { run(*verb, *render); });
}

}  // namespace solidcast::cli
