// The exactness sweep: every family of rays or images at length, one line each. Not a part of ctest: as long as wanted.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "host/error.h"
#include "tests/cast/measure.h"

namespace solidcast {
namespace {

struct Request {
  std::string kind, family, device, arithmetic = "auto", method = "exact";
  FamilyPlan plan;
  int images = 0, width = 64, height = 48;
  bool cracks = false;
};

bool failed = false;

void line(const std::string& kind, const std::string& family, const Tally& tally, bool bars) {
  std::printf("%-15s %-13s %9llu %9llu %6llu %8.3g %8.3g %8.3g %8.3g %9llu %8.2f\n", kind.c_str(), family.c_str(),
              static_cast<unsigned long long>(tally.rays), static_cast<unsigned long long>(tally.hits),
              static_cast<unsigned long long>(tally.wrong), tally.t, tally.normal, tally.local, tally.position,
              static_cast<unsigned long long>(tally.doubtful), tally.seconds);
  if (bars && !tally.exact()) {
    failed = true;
    for (const std::string& complaint : tally.complaints) std::printf("    %s\n", complaint.c_str());
  }
  std::fflush(stdout);
}

void run(const Request& request) {
  gpu::Device device({.select = request.device, .validation = gpu::Validation::automatic});
  CastOptions options;
  options.method = request.method == "naive" ? Method::naive : request.method == "fast" ? Method::fast : Method::exact;
  options.arithmetic = request.arithmetic == "fp64"   ? Arithmetic::fp64
                       : request.arithmetic == "df32" ? Arithmetic::df32
                                                      : Arithmetic::automatic;
  const bool exact = options.method == Method::exact;
  std::printf("%s, seed %llu\n%-15s %-13s %9s %9s %6s %8s %8s %8s %8s %9s %8s\n", device.info().name.c_str(),
              static_cast<unsigned long long>(request.plan.seed), "kind", "family", "rays", "hits", "wrong", "t ulp",
              "normal", "local", "position", "doubtful", "s");
  Tally all;
  if (request.cracks) {
    for (const bool vertices : {false, true}) {
      Tally tally;
      constexpr std::size_t perMesh = 20000;
      for (std::size_t done = 0; done < request.plan.rays; done += perMesh) {
        const auto batch = oracle::makeCracks(vertices, perMesh, request.plan.seed + done);
        castAndCompare(device, batch.world, batch.rays, options, tally);
      }
      line("mesh", vertices ? "vertices" : "edges", tally, exact);
      if (exact && tally.misses > 0) {
        failed = true;
        std::printf("    %llu misses\n", static_cast<unsigned long long>(tally.misses));
      }
    }
    return;
  }
  for (const oracle::Kind kind : oracle::kKinds) {
    const std::string name = oracle::nameOf(kind);
    if (!request.kind.empty() && request.kind != name) continue;
    for (const std::string& family : request.images > 0 ? oracle::imageFamiliesOf(kind) : oracle::familiesOf(kind)) {
      if (!request.family.empty() && request.family != family) continue;
      Tally tally;
      if (request.images > 0) {
        for (int i = 0; i < request.images; ++i)
          tally.add(measureImage(device,
                                 oracle::makeImage(kind, family, request.width, request.height,
                                                   request.plan.seed + static_cast<std::uint64_t>(i)),
                                 options));
      } else {
        tally = measureFamily(device, kind, family, request.plan, options);
      }
      line(name, family, tally, exact);
      all.add(tally);
    }
  }
  line("all", "", all, false);
}

}  // namespace
}  // namespace solidcast

int main(int argc, char** argv) {
  solidcast::Request request;
  CLI::App app("Counts the errors of a method against the oracle, family by family. Fails where exact is not exact.");
  app.add_option("--rays", request.plan.rays, "rays a family");
  app.add_option("--rays-per-shape", request.plan.raysPerShape, "rays at each random shape");
  app.add_option("--shapes-per-world", request.plan.shapesPerWorld, "shapes cast at together");
  app.add_option("--seed", request.plan.seed);
  app.add_option("--kind", request.kind, "only this kind of solid");
  app.add_option("--family", request.family, "only this family");
  app.add_option("--images", request.images, "pictures a family, instead of free rays");
  app.add_option("--width", request.width), app.add_option("--height", request.height);
  app.add_flag("--cracks", request.cracks, "meshes, aimed at edges and vertices, instead of single solids");
  app.add_option("--device", request.device);
  app.add_option("--arithmetic", request.arithmetic)->check(CLI::IsMember({"auto", "fp64", "df32"}));
  app.add_option("--method", request.method)->check(CLI::IsMember({"naive", "fast", "exact"}));
  CLI11_PARSE(app, argc, argv);
  try {
    solidcast::run(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sweep: %s\n", error.what());
    return 3;
  }
  return solidcast::failed ? 1 : 0;
}
