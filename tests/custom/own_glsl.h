// Scenes with GLSL of their own, in a folder of their own.
#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "host/error.h"
#include "tests/cast/fixture.h"

namespace solidcast {

class OwnGlsl : public OnDevice {
 protected:
  OwnGlsl() : folder_(std::filesystem::temp_directory_path() / ("solidcast own " + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~OwnGlsl() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const { std::ofstream(path(name)) << text; }

  /// A floor and a ball, 64x48, with more members at the top of the file and more solids.
  Scene scene(const std::string& members = "", const std::string& solids = "") const {
    std::vector<std::string> warnings;
    return parseScene(R"({"image": {"width": 64, "height": 48}, "camera": {"type": "perspective", "center": [0, 1, 6],
      "forward": [0, -0.1, -1], "up": [0, 1, 0], "vertical_angle": 40, "horizontal_angle": 52}, )" +
                          members + (members.empty() ? "" : ", ") + R"("solids": [
      {"type": "infinite_plane", "origin": [0, 0, 0], "normal": [0, 1, 0]},
      {"type": "sphere", "center": [0.5, 1, 0], "radius": 1})" +
                          (solids.empty() ? "" : ", ") + solids + "]}",
                      path("s.json"), warnings);
  }
  /// With the integrator in a file my.glsl that is written here.
  Scene integrated(const std::string& glsl, const std::string& parameters = "{}") const {
    write("my.glsl", glsl);
    return scene(R"("integrator": {"type": "custom", "glsl": "my.glsl", "parameters": )" + parameters + "}");
  }

  Band render(const Scene& what, const Channels& channels, const CastOptions& options = {}, int samples = 1) {
    RenderJob job = jobOf(what, channels);
    job.samples = samples;
    job.twoSided = what.twoSided;
    return renderWhole(device(), what, job, options, &stats_);
  }
  /// What rendering says when it fails; "nothing" when it does not.
  std::string complaint(const Scene& what, Exit code) {
    try {
      render(what, {.rgb8 = true});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      return error.what();
    }
    return "nothing";
  }

  CastStats stats_;

 private:
  std::filesystem::path folder_;
};

}  // namespace solidcast
