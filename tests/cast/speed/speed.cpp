// What a ray of a scene costs, by method, from a uniform buffer and baked: the table of docs/performance-notes.md.
// Not a part of ctest: times are for people. One dispatch of each after the other, round after round, so that a machine
// with other work slows all alike; CPU time of the process, because wall time counts the others' work too.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "host/cast/caster.h"
#include "host/error.h"
#include "host/scene/load.h"
#include "tests/cast/speed/cpu_time.h"

namespace solidcast {
namespace {

struct Contestant {
  const char* name;
  std::unique_ptr<ImageCaster> caster;
  std::vector<double> ms = {};
};

void run(const std::string& file, int width, int height, int rounds) {
  std::vector<std::string> warnings;
  const Scene scene = loadScene(file, warnings);
  RenderJob job;
  job.width = width, job.height = height;
  job.channels.rgb8 = true;
  gpu::Device device({});
  std::vector<Contestant> all;
  for (const Plan plan : {Plan::uniform, Plan::baked})
    for (const auto& [name, method] :
         {std::pair{"naive", Method::naive}, std::pair{"fast", Method::fast}, std::pair{"exact", Method::exact}})
      all.push_back({name, std::make_unique<ImageCaster>(
                               device, scene, job, CastOptions{.method = method, .plan = plan, .pictures = 1000})});
  for (int round = 0; round <= rounds; ++round)
    for (Contestant& one : all) {
      const double before = cpuMilliseconds();
      one.caster->dispatchOnly();
      if (round > 0) one.ms.push_back(cpuMilliseconds() - before);
    }
  std::printf("%s on %s, %d x %d, %d rounds\n", file.c_str(), device.info().name.c_str(), width, height, rounds);
  std::printf("%-6s %-8s %18s %18s %10s %12s\n", "", "records", "CPU ns/ray: best", "median", "x naive", "first ms");
  for (Contestant& one : all) {
    std::sort(one.ms.begin(), one.ms.end());
    const Contestant& naive = all[&one - all.data() < 3 ? 0 : 3];
    const double scale = 1e6 / (static_cast<double>(width) * height), median = one.ms[one.ms.size() / 2];
    std::printf("%-6s %-8s %18.2f %18.2f %10.2f %12.0f\n", one.name, &naive == all.data() ? "buffer" : "baked",
                one.ms[0] * scale, median * scale, median / naive.ms[naive.ms.size() / 2],
                one.caster->stats().first_dispatch_ms);
  }
}

}  // namespace
}  // namespace solidcast

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "Usage: cast_speed SCENE WIDTH HEIGHT ROUNDS\n");
    return 2;
  }
  try {
    solidcast::run(argv[1], std::atoi(argv[2]), std::atoi(argv[3]), std::max(1, std::atoi(argv[4])));
  } catch (const solidcast::Error& error) {
    std::fprintf(stderr, "cast_speed: %s\n", error.what());
    return static_cast<int>(error.code());
  }
}
