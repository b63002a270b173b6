#include "host/cli/sequence.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "host/cli/options.h"
#include "host/error.h"
#include "host/scene/camera_path.h"

namespace solidcast::cli {

namespace {
constexpr int kMostFrames = 100000;
}

void addSequence(CLI::App& verb, Sequence& sequence) {
  verb.add_option_function<std::string>(
          "--frames",
          [&sequence](const std::string& text) {
            char* end = nullptr;
            const long n = std::strtol(text.c_str(), &end, 10);
            if (text.empty() || *end != 0 || n < 1 || n > kMostFrames)
              throw Error(Exit::usage, "--frames: \"" + text + "\" is no number of pictures, expected 1 to " +
                                           std::to_string(kMostFrames));
            sequence.frames = static_cast<int>(n);
          },
          "this many pictures, numbered before the ending, from around the scene or along --path; says frames per "
          "second")
      ->type_name("N");
  verb.add_option("--path", sequence.path,
                  "JSON list of key cameras, as in scene files, that the frames go along from first to last")
      ->type_name("FILE");
}

std::vector<Camera> camerasOf(const Sequence& sequence, const Scene& scene, const std::string& output) {
  if (sequence.frames > 1 && output == "-")
    throw Error(Exit::usage, "--frames: standard output holds one image, expected -o FILE with it");
  std::vector<Camera> cameras;
  if (sequence.path.empty()) {
    const Triple pivot = pointLookedAt(scene);
    for (int i = 0; i < sequence.frames; ++i)
      cameras.push_back(i == 0 ? scene.camera : orbited(scene.camera, pivot, 360.0 * i / sequence.frames));
    return cameras;
  }
  std::vector<std::string> warnings;
  const CameraPath path = loadCameraPath(sequence.path, warnings);
  for (const std::string& warning : warnings) note("warning: " + warning);
  if (path.front().index() != scene.camera.index())
    throw Error(Exit::usage, sequence.path + ": /0/type: another kind of camera than the scene's, expected the same");
  for (int i = 0; i < sequence.frames; ++i)
    cameras.push_back(cameraAt(path, sequence.frames == 1 ? 0 : double(i) / (sequence.frames - 1)));
  return cameras;
}

std::string frameFile(const std::string& file, const Sequence& sequence, int frame) {
  if (sequence.frames == 1) return file;
  std::string number = std::to_string(frame + 1);
  const std::size_t digits = std::to_string(sequence.frames).size();
  number.insert(0, digits - number.size(), '0');
  std::filesystem::path path = file;
  const std::string ending = path.extension().string();
  return path.replace_extension("." + number + ending).string();
}

std::string frameRate(int frames, double ms) {
  char text[96];
  std::snprintf(text, sizeof text, "%d frames in %.0f ms: %.1f frames per second", frames, ms, frames * 1e3 / ms);
  return text;
}

}  // namespace solidcast::cli
