// What a free ray costs by number of solids, kind and method, with an index and (few solids) without: the table of
// docs/performance-notes.md. Not a part of ctest: times are for people.
//
//     query_speed KIND MOST [METHOD...]
#include <algorithm>
#include <cstdio>
#include <random>

#include "host/cast/caster.h"
#include "host/cast/index.h"
#include "host/error.h"
#include "host/scene/random.h"
#include "tests/cast/speed/cpu_time.h"

namespace solidcast {
namespace {

/// From anywhere within the cloud's surroundings to anywhere in it: no two have anything in common.
std::vector<QueryRay> freeRays(std::size_t n) {
  std::mt19937 bits(1);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<QueryRay> rays(n);
  for (QueryRay& ray : rays)
    for (std::size_t k = 0; k < 3; ++k) {
      ray.origin[k] = 20 * uniform(bits);
      ray.direction[k] = 8 * uniform(bits) - ray.origin[k];
    }
  return rays;
}

void run(const std::string& kind, const std::vector<std::string>& methods, std::uint32_t most) {
  gpu::Device device({});
  const std::vector<QueryRay> rays = freeRays(65536);
  std::printf("%s, %zu free rays, %s: CPU time, best of 5 dispatches\n", kind.c_str(), rays.size(),
              device.info().name.c_str());
  std::printf("%9s %6s %14s %14s %10s %12s\n", "solids", "", "index ns/ray", "without", "build ms", "flatten ms");
  for (std::uint32_t n : {10u, 30u, 100u, 300u, 1000u, 10000u, 100000u, 1000000u}) {
    if (n > most) break;
    const Scene scene = randomScene(kind, n, 1);
    const double start = cpuMilliseconds();
    const Index index = buildIndex(scene.world);
    const double build_ms = cpuMilliseconds() - start;
    for (const std::string& name : methods) {
      const Method method = name == "naive" ? Method::naive : name == "fast" ? Method::fast : Method::exact;
      double best[2] = {1e30, 1e30}, flatten = 0;
      std::vector<std::unique_ptr<QueryCaster>> casters;
      for (const Plan plan : {Plan::index, n <= 1000 ? Plan::automatic : Plan::index}) {
        CastOptions options{.method = method, .plan = plan};
        if (plan == Plan::automatic) options.plan = n <= 300 ? Plan::uniform : Plan::storage;
        casters.push_back(std::make_unique<QueryCaster>(device, scene.world, options));
        flatten = casters.front()->stats().flatten_ms;
        if (n > 1000) break;
      }
      for (int round = 0; round < 6; ++round)
        for (std::size_t c = 0; c < casters.size(); ++c) {
          const double before = cpuMilliseconds();
          casters[c]->dispatchOnly(round == 0 ? rays : std::span<const QueryRay>());
          if (round > 0) best[c] = std::min(best[c], cpuMilliseconds() - before);
        }
      std::printf("%9u %-6s %14.0f %14.0f %10.2f %12.2f\n", n, name.c_str(), best[0] * 1e6 / rays.size(),
                  casters.size() > 1 ? best[1] * 1e6 / rays.size() : 0, build_ms, flatten);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace solidcast

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: query_speed KIND MOST [METHOD...]\n");
    return 2;
  }
  std::vector<std::string> methods(argv + 3, argv + argc);
  if (methods.empty()) methods = {"naive", "fast", "exact"};
  try {
    solidcast::run(argv[1], methods, static_cast<std::uint32_t>(std::atoi(argv[2])));
  } catch (const solidcast::Error& error) {
    std::fprintf(stderr, "query_speed: %s\n", error.what());
    return static_cast<int>(error.code());
  }
}
