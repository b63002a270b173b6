// ImageCaster: a picture in bands, each small enough for the memory budget; one or two passes a band.
#include <algorithm>

#include "host/cast/group_search.h"
#include "host/cast/list_search.h"
#include "host/cast/pass.h"
#include "host/error.h"

namespace solidcast {

std::unique_ptr<PixelSearch> makeSearch(const PassJob& job, const Scene& scene) {
  const double pixels = double(job.crop.width) * job.crop.height * job.samples * job.samples;
  const PlanFacts facts = planFacts(job.device.info(), scene.world, job.program, pixels, job.options);
  const PlanChoice choice = choosePlan(facts, job.options.plan);
  job.stats.planName = planName(choice.plan);
  for (std::string& line : planLines(facts, choice, job.options.plan)) job.stats.plan.push_back(std::move(line));
  if (choice.plan == Plan::lists) return std::make_unique<ListSearch>(job, scene);
  return std::make_unique<GroupSearch>(job, scene, choice);
}

struct ImageCaster::Impl {
  gpu::Device& device;
  const RenderJob& job;
  Crop crop;
  CastStats stats;
  std::vector<std::unique_ptr<Pass>> passes;
  int bandRows = 0;
  Band band;                                         // kept, so that its memory serves the next
  bool customSolids = false, customColours = false;  // what the passes were made for

  const CastOptions options;  // passes refer to it

  Impl(gpu::Device& d, const Scene& scene, const RenderJob& j, const CastOptions& o)
      : device(d), job(j), crop(j.crop), options(o) {
    if (crop.width == 0) crop = {0, 0, job.width, job.height};
    build(scene);
  }

  void build(const Scene& scene) {
    passes.clear();
    const Channels& c = job.channels;
    bool radiance = c.rgb8 || c.radiance;
    bool others = c.distance || c.solid || c.normal || c.local || c.position;
    if (!radiance && !others) throw Error(Exit::usage, "render: no channel was asked for");
    // With several samples the other channels, which are of the pixel's centre, need a pass of their own. So they do
    // beside a user's integrator, where the method has better surfaces than it is given.
    auto addPass = [&](bool ofRadiance, bool ofOthers) {
      passes.push_back(std::make_unique<Pass>(device, scene, job, crop, options, ofRadiance, ofOthers, stats));
    };
    const bool apart = job.samples > 1 || needsCustom(scene, true) != needsCustom(scene, false);
    if (!apart || !others || !radiance) {
      addPass(radiance, others);
    } else {
      addPass(true, false);
      addPass(false, true);
    }
    customSolids = needsCustom(scene, false);
    customColours = needsCustom(scene, true);
    bandRows = rowsInBudget(options.memoryBudget);
    for (auto& pass : passes) pass->makeBuffers(crop.width, bandRows);
    stats.leftOut = leftOutLines(passes.front()->program(), scene.world, job.channels);
    stats.deviceBytes = device.peakBytes();
  }

  void setScene(const Scene& scene) {
    const bool same = customSolids == needsCustom(scene, false) && customColours == needsCustom(scene, true);
    if (!same) build(scene);
    else
      for (auto& pass : passes) pass->setScene(scene);
  }

  int rowsInBudget(std::size_t budget) {
    std::size_t perRow = 0, largest = 0;
    for (const auto& pass : passes) {
      perRow += pass->bytesPerRow(crop.width);
      largest = std::max(largest, pass->bytesPerRow(crop.width));
    }
    const auto& limits = device.info().limits;
    // The host holds a copy of a band, so half of the budget is the device's; and no band above 64 MiB: nothing is
    // gained by it.
    std::size_t room = std::min<std::size_t>(budget / 2, std::size_t{64} << 20);
    std::size_t groups = std::min({room / (perRow * groupRows), limits.maxStorageBufferRange / (largest * groupRows),
                                   std::size_t{limits.maxWorkGroupCount[1]}});
    std::size_t rows = std::min(groups * groupRows, static_cast<std::size_t>(crop.height));
    if (rows == 0)
      throw Error(Exit::usage, "render: " + std::to_string(groupRows) + " rows of " + std::to_string(crop.width) +
                                   " pixels take " + std::to_string(perRow * groupRows) + " bytes, expected at most " +
                                   std::to_string(std::min<std::size_t>(room, limits.maxStorageBufferRange)));
    if (static_cast<int>(rows) < crop.height)
      stats.plan.push_back("in bands of " + std::to_string(rows) + " rows: " + std::to_string(perRow) +
                           " bytes a row, at most " + std::to_string(room) + " a band");
    return static_cast<int>(rows);
  }

  void forEachBand(const std::function<void(Band&)>& f) {
    for (int first = 0; first < crop.height; first += bandRows) {
      band.firstRow = first;
      band.rows = std::min(bandRows, crop.height - first);
      band.width = crop.width;
      f(band);
    }
  }
};

ImageCaster::ImageCaster(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options)
    : impl_(std::make_unique<Impl>(device, scene, job, options)) {}
ImageCaster::~ImageCaster() = default;

void ImageCaster::render(const BandSink& sink, const CastProgress& progress) {
  impl_->forEachBand([&](Band& band) {
    for (auto& pass : impl_->passes) pass->run(band);
    impl_->stats.deviceBytes = impl_->device.peakBytes();
    int done = band.firstRow + band.rows;
    sink(band);
    if (progress) progress(double(done) / impl_->crop.height);
  });
}

double ImageCaster::dispatchOnly() {
  for (auto& pass : impl_->passes) pass->settle();
  double before = impl_->stats.dispatch_ms;
  impl_->forEachBand([&](Band& band) {
    for (auto& pass : impl_->passes) pass->dispatch(band);
  });
  return impl_->stats.dispatch_ms - before;
}

void ImageCaster::setScene(const Scene& scene) { impl_->setScene(scene); }

const CastStats& ImageCaster::stats() const { return impl_->stats; }

void renderGpu(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options,
               const BandSink& sink, CastStats& stats, const CastProgress& progress) {
  ImageCaster caster(device, scene, job, options);
  caster.render(sink, progress);
  stats = caster.stats();
}

}  // namespace solidcast
