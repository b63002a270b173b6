// The second pass of `exact`: doubtful pixels again in binary128, and the surfaces' channels, which are its own.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "host/cast/pass.h"
#include "host/cast/pixel_candidates.h"

namespace solidcast {
namespace {

struct Light {
  float rgb[3] = {0, 0, 0};
};

/// The integrators of shaders/integrators once more, for single pixels.
Light integrate(const Scene& scene, bool twoSided, const RayQ& ray, const ExactHit& hit, V3 normal) {
  if (!hit) return {};
  float cosine = static_cast<float>(-dot(normal, ray.direction));
  cosine = twoSided ? std::abs(cosine) : std::max(cosine, 0.f);
  Light light{{cosine, cosine, cosine}};
  if (const auto* dist = std::get_if<RayCastingDistIntegrator>(&scene.integrator)) {
    auto nearDist = static_cast<float>(dist->nearDist), farDist = static_cast<float>(dist->farDist);
    float part = std::clamp((static_cast<float>(hit.t) - nearDist) / (farDist - nearDist), 0.f, 1.f);
    for (int c = 0; c < 3; ++c) {
      auto from = static_cast<float>(dist->nearColor[static_cast<std::size_t>(c)]);
      auto to = static_cast<float>(dist->farColor[static_cast<std::size_t>(c)]);
      light.rgb[c] = (from + part * (to - from)) * cosine;
    }
  }
  return light;
}

}  // namespace

RayQ Pass::rayOf(const PixelRays& rays, const Band& band, std::size_t pixel, std::size_t sample) const {
  std::int64_t x = crop_.x + static_cast<std::int64_t>(pixel) % band.width;
  std::int64_t y = crop_.y + band.firstRow + static_cast<std::int64_t>(pixel) / band.width;
  auto n = static_cast<std::size_t>(samples_);
  return rays.ray(x * samples_ + static_cast<std::int64_t>(sample % n),
                  y * samples_ + static_cast<std::int64_t>(sample / n));
}

void Pass::secondPass(Band& band) {
  std::size_t doubts = 0;
  for (const auto& list : doubtful_) doubts += list.size();
  stats_.fallbackRays += doubts;
  if (doubts == 0 && !surfaces_) return;
  if (!second_) second_.emplace(scene_->world);
  PixelRays rays(*scene_, job_.width, job_.height, samples_);
  // A pixel with a doubtful sample gets all of its samples anew, so that their sum is rounded in the same order whichever
  // of them was in doubt: that differs from plan to plan.
  std::vector<std::uint32_t> pixels;
  for (const auto& list : doubtful_) pixels.insert(pixels.end(), list.begin(), list.end());
  std::sort(pixels.begin(), pixels.end());
  pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
  // Few rays among many solids: an index would not repay.
  std::optional<PixelCandidates> among;
  if (scene_->world.solids.size() > 512 && pixels.size() <= 2048)
    among.emplace(*scene_, Silhouette(*scene_, job_.width, job_.height, samples_),
                  Crop{crop_.x, crop_.y + band.firstRow, band.width, band.rows}, pixels);
  inParallel(pixels.size(), [&](std::size_t i) {
    const std::size_t pixel = pixels[i];
    Light sum;
    ExactHit hit;
    for (std::size_t sample = 0; sample < doubtful_.size(); ++sample) {
      RayQ ray = rayOf(rays, band, pixel, sample);
      hit = among ? second_->castAmong(ray, among->of(i)) : second_->cast(ray);
      V3 normal = hit ? second_->surface(ray, hit).normal : V3{};
      Light light = integrate(*scene_, job_.twoSided, ray, hit, normal);
      for (int c = 0; c < 3; ++c) sum.rgb[c] += light.rgb[c];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      if (wanted_ & RGB8) band.rgb8[3 * pixel + c] = toLevel(sum.rgb[c]);
      if (wanted_ & RADIANCE) band.radiance[3 * pixel + c] = sum.rgb[c];
    }
    if (wanted_ & DISTANCE)
      band.distance[pixel] = hit ? static_cast<float>(hit.t) : std::numeric_limits<float>::infinity();
    if (wanted_ & SOLID) band.solid[pixel] = hit.index;
  });
  if (surfaces_) fillSurfaces(band, rays);
}

/// Before users' own GLSL comes to see the hits: those in doubt are put right where the search left them.
void Pass::settleDoubts(const Band& band, std::size_t sample) {
  if (!exact_ || doubtful_[sample].empty()) return;
  if (!second_) second_.emplace(scene_->world);
  const PixelRays rays(*scene_, job_.width, job_.height, samples_);
  const auto& list = doubtful_[sample];
  stats_.fallbackRays += list.size();
  auto planes = image_.as<std::uint32_t>();
  const std::size_t words = static_cast<std::size_t>(stride_) * static_cast<std::size_t>(padded(band.rows, groupRows));
  const auto width = static_cast<std::size_t>(band.width);
  inParallel(list.size(), [&](std::size_t i) {
    const std::size_t pixel = list[i], at = pixel / width * static_cast<std::size_t>(stride_) + pixel % width;
    const ExactHit hit = second_->cast(rayOf(rays, band, pixel, sample));
    planes[at] = bits(hit ? static_cast<float>(hit.t) : std::numeric_limits<float>::infinity());
    planes[words + at] = static_cast<std::uint32_t>(hit.index);
  });
}

void Pass::fillSurfaces(Band& band, const PixelRays& rays) {
  const Channels& c = job_.channels;
  std::size_t pixels = static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.rows);
  if (c.normal) band.normal.assign(3 * pixels, 0);
  if (c.local) band.local.assign(3 * pixels, 0);
  if (c.position) band.position.assign(3 * pixels, 0);
  inParallel(pixels, [&](std::size_t pixel) {
    if (band.solid[pixel] < 0) return;
    RayQ ray = rayOf(rays, band, pixel, 0);
    ExactHit hit = second_->castAt(ray, band.solid[pixel]);
    if (!hit) hit = {band.solid[pixel], band.distance[pixel]};
    Surface s = second_->surface(ray, hit);
    V3 p = ray.origin + hit.t * ray.direction;
    for (int k = 0; k < 3; ++k) {
      std::size_t at = 3 * pixel + static_cast<std::size_t>(k);
      if (c.normal) band.normal[at] = static_cast<float>(s.normal[k]);
      if (c.local) band.local[at] = static_cast<float>(s.local[k]);
      if (c.position) band.position[at] = static_cast<float>(p[k]);
    }
  });
}

}  // namespace solidcast
