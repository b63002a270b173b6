#include "reference_cpu/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>

#include "host/error.h"
#include "reference_cpu/build.h"
#include "reference_cpu/renderer.h"
#include "reference_cpu/rows.h"

namespace solidcast::reference {
namespace {

constexpr std::size_t bandBytes = std::size_t{64} << 20;
constexpr std::size_t raysInBlock = 1024;

/// The job with its crop spelled out; throws where it lies outside the image.
RenderJob checkedJob(RenderJob job) {
  if (job.width < 1 || job.height < 1)
    throw Error(Exit::usage, "image size " + std::to_string(job.width) + "x" + std::to_string(job.height) +
                                 ": expected at least 1x1");
  if (job.samples < 1) throw Error(Exit::usage, "samples " + std::to_string(job.samples) + ": expected at least 1");
  Crop& crop = job.crop;
  if (crop.width == 0) crop = {0, 0, job.width, job.height};
  if (crop.x < 0 || crop.y < 0 || crop.width < 1 || crop.height < 1 || crop.width > job.width - crop.x ||
      crop.height > job.height - crop.y)
    throw Error(Exit::usage, "crop " + std::to_string(crop.x) + "," + std::to_string(crop.y) + "," +
                                 std::to_string(crop.width) + "," + std::to_string(crop.height) +
                                 ": expected a part of the image of " + std::to_string(job.width) + "x" +
                                 std::to_string(job.height));
  return job;
}

std::size_t bytesAPixel(const Channels& c) {
  return 3 * c.rgb8 + 12 * c.radiance + 4 * c.distance + 4 * c.solid + 12 * c.normal + 12 * c.local + 12 * c.position;
}

Band emptyBand(const RenderJob& job, int firstRow, int rows) {
  Band band;
  band.firstRow = firstRow;
  band.rows = rows;
  band.width = job.crop.width;
  const std::size_t pixels = static_cast<std::size_t>(rows) * band.width;
  const Channels& wanted = job.channels;
  if (wanted.rgb8) band.rgb8.resize(3 * pixels);
  if (wanted.radiance) band.radiance.resize(3 * pixels);
  if (wanted.distance) band.distance.resize(pixels);
  if (wanted.solid) band.solid.resize(pixels);
  if (wanted.normal) band.normal.resize(3 * pixels);
  if (wanted.local) band.local.resize(3 * pixels);
  if (wanted.position) band.position.resize(3 * pixels);
  return band;
}

template <class T>
void renderIn(const Scene& scene, const RenderJob& job, const BandSink& sink, int threads, const Progress& progress) {
  const World<T> world = Build<T>::world(scene.world);
  const auto camera = Build<T>::camera(scene.camera);
  const auto integrator = Build<T>::integrator(scene.integrator, &world, job.twoSided || scene.twoSided);
  const Renderer<T> renderer(camera.get(), integrator.get());

  const std::size_t rowBytes = std::max<std::size_t>(1, bytesAPixel(job.channels) * job.crop.width);
  const int rowsInBand = static_cast<int>(std::clamp<std::size_t>(bandBytes / rowBytes, 1, job.crop.height));
  int done = 0;
  std::mutex progressGuard;
  for (int firstRow = 0; firstRow < job.crop.height; firstRow += rowsInBand) {
    Band band = emptyBand(job, firstRow, std::min(rowsInBand, job.crop.height - firstRow));
    forEachRow(band.rows, threads, [&](int row) {
      renderer.render(band, row, job);
      if (!progress) return;
      const std::lock_guard lock(progressGuard);
      progress(++done, job.crop.height);
    });
    sink(band);
  }
}

template <class T>
QueryHit castOne(const Integrator<T>& integrator, const QueryRay& given) {
  const Ray<T> ray{{T(given.origin[0]), T(given.origin[1]), T(given.origin[2])},
                   {T(given.direction[0]), T(given.direction[1]), T(given.direction[2])}};
  const Intersection<T> found = integrator.getIntersection(ray, T(given.tMax));
  QueryHit hit;
  const float t = found ? static_cast<float>(found.distance()) : std::numeric_limits<float>::infinity();
  if (std::isinf(t)) return hit;  // none, or beyond the far limit
  hit.index = found.solid()->index;
  hit.t = t;
  const Vec<T> position = found.hitPoint();
  for (int k = 0; k < 3; ++k) {
    hit.normal[k] = static_cast<float>(found.normal()[k]);
    hit.local[k] = static_cast<float>(found.local()[k]);
    hit.position[k] = static_cast<float>(position[k]);
  }
  return hit;
}

template <class T>
void castIn(const solidcast::World& plain, std::span<const QueryRay> rays, std::span<QueryHit> hits, int threads) {
  const World<T> world = Build<T>::world(plain);
  const RayCastingIntegrator<T> integrator(&world);
  const std::size_t blocks = (rays.size() + raysInBlock - 1) / raysInBlock;
  forEachRow(static_cast<int>(blocks), threads, [&](int block) {
    const std::size_t begin = block * raysInBlock, end = std::min(begin + raysInBlock, rays.size());
    for (std::size_t i = begin; i < end; ++i) hits[i] = castOne(integrator, rays[i]);
  });
}

}  // namespace

void render(const Scene& scene, const RenderJob& job, Precision precision, const BandSink& sink, int threads,
            const Progress& progress) {
  const RenderJob checked = checkedJob(job);
  switch (precision) {
    case Precision::f32:
      return renderIn<float>(scene, checked, sink, threads, progress);
    case Precision::f64:
      return renderIn<double>(scene, checked, sink, threads, progress);
    case Precision::f128:
      return renderIn<__float128>(scene, checked, sink, threads, progress);
  }
}

void cast(const solidcast::World& world, std::span<const QueryRay> rays, std::span<QueryHit> hits, Precision precision,
          int threads) {
  if (rays.size() != hits.size()) throw std::invalid_argument("cast: as many hits as rays are expected");
  switch (precision) {
    case Precision::f32:
      return castIn<float>(world, rays, hits, threads);
    case Precision::f64:
      return castIn<double>(world, rays, hits, threads);
    case Precision::f128:
      return castIn<__float128>(world, rays, hits, threads);
  }
}

}  // namespace solidcast::reference
