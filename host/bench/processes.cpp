#include "host/bench/processes.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "host/error.h"
#include "host/scene/write.h"

extern char** environ;

namespace solidcast::bench {
namespace {

namespace fs = std::filesystem;

/// A folder that is gone when the object is.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = fs::temp_directory_path() / "solidcast-bench-XXXXXX";
    if (mkdtemp(name.data()) == nullptr)
      throw Error(Exit::output, name + ": a temporary folder cannot be made, expected TMPDIR to name a writable one");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  std::string file(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// Runs a program without a terminal; true if it ended with 0.
bool runs(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {0, 1, 2}) posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  return failed == 0 && waitpid(child, &status, 0) == child && status == 0;
}

class ProcessPeer final : public Peer {
 public:
  ProcessPeer(std::string name, std::string plan, std::unique_ptr<TemporaryFolder> folder,
              std::vector<std::string> words)
      : name_(std::move(name)), plan_(std::move(plan)), folder_(std::move(folder)), words_(std::move(words)) {}
  std::string name() const override { return name_; }
  std::string plan() const override { return plan_; }
  bool wholeProcess() const override { return true; }
  Lap run() override {
    Stopwatch watch;
    if (!runs(words_)) throw Error(Exit::output, "--against povray: \"" + words_[0] + "\" failed on the scene");
    return {{}, watch.lap()};
  }
  Image image() const override { return readImage(folder_->file("image.png")); }

 private:
  std::string name_, plan_;
  std::unique_ptr<TemporaryFolder> folder_;
  std::vector<std::string> words_;
};

}  // namespace

std::unique_ptr<Peer> renderProcess(const Scene& scene, int width, int height, const std::string& method) {
  auto folder = std::make_unique<TemporaryFolder>();
  std::ofstream file(folder->file("scene.json"));
  writeScene(scene, "", [&](std::string_view text) { file << text; });
  file.close();
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  std::vector<std::string> words = {fs::read_symlink("/proc/self/exe"),
                                    "render",
                                    folder->file("scene.json"),
                                    "-o",
                                    folder->file("image.png"),
                                    "--size",
                                    size,
                                    "--method",
                                    method};
  return std::make_unique<ProcessPeer>("render " + method, "this program as a process, to a PNG file",
                                       std::move(folder), std::move(words));
}

std::unique_ptr<Peer> povrayProcess(const Scene& scene, int width, int height) {
  if (!runs({"povray", "--version"}))
    throw Error(Exit::usage, "--against povray: povray cannot be started, expected Debian's package povray");
  auto folder = std::make_unique<TemporaryFolder>();
  std::ofstream(folder->file("scene.pov")) << povrayScene(scene);
  const bool grey = std::holds_alternative<RayCastingIntegrator>(scene.integrator);
  std::vector<std::string> words = {"povray",
                                    "+I" + folder->file("scene.pov"),
                                    "+O" + folder->file("image.png"),
                                    "+FN8",
                                    "File_Gamma=1.0",
                                    "-D",
                                    "-A",
                                    "-GA",
                                    grey ? "+Q3" : "+Q1",
                                    "+W" + std::to_string(width),
                                    "+H" + std::to_string(height),
                                    "+WT" + std::to_string(std::max(1u, std::thread::hardware_concurrency()))};
  return std::make_unique<ProcessPeer>("povray",
                                       std::string("POV-Ray as a process, to a PNG file, -A ") + (grey ? "+Q3" : "+Q1"),
                                       std::move(folder), std::move(words));
}

}  // namespace solidcast::bench
