#include "host/study/errors.h"

#include <algorithm>
#include <cmath>

#include "host/cast/second_pass.h"

namespace solidcast::study {
namespace {

/// The smallest number that `share` of all are not above.
double quantile(std::vector<float>& values, double share) {
  const auto n = static_cast<double>(values.size());
  const auto at = static_cast<std::ptrdiff_t>(std::clamp(std::ceil(share * n) - 1, 0.0, n - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

}  // namespace

Verdict verdictOf(const oracle::WorldTruth& truth) {
  const bool hit = truth.index >= 0 && !oracle::beyondFloat(truth.truth.t);
  return {hit ? truth.index : -1, truth.truth.t, truth.marginUlps};
}

std::vector<Verdict> judge(const World& world, std::span<const QueryRay> rays) {
  std::vector<Verdict> all(rays.size());
  inParallel(rays.size(), [&](std::size_t i) { all[i] = verdictOf(oracle::cast(world, oracle::exactRay(rays[i]))); });
  return all;
}

std::vector<Verdict> judge(const Scene& scene) {
  const auto width = static_cast<std::size_t>(scene.width);
  std::vector<Verdict> all(width * static_cast<std::size_t>(scene.height));
  const oracle::PixelGrid grid(scene.camera, scene.width, scene.height);
  inParallel(all.size(), [&](std::size_t i) {
    const double x = static_cast<double>(i % width) + 0.5, y = static_cast<double>(i / width) + 0.5;
    all[i] = verdictOf(oracle::cast(scene.world, grid.ray(x, y)));
  });
  return all;
}

void ErrorSum::add(std::int32_t index, float t, const Verdict& truth) {
  ++errors_.rays;
  if (index >= 0 && !std::isfinite(t)) ++errors_.notFinite;
  if (index == truth.index) {
    if (index >= 0) ulps_.push_back(static_cast<float>(oracle::ulpError(t, truth.t)));
    return;
  }
  ++(index < 0 ? errors_.misses : truth.index < 0 ? errors_.falseHits : errors_.otherSolid);
  ++(truth.marginUlps <= kNearUlps ? errors_.wrongNear : errors_.wrongBeyond);
  errors_.worstMargin = std::max(errors_.worstMargin, truth.marginUlps);
}

Errors ErrorSum::result() const {
  Errors e = errors_;
  e.agreedHits = ulps_.size();
  if (ulps_.empty()) return e;
  std::vector<float> values = ulps_;
  e.p50 = quantile(values, 0.5);
  e.p99 = quantile(values, 0.99);
  e.p999 = quantile(values, 0.999);
  e.max = *std::max_element(values.begin(), values.end());
  return e;
}

}  // namespace solidcast::study
