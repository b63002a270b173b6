#include "host/watch/session.h"

#include <algorithm>
#include <utility>

#include "host/cast/stopwatch.h"
#include "host/error.h"
#include "host/gpu/shaders.h"
#include "host/image/writer.h"
#include "host/scene/load.h"

namespace solidcast::watch {
namespace {

/// An ImageCaster decides how to cast for so many solids; at twice or half as many another way may be better.
bool asMany(std::size_t a, std::size_t b) { return std::max(a, b) <= 2 * std::min(a, b); }

constexpr int kPictures = 1000;  // a session is long: what pays in the long run pays

}  // namespace

/// What a caster needs to stay alive, beside it.
struct Session::Cast {
  std::shared_ptr<const Scene> scene;
  RenderJob job;
  CastOptions options;
  std::size_t planned;  // solids
  ImageCaster caster;

  Cast(gpu::Device& device, std::shared_ptr<const Scene> s, const RenderJob& j, const CastOptions& o)
      : scene(std::move(s)),
        job(j),
        options(o),
        planned(scene->world.solids.size()),
        caster(device, *scene, job, options) {}

  bool serves(const Scene& other, const RenderJob& otherJob, Method method) const {
    return job == otherJob && options.method == method && scene->camera.index() == other.camera.index() &&
           asMany(planned, other.world.solids.size());
  }
};

Session::Session(gpu::Device& device, Options options) : device_(device), options_(std::move(options)) {}
Session::~Session() = default;

std::vector<std::filesystem::path> Session::files() const {
  std::set<std::string> all = sceneFiles_;
  all.insert(shaderFiles_.begin(), shaderFiles_.end());
  return {all.begin(), all.end()};
}

bool Session::update(const std::vector<std::filesystem::path>& changed) {
  phases_ = {};
  const bool first = changed.empty();
  const auto touches = [&changed](const std::set<std::string>& files) {
    return std::any_of(changed.begin(), changed.end(),
                       [&files](const std::filesystem::path& file) { return files.count(file.string()) > 0; });
  };
  newShaders_ = touches(shaderFiles_);
  const bool sceneTouched = first || touches(sceneFiles_);
  if (sceneTouched && !readScene() && !newShaders_) return false;
  return render(sceneTouched && sceneFault_.empty());
}

bool Session::show(const View& view) {
  phases_ = {};
  const View before = std::exchange(options_.view, view);
  try {
    if (RenderJob job; read_) prepared(job);
  } catch (const Error&) {
    options_.view = before;
    throw;
  }
  return render(true);
}

bool Session::readScene() {
  Stopwatch reading;
  std::vector<std::string> files;
  std::vector<std::string> warnings;
  try {
    auto scene = std::make_unique<Scene>(loadScene(options_.scene, warnings, &files));
    // A camera that was edited is what the user wants to see now.
    if (read_ && !(scene->camera == read_->camera)) options_.view.camera.reset();
    read_ = std::move(scene);
    warnings_ = std::move(warnings);
    sceneFault_.clear();
    sceneFiles_ = {files.begin(), files.end()};
  } catch (const Error& error) {
    sceneFault_ = error.what();
    sceneFiles_.insert(files.begin(), files.end());
  }
  phases_.read_ms = reading.ms();
  return sceneFault_.empty();
}

std::shared_ptr<const Scene> Session::prepared(RenderJob& job) const {
  Channels channels;
  channels.rgb8 = true;
  addChannel(channels, imageFormat(options_.output), ImageKind::radiance);
  auto scene = std::make_shared<Scene>(*read_);
  if (options_.view.camera) scene->camera = *options_.view.camera;
  job = options_.prepare(*scene, options_.view.integrator, channels);
  return scene;
}

bool Session::render(bool otherScene) {
  if (!read_) return false;
  RenderJob job;
  std::shared_ptr<const Scene> scene;
  try {
    scene = prepared(job);
    viewFault_.clear();
    if (!prepare(scene, job, otherScene)) return false;
    finish(scene, job);
    return true;
  } catch (const Error& error) {
    if (error.code() == Exit::noDevice || error.code() == Exit::output) throw;
    viewFault_ = error.what();
    if (scene) cast_.reset();  // it may be half way between two scenes
    return false;
  }
}

/// Gets a caster to where it can render this scene. False: what is new does not compile, and there is nothing else to show.
bool Session::prepare(const std::shared_ptr<const Scene>& scene, const RenderJob& job, bool otherScene) {
  Stopwatch preparing;
  CastOptions options = options_.cast;
  options.method = options_.view.method;
  options.moving = true;
  options.pictures = kPictures;
  const bool newShaders = std::exchange(newShaders_, false);
  const bool serves = cast_ && cast_->serves(*scene, job, options.method);
  const auto addFiles = [this](const std::vector<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files) shaderFiles_.insert(file.string());
  };
  try {
    if (newShaders || !serves) {
      cast_ = std::make_unique<Cast>(device_, scene, job, options);
      shaderFiles_.clear();
      shaderFault_.clear();
      phases_.pipelines = cast_->caster.stats().pipelines;
    } else {
      const int before = cast_->caster.stats().pipelines;
      cast_->caster.setScene(*scene);
      cast_->scene = scene;
      phases_.pipelines = cast_->caster.stats().pipelines - before;
    }
    addFiles(cast_->caster.stats().files);
  } catch (const gpu::CompileError& error) {
    shaderFault_ = error.what();
    addFiles(error.files());
    if (!newShaders || !serves) cast_.reset();
    if (!cast_ || !otherScene) return false;
    cast_->caster.setScene(*scene);  // the last good shaders show it
    cast_->scene = scene;
  }
  phases_.prepare_ms = preparing.ms();
  return true;
}

/// Renders, writes the file and keeps the frame. A file that cannot be written does not hold up the frame.
void Session::finish(const std::shared_ptr<const Scene>& scene, const RenderJob& job) {
  auto frame = std::make_shared<Frame>();
  frame->number = frame_ ? frame_->number + 1 : 1;
  frame->scene = scene;
  frame->job = job;
  frame->width = job.crop.width > 0 ? job.crop.width : job.width;
  frame->height = job.crop.width > 0 ? job.crop.height : job.height;
  frame->rgb8.reserve(std::size_t{3} * frame->width * frame->height);
  outputFault_.clear();
  std::optional<ImageWriter> writer;
  const auto writing = [&](const auto& step) {
    Stopwatch watch;
    try {
      if (outputFault_.empty()) step();
    } catch (const Error& error) {
      outputFault_ = error.what();
      writer.reset();
    }
    phases_.write_ms += watch.ms();
  };
  writing([&] { writer.emplace(options_.output, frame->width, frame->height); });
  const double before = cast_->caster.stats().dispatch_ms;
  Stopwatch casting;
  double sinking = 0;
  cast_->caster.render([&](Band& band) {
    Stopwatch watch;
    frame->rgb8.insert(frame->rgb8.end(), band.rgb8.begin(), band.rgb8.end());
    writing([&] { writer->rows(band); });
    sinking += watch.ms();
  });
  phases_.cast_ms = casting.ms() - sinking;
  phases_.dispatch_ms = cast_->caster.stats().dispatch_ms - before;
  writing([&] { writer->finish(); });
  if (!frame_ && !outputFault_.empty()) throw Error(Exit::output, outputFault_);
  frame->phases = phases_;
  frame_ = std::move(frame);
}

std::vector<Problem> Session::problems() const {
  std::vector<Problem> all;
  for (const std::string* fault : {&sceneFault_, &viewFault_, &shaderFault_, &outputFault_})
    for (Problem& problem : problemsOf(*fault)) all.push_back(std::move(problem));
  return all;
}

Exit Session::state() const {
  if (!sceneFault_.empty() || !viewFault_.empty()) return Exit::usage;
  return !shaderFault_.empty() ? Exit::shader : !outputFault_.empty() ? Exit::output : Exit::fine;
}

}  // namespace solidcast::watch
