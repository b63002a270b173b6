// Many saves in a row under a running watch: numbers of the scene, included files, several files at once, broken ones
// in between, in every way in which editors save. Each good one's image is compared with a fresh render.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "host/gpu/device.h"
#include "tests/cli/program.h"
#include "tests/watch/child.h"

namespace solidcast::watch_test {

struct SaveReport {
  int good = 0, included = 0, broken = 0;      // `included` are among the good
  std::vector<double> scene_ms, shader_ms;     // from a good save to the written image: scene alone; shaders too
  long kilobytesEarly = 0, kilobytesLate = 0;  // of the watch: after a quarter of the saves, after all
  std::vector<std::string> failures;           // "save 17 (camera): ..."
};

class Saves {
 public:
  /// Starts `solidcast watch` on a copy of the course's scene of this size and of all shaders.
  Saves(gpu::Device& device, int width, int height);
  SaveReport run(int count);
  /// Ends the watch by Ctrl-C; its exit code.
  int end();

 private:
  struct Step {
    std::string what;
    std::map<std::string, std::string> files;  // name and content
    std::string fault{};                       // what the error line begins with; "": a good save
  };
  Step step(int i) const;
  std::string scene(int i) const;
  void save(const Step& step, int i) const;
  std::vector<std::uint8_t> freshImage() const;

  gpu::Device& device_;
  int width_, height_;
  cli_test::Folder folder_;
  std::unique_ptr<Child> watch_;
};

}  // namespace solidcast::watch_test
