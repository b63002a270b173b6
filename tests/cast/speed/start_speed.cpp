// What a user waits for one picture, from starting the program to its PNG file, beside an empty program that only makes
// and destroys the Vulkan device (this one, with the argument "empty") plus the first dispatch as --stats has it: warm,
// and cold, with an empty cache of the driver's for every run. A table; not a part of ctest: times are for people.
//
//     start_speed SOLIDCAST SCENE WxH [ROUNDS]
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "host/error.h"
#include "host/gpu/device.h"

extern char** environ;

namespace solidcast {
namespace {

namespace fs = std::filesystem;

/// Wall ms of a program; its standard output goes to `output`.
double timed(const std::vector<std::string>& words, const fs::path& output) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  const auto start = std::chrono::steady_clock::now();
  pid_t child = 0;
  int status = 0;
  const bool ran = posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environ) == 0 &&
                   waitpid(child, &status, 0) == child && status == 0;
  posix_spawn_file_actions_destroy(&actions);
  if (!ran) throw Error(Exit::usage, words[0] + " failed, expected it to end with 0");
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

double firstDispatch(const fs::path& stats) {
  std::FILE* file = std::fopen(stats.c_str(), "r");
  if (!file) throw Error(Exit::usage, stats.string() + " cannot be read");
  char line[4096];
  double ms = 0;
  while (std::fgets(line, sizeof line, file))
    if (std::sscanf(line, " \"first_dispatch_ms\": %lf", &ms) == 1) break;
  std::fclose(file);
  return ms;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void race(const std::string& self, const std::string& program, const std::string& scene, const std::string& size,
          int rounds) {
  std::string name = fs::temp_directory_path() / "solidcast-start-XXXXXX";
  if (!mkdtemp(name.data())) throw Error(Exit::output, name + ": a temporary folder cannot be made");
  const fs::path folder = name;
  std::printf("%-5s %-6s %12s %15s %14s %22s\n", "cache", "method", "whole ms", "empty device ms", "first dispatch",
              "whole / (empty + first)");
  for (const bool warm : {true, false})
    for (const char* method : {"fast", "exact"}) {
      std::vector<double> whole, empty, first;
      for (int round = -1; round < rounds; ++round) {  // the first one fills the cache and is not counted
        const fs::path cache = folder / ("cache" + (warm ? std::string() : std::to_string(round)));
        setenv("MESA_SHADER_CACHE_DIR", cache.c_str(), 1);
        const double nothing = timed({self, "empty"}, "/dev/null");
        const double all = timed({program, "render", scene, "--method", method, "--size", size, "-o",
                                  folder / "image.png", "--stats", "--json"},
                                 folder / "stats.json");
        if (round < 0) continue;
        empty.push_back(nothing), whole.push_back(all), first.push_back(firstDispatch(folder / "stats.json"));
      }
      std::printf("%-5s %-6s %12.1f %15.1f %14.1f %22.2f\n", warm ? "warm" : "cold", method, median(whole),
                  median(empty), median(first), median(whole) / (median(empty) + median(first)));
    }
  fs::remove_all(folder);
}

}  // namespace
}  // namespace solidcast

int main(int argc, char** argv) {
  using namespace solidcast;
  try {
    if (argc == 2 && argv[1] == std::string("empty")) {
      gpu::Device device({});
      return 0;
    }
    if (argc < 4) throw Error(Exit::usage, "usage: start_speed SOLIDCAST SCENE WxH [ROUNDS]");
    race(fs::canonical("/proc/self/exe"), argv[1], argv[2], argv[3], argc > 4 ? std::max(1, std::atoi(argv[4])) : 21);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "start_speed: error: %s\n", error.what());
    return 2;
  }
}
