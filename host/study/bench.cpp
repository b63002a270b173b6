#include "host/study/bench.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "host/study/pictures.h"

namespace solidcast::study {
namespace {

constexpr std::size_t kTimedRays = 65536;  // one dispatch
constexpr std::size_t kHostRays = 8192;    // that the host's share of `exact` is measured on

/// `runs` rounds; each round runs every way once, and the next round starts with another way, so that what else the
/// machine does hits all of them alike. ms by way and run.
std::vector<std::vector<double>> interleaved(const std::vector<std::size_t>& ways, int runs,
                                             const std::function<double(std::size_t way)>& once) {
  std::vector<std::vector<double>> ms(kWayCount);
  for (int run = 0; run < runs; ++run)
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const std::size_t way = ways[(i + static_cast<std::size_t>(run)) % ways.size()];
      ms[way].push_back(once(way));
    }
  return ms;
}

double between(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, sorted.size() - 1);
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[high] - sorted[low]);
}

}  // namespace

CastOptions optionsOf(const Way& way) {
  CastOptions options;
  options.method = way.method;
  options.arithmetic = way.arithmetic;
  return options;
}

World worldOf(const Shape& shape) {
  World world;
  world.groups[0].members.push_back({false, 0});
  world.solids.push_back({"", shape, 0});
  return world;
}

Bench::Bench(gpu::Device& device, std::vector<std::size_t> ways, int runs)
    : device_(device), ways_(std::move(ways)), runs_(runs) {}
Bench::~Bench() = default;

void Bench::setWorld(const World& world) {
  world_ = world;
  for (const std::size_t way : ways_) {
    if (casters_[way]) casters_[way]->setWorld(world_);
    else casters_[way] = std::make_unique<QueryCaster>(device_, world_, optionsOf(kWays[way]));
  }
}

Timing Bench::timed(const std::vector<std::vector<double>>& ms, std::size_t way, std::uint64_t rays) const {
  std::vector<double> ns = ms[way];
  for (double& v : ns) v *= 1e6 / static_cast<double>(rays);
  std::sort(ns.begin(), ns.end());
  Timing t;
  t.runs = static_cast<int>(ns.size());
  t.raysPerRun = rays;
  if (ns.empty()) return t;
  t.median = between(ns, 0.5), t.quarter = between(ns, 0.25), t.threeQuarters = between(ns, 0.75), t.least = ns[0];
  return t;
}

std::array<std::uint64_t, kWayCount> Bench::doubtful() const {
  std::array<std::uint64_t, kWayCount> counts{};
  for (const std::size_t way : ways_)
    if (casters_[way]) counts[way] = casters_[way]->stats().fallbackRays;
  return counts;
}

/// At the present world.
void Bench::castAt(const std::vector<QueryRay>& rays, std::array<ErrorSum, kWayCount>& sums) {
  const std::vector<Verdict> truth = judge(world_, rays);
  std::vector<QueryHit> hits(rays.size());
  for (const std::size_t way : ways_) {
    casters_[way]->cast(rays, hits);
    for (std::size_t i = 0; i < hits.size(); ++i) sums[way].add(hits[i].index, hits[i].t, truth[i]);
  }
}

PerWay Bench::rays(const World& world, const std::vector<QueryRay>& rays) {
  std::array<ErrorSum, kWayCount> sums;
  const auto before = doubtful();
  setWorld(world);
  castAt(rays, sums);
  PerWay result;
  const auto after = doubtful();
  for (const std::size_t way : ways_) {
    result[way].errors = sums[way].result();
    result[way].timing.doubtful = after[way] - before[way];
  }
  return result;
}

PerWay Bench::rays(const std::vector<oracle::Batch>& batches, bool timed) {
  std::array<ErrorSum, kWayCount> sums;
  const auto before = doubtful();
  for (const oracle::Batch& batch : batches) {
    setWorld(study::worldOf(batch.shape));
    castAt(batch.rays, sums);
  }
  PerWay result;
  const auto after = doubtful();
  for (const std::size_t way : ways_) {
    result[way].errors = sums[way].result();
    result[way].timing.doubtful = after[way] - before[way];
  }
  if (!timed || batches.empty()) return result;

  const oracle::Batch& batch = batches[batches.size() / 2];
  std::vector<QueryRay> many(kTimedRays);
  for (std::size_t i = 0; i < many.size(); ++i) many[i] = batch.rays[i % batch.rays.size()];
  std::vector<QueryHit> hits(kHostRays);
  setWorld(study::worldOf(batch.shape));
  std::array<double, kWayCount> host{};
  for (const std::size_t way : ways_) {
    if (kWays[way].method == Method::exact) {
      const double before = casters_[way]->stats().fallback_ms;
      casters_[way]->cast(std::span(many).first(kHostRays), hits);
      host[way] = (casters_[way]->stats().fallback_ms - before) * 1e6 / static_cast<double>(kHostRays);
    }
    casters_[way]->dispatchOnly(many);  // not counted: it warms up
  }
  const auto ms = interleaved(ways_, runs_, [&](std::size_t way) { return casters_[way]->dispatchOnly(); });
  for (const std::size_t way : ways_) {
    Timing t = this->timed(ms, way, many.size());
    t.host = host[way], t.doubtful = result[way].timing.doubtful;
    result[way].timing = t;
  }
  return result;
}

std::array<QueryHit, kWayCount> Bench::ray(const World& world, const QueryRay& ray) {
  std::array<QueryHit, kWayCount> hits;
  setWorld(world);
  for (const std::size_t way : ways_) casters_[way]->cast({&ray, 1}, {&hits[way], 1});
  return hits;
}

PerWay Bench::picture(const Scene& scene, const std::vector<Verdict>& truth, std::array<Pixels, kWayCount>* answers) {
  RenderJob job;
  job.width = scene.width, job.height = scene.height;
  job.channels.distance = job.channels.solid = true;
  const auto pixels = static_cast<std::uint64_t>(scene.width) * static_cast<std::uint64_t>(scene.height);
  std::array<std::unique_ptr<ImageCaster>, kWayCount> casters;
  PerWay result;
  for (const std::size_t way : ways_) {
    casters[way] = std::make_unique<ImageCaster>(device_, scene, job, optionsOf(kWays[way]));
    ErrorSum sum;
    std::size_t done = 0;
    casters[way]->render([&](Band& band) {
      for (std::size_t i = 0; i < band.solid.size(); ++i, ++done) sum.add(band.solid[i], band.distance[i], truth[done]);
      if (answers == nullptr) return;
      Pixels& to = (*answers)[way];
      to.solid.insert(to.solid.end(), band.solid.begin(), band.solid.end());
      to.distance.insert(to.distance.end(), band.distance.begin(), band.distance.end());
    });
    result[way].errors = sum.result();
    const CastStats& stats = casters[way]->stats();
    result[way].timing.doubtful = stats.fallbackRays;
    if (kWays[way].method == Method::exact)
      result[way].timing.host = stats.fallback_ms * 1e6 / static_cast<double>(pixels);
  }
  const auto ms = interleaved(ways_, runs_, [&](std::size_t way) { return casters[way]->dispatchOnly(); });
  for (const std::size_t way : ways_) {
    Timing t = timed(ms, way, pixels);
    t.host = result[way].timing.host, t.doubtful = result[way].timing.doubtful;
    result[way].timing = t;
  }
  return result;
}

std::array<Pixels, kWayCount> Bench::pixel(const Scene& scene, int x, int y) {
  RenderJob job;
  job.width = scene.width, job.height = scene.height;
  job.crop = {x, y, 1, 1};
  job.channels.distance = job.channels.solid = true;
  std::array<Pixels, kWayCount> answers;
  for (const std::size_t way : ways_) {
    CastStats stats;
    renderGpu(
        device_, scene, job, optionsOf(kWays[way]),
        [&](Band& band) {
          answers[way] = {band.solid, band.distance};
        },
        stats);
  }
  return answers;
}

ScenePicture Bench::look(const Scene& scene) {
  RenderJob job;
  job.width = scene.width, job.height = scene.height;
  job.twoSided = scene.twoSided;
  job.channels.rgb8 = true;
  CastStats stats;
  std::vector<std::uint8_t> rgb;
  renderGpu(
      device_, scene, job, {}, [&](Band& band) { rgb.insert(rgb.end(), band.rgb8.begin(), band.rgb8.end()); }, stats);
  return {scene.file,  "the picture", kWayCount, pngOf(scene.width, scene.height, std::move(rgb)),
          scene.width, scene.height};
}

}  // namespace solidcast::study
