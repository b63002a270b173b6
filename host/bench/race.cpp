#include "host/bench/race.h"

#include <algorithm>
#include <optional>

#include "host/image/compare.h"

namespace solidcast::bench {
namespace {

RenderJob jobOf(const Scene& scene) {
  RenderJob job;
  job.width = scene.width, job.height = scene.height;
  job.twoSided = scene.twoSided;
  job.channels.rgb8 = true;
  return job;
}

Image exactImage(gpu::Device& device, const Scene& scene) {
  const RenderJob job = jobOf(scene);
  CastStats stats;
  std::vector<std::uint8_t> bytes;
  renderGpu(
      device, scene, job, {}, [&](Band& band) { bytes.insert(bytes.end(), band.rgb8.begin(), band.rgb8.end()); },
      stats);
  Image image;
  image.width = job.width, image.height = job.height;
  image.values = std::move(bytes);
  return image;
}

/// A caster that will make many pictures, for which everything is compiled that pays.
CastOptions lasting(CastOptions options) {
  options.pictures = 1000;
  return options;
}

std::int64_t differing(const Image& a, const Image& b) { return compareImages(a, b, {0, 1}).beyond; }

}  // namespace

void Times::add(double ms) { sorted_.insert(std::upper_bound(sorted_.begin(), sorted_.end(), ms), ms); }
double Times::median() const {
  const std::size_t n = sorted_.size();
  return n == 0 ? 0 : (sorted_[(n - 1) / 2] + sorted_[n / 2]) / 2;
}

/// One method of ours: a caster that is kept, and new ones.
class Race::Ours {
 public:
  Ours(gpu::Device& device, const Scene& scene, const Entry& entry)
      : device_(device),
        scene_(scene),
        job_(jobOf(scene)),
        entry_(entry),
        kept_(device, scene, job_, lasting(entry.options)) {
    CastOptions moving = lasting(entry.options);
    moving.moving = true;
    again_.emplace(device, scene, job_, moving);
  }

  void round(Result& result, bool counted) {
    Stopwatch watch;
    const double dispatch_ms = kept_.dispatchOnly();
    const Span dispatch = watch.lap();
    const double flattened_ms = again_->stats().flatten_ms;
    watch.lap();
    again_->setScene(scene_);
    again_->render([this](Band& band) { keep(band); });
    const Span image = watch.lap();
    ImageCaster caster(device_, scene_, job_, entry_.options);
    caster.render([this](Band& band) { keep(band); });
    const Span first = watch.lap();
    if (!counted) return;
    const CastStats& stats = caster.stats();
    result.dispatch.add(dispatch_ms);
    result.dispatchCpu.add(dispatch.cpu_ms);
    result.build.add(again_->stats().flatten_ms - flattened_ms);
    result.image.add(image.wall_ms);
    result.firstImage.add(first.wall_ms);
    const double phases[] = {stats.flatten_ms,  stats.shader_ms,   stats.first_dispatch_ms,
                             stats.dispatch_ms, stats.readback_ms, stats.fallback_ms};
    for (std::size_t i = 0; i < std::size(phases); ++i) phases_[i].add(phases[i]);
  }
  void finish(Result& result) const {
    result.method = entry_.name;
    result.plan = kept_.stats().planName;
    result.ours = true;
    const char* names[] = {"flatten_ms", "shader_ms", "first_dispatch_ms", "dispatch_ms", "readback_ms", "fallback_ms"};
    for (std::size_t i = 0; i < std::size(names); ++i) result.phases.emplace_back(names[i], phases_[i].median());
  }
  Image image() const {
    Image image;
    image.width = job_.width, image.height = job_.height;
    image.values = bytes_;
    return image;
  }

 private:
  /// A caller who keeps the image, and gives the caster the memory of his last one.
  void keep(Band& band) {
    if (band.rows == job_.height) return bytes_.swap(band.rgb8);
    bytes_.resize(static_cast<std::size_t>(job_.width) * job_.height * 3);
    std::copy(band.rgb8.begin(), band.rgb8.end(),
              bytes_.begin() + static_cast<std::ptrdiff_t>(band.firstRow) * band.width * 3);
  }

  gpu::Device& device_;
  const Scene& scene_;
  RenderJob job_;
  Entry entry_;
  ImageCaster kept_;
  std::optional<ImageCaster> again_;  // for pictures of one scene after the other: it compiles nothing for any of them
  Times phases_[6];
  std::vector<std::uint8_t> bytes_;
};

Race::Race(gpu::Device& device, const Scene& scene, const std::vector<Entry>& entries,
           std::vector<std::unique_ptr<Peer>> peers)
    : device_(device), scene_(scene), peers_(std::move(peers)) {
  for (const Entry& entry : entries) ours_.push_back(std::make_unique<Ours>(device, scene, entry));
}
Race::~Race() = default;

std::vector<Result> Race::run(int rounds, const std::function<void(double fraction)>& progress) {
  std::vector<Result> results(ours_.size() + peers_.size());
  const Image exact = exactImage(device_, scene_);
  std::vector<Image> images(results.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t i = 0; i < results.size(); ++i) {
      Result& result = results[i];
      if (i < ours_.size()) {
        ours_[i]->round(result, round > 0);
        if (round == 0) images[i] = ours_[i]->image();
      } else {
        Peer& peer = *peers_[i - ours_.size()];
        const Lap lap = peer.run();
        if (round == 0) images[i] = peer.image();
        if (round > 0) {
          result.dispatch.add(lap.trace.wall_ms);
          result.dispatchCpu.add(lap.trace.cpu_ms);
          result.build.add(lap.build.wall_ms);
          result.image.add((lap.build + lap.trace).wall_ms);
        }
      }
      if (progress) progress(static_cast<double>(round * results.size() + i + 1) / ((rounds + 1) * results.size()));
    }
  }
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].differing = differing(exact, images[i]);
    if (i < ours_.size()) {
      ours_[i]->finish(results[i]);
    } else {
      results[i].method = peers_[i - ours_.size()]->name();
      results[i].plan = peers_[i - ours_.size()]->plan();
      results[i].wholeProcess = peers_[i - ours_.size()]->wholeProcess();
    }
  }
  return results;
}

}  // namespace solidcast::bench
