// A scene that is rendered again whenever somebody edits it or its shaders, and that keeps its last good image meanwhile.
// Only what an edit touches is made anew: a camera or a number costs records, a shader one pipeline.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/cast/caster.h"
#include "host/error.h"
#include "host/watch/problem.h"
#include "reference_cpu/reference.h"

namespace solidcast::watch {

/// Times of one picture in ms, one after the other; `dispatch_ms` is the part of `cast_ms` that the device took.
struct Phases {
  double read_ms = 0;     // scene file, meshes
  double prepare_ms = 0;  // records; compiling and the pipeline, where they are needed
  double cast_ms = 0;     // dispatch, readback, second pass
  double write_ms = 0;    // encoding, writing, renaming
  double dispatch_ms = 0;
  int pipelines = 0;  // made for this picture
};

struct Frame {
  int number = 0;                      // from 1
  std::shared_ptr<const Scene> scene;  // as it was rendered
  RenderJob job;
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb8;  // 3 a pixel
  Phases phases;
};

/// What is looked at in another way than the scene's file says.
struct View {
  std::optional<Camera> camera;
  std::string integrator;  // as --integrator; "" = the scene's
  Method method = Method::exact;
  bool operator==(const View&) const = default;
};

class Session {
 public:
  struct Options {
    std::string scene, output;
    View view;
    CastOptions cast;                                            // the view's method goes before
    reference::Precision precision = reference::Precision::f64;  // of what it is compared with
    /// Changes the scene as the user wishes, with this integrator, and tells the job. May throw Error(Exit::usage).
    std::function<RenderJob(Scene& scene, const std::string& integrator, const Channels& channels)> prepare;
  };

  /// Nothing is read or rendered yet.
  Session(gpu::Device& device, Options options);
  ~Session();

  /// Everything that the last attempt read, or looked for.
  std::vector<std::filesystem::path> files() const;

  /// Renders what follows from these changes; with none, everything for the first time. True: there is a new frame.
  /// What is wrong with the files is in problems() then. A lost device still throws, and so does an output that cannot be
  /// written the very first time.
  bool update(const std::vector<std::filesystem::path>& changed);
  /// Renders from elsewhere. A view that cannot be shown throws Error(Exit::usage) and changes nothing.
  bool show(const View& view);

  const View& view() const { return options_.view; }
  const Options& options() const { return options_; }
  gpu::Device& device() { return device_; }
  /// None before the first good one.
  std::shared_ptr<const Frame> frame() const { return frame_; }
  /// Of the scene, then of the shaders, then of the output; each in the order of the messages.
  std::vector<Problem> problems() const;
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Exit::fine, or the code of the first problem.
  Exit state() const;

 private:
  struct Cast;
  bool readScene();
  bool render(bool otherScene);
  std::shared_ptr<const Scene> prepared(RenderJob& job) const;
  bool prepare(const std::shared_ptr<const Scene>& scene, const RenderJob& job, bool otherScene);
  void finish(const std::shared_ptr<const Scene>& scene, const RenderJob& job);

  gpu::Device& device_;
  Options options_;
  std::unique_ptr<Scene> read_;  // as in the file
  std::unique_ptr<Cast> cast_;
  std::shared_ptr<const Frame> frame_;
  Phases phases_;  // of the picture at work
  bool newShaders_ = false;
  std::set<std::string> sceneFiles_, shaderFiles_;
  std::string sceneFault_, viewFault_, shaderFault_, outputFault_;  // messages; "": none
  std::vector<std::string> warnings_;
};

}  // namespace solidcast::watch
