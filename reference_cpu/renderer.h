// Pixels to rays, and what the integrator says about them to the channels of a band.
#pragma once
#include "host/image/band.h"
#include "reference_cpu/camera.h"
#include "reference_cpu/integrator.h"

namespace solidcast::reference {

template <class T>
class Renderer {
 public:
  Renderer(const Camera<T>* camera, const Integrator<T>* integrator) : camera_(camera), integrator_(integrator) {}

  /// Fills row `row` of `band`, whose vectors have their sizes. Different rows may be rendered at the same time.
  void render(Band& band, int row, const RenderJob& job) const {
    const Channels& wanted = job.channels;
    const bool seesRadiance = wanted.rgb8 || wanted.radiance;
    const bool seesHit = wanted.distance || wanted.solid || wanted.normal || wanted.local || wanted.position;
    const int j = job.crop.y + band.firstRow + row;
    for (int column = 0; column < band.width; ++column) {
      const int i = job.crop.x + column;
      const std::size_t pixel = static_cast<std::size_t>(row) * band.width + column;
      if (seesHit || job.samples == 1) {
        const Intersection<T> hit = integrator_->getIntersection(pixelRay(job, i, j, T(0.5), T(0.5)));
        if (seesHit) storeHit(band, pixel, hit, wanted);
        if (seesRadiance && job.samples == 1) storeRadiance(band, pixel, integrator_->getRadiance(hit), wanted);
      }
      if (seesRadiance && job.samples != 1) storeRadiance(band, pixel, mean(job, i, j), wanted);
    }
  }

 private:
  /// Through pixel (i, j), at the fractions (right, down) of its width and height.
  Ray<T> pixelRay(const RenderJob& job, int i, int j, const T& right, const T& down) const {
    const T x = 2 * (i + right) / job.width - 1;
    const T y = 1 - 2 * (j + down) / job.height;
    return camera_->getPrimaryRay(x, y);
  }

  /// Mean radiance over a regular grid of samples x samples cells in the pixel.
  Vec<T> mean(const RenderJob& job, int i, int j) const {
    const int n = job.samples;
    Vec<T> sum;
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column)
        sum = sum + integrator_->getRadiance(pixelRay(job, i, j, (column + T(0.5)) / n, (row + T(0.5)) / n));
    return sum / (T(n) * n);
  }

  static void storeTriple(std::vector<float>& channel, std::size_t pixel, const Vec<T>& value) {
    for (int k = 0; k < 3; ++k) channel[3 * pixel + k] = static_cast<float>(value[k]);
  }

  static void storeRadiance(Band& band, std::size_t pixel, const Vec<T>& radiance, const Channels& wanted) {
    if (wanted.radiance) storeTriple(band.radiance, pixel, radiance);
    if (!wanted.rgb8) return;
    for (int k = 0; k < 3; ++k) {
      const T clamped = lesser(T(1), greater(T(0), radiance[k]));
      band.rgb8[3 * pixel + k] = static_cast<std::uint8_t>(static_cast<int>(255 * clamped));
    }
  }

  static void storeHit(Band& band, std::size_t pixel, const Intersection<T>& hit, const Channels& wanted) {
    if (wanted.distance) band.distance[pixel] = static_cast<float>(hit.distance());
    if (wanted.solid) band.solid[pixel] = hit ? hit.solid()->index : -1;
    if (wanted.normal) storeTriple(band.normal, pixel, hit ? hit.normal() : Vec<T>{});
    if (wanted.local) storeTriple(band.local, pixel, hit ? hit.local() : Vec<T>{});
    if (wanted.position) storeTriple(band.position, pixel, hit ? hit.hitPoint() : Vec<T>{});
  }

  const Camera<T>* camera_;
  const Integrator<T>* integrator_;
};

}  // namespace solidcast::reference
