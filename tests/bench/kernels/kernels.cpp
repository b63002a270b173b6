// What the host does itself around the shaders, by Google Benchmark: flattening, lists of tiles, PNG. Not a part of
// ctest: times are for people.
//
//     ninja host_kernels && tests/bench/kernels/host_kernels
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>

#include "host/bench/scenes.h"
#include "host/cast/list_build.h"
#include "host/cast/records.h"
#include "host/cast/tiles.h"
#include "host/image/writer.h"

namespace solidcast {
namespace {

constexpr int kWidth = 640, kHeight = 480;

Scene spheres(std::int64_t count) {
  std::vector<std::string> warnings;
  return bench::sceneNamed("random:sphere:" + std::to_string(count), warnings);
}

void flatten(benchmark::State& state) {
  const Scene scene = spheres(state.range(0));
  const EyeFrame eye = eyeFrame(scene, RealType::f32);
  for (auto _ : state) benchmark::DoNotOptimize(eyeRecords(scene.world, eye, RealType::f32));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(flatten)->RangeMultiplier(10)->Range(10, 100000)->Unit(benchmark::kMillisecond);

void tiles(benchmark::State& state) {
  const Scene scene = spheres(state.range(0));
  const TileGrid grid{{0, 0, kWidth, kHeight}, 64, 16};
  for (auto _ : state) benchmark::DoNotOptimize(tileLists(scene, kWidth, kHeight, 1, grid));
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(tiles)->RangeMultiplier(10)->Range(1000, 100000)->Unit(benchmark::kMillisecond)->UseRealTime();

/// What ListSearch does anew for each picture: where all solids are seen, their records, and the lists of all tiles.
void lists(benchmark::State& state, const char* kind, RealType type) {
  std::vector<std::string> warnings;
  const Scene scene = bench::sceneNamed("random:" + std::string(kind) + ":" + std::to_string(state.range(0)), warnings);
  ListGrid grid;
  grid.region = {0, 0, kWidth, kHeight};
  grid.across = kWidth / ListGrid::tile, grid.down = kHeight / ListGrid::tile;
  ListBuilder builder;
  std::vector<std::byte> rows, lanes;
  for (auto _ : state) {
    const Silhouette silhouette(scene, kWidth, kHeight, 1);
    builder.collect(scene, eyeFrame(scene, type), type, true, silhouette, grid, [&] {
      const std::size_t laneCount = builder.listedTiles();
      rows.resize(std::max(rows.size(), builder.rows() * rowBytes(type)));
      lanes.resize(std::max(lanes.size(), laneCount * (1 + kindCount) * 16));
      return ListRoom{rows, lanes, laneCount, builder.kinds()};
    });
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
const bool listsRegistered = [] {
  for (const char* kind : {"sphere", "triangle"})
    for (const RealType type : {RealType::f32, RealType::f64}) {
      const std::string name = "lists/" + std::string(kind) + (type == RealType::f32 ? " fast" : " exact");
      benchmark::RegisterBenchmark(name.c_str(), lists, kind, type)
          ->Arg(100000)
          ->Arg(1000000)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    }
  return true;
}();

/// A picture with soft shades, as casting makes them, to a file.
void png(benchmark::State& state) {
  const int width = static_cast<int>(state.range(0)), height = width * 9 / 16;
  Band band;
  band.width = width, band.rows = height;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      band.rgb8.insert(band.rgb8.end(), 3, static_cast<std::uint8_t>(255LL * x * y / width / height));
  const auto file = std::filesystem::temp_directory_path() / ("solidcast-kernels-" + std::to_string(getpid()) + ".png");
  for (auto _ : state) {
    ImageWriter writer(file.string(), width, height);
    writer.rows(band);
    writer.finish();
  }
  std::filesystem::remove(file);
  state.SetBytesProcessed(state.iterations() * 3 * width * height);
}
BENCHMARK(png)->Arg(1920)->Arg(3840)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace solidcast
BENCHMARK_MAIN();
