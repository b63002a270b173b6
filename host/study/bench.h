// The measuring itself: every way over the same rays, errors by the oracle, times by interleaved dispatches.
#pragma once
#include <array>
#include <memory>
#include <vector>

#include "host/study/errors.h"
#include "host/study/study.h"

namespace solidcast::study {

struct Measured {
  Errors errors;
  Timing timing;
};
/// By way; ways that the device lacks stay empty.
using PerWay = std::array<Measured, kWayCount>;

/// Answers of one way about a picture.
struct Pixels {
  std::vector<std::int32_t> solid;
  std::vector<float> distance;
};

class Bench {
 public:
  /// `ways`: which of kWays; `runs`: dispatches that a timing is the median of.
  Bench(gpu::Device& device, std::vector<std::size_t> ways, int runs);
  ~Bench();

  /// Free rays, each batch at its own solid. The time is that of one solid with its batch's rays repeated, 65,536 at
  /// once; `timed` = false leaves it out.
  PerWay rays(const std::vector<oracle::Batch>& batches, bool timed);

  /// The same at one world of any solids, not timed.
  PerWay rays(const World& world, const std::vector<QueryRay>& rays);

  /// One ray at a world of any solids.
  std::array<QueryHit, kWayCount> ray(const World& world, const QueryRay& ray);

  /// A picture, by pixel centres. `answers` (by way) gets what each way answered, if not null.
  PerWay picture(const Scene& scene, const std::vector<Verdict>& truth, std::array<Pixels, kWayCount>* answers);

  /// One pixel of it.
  std::array<Pixels, kWayCount> pixel(const Scene& scene, int x, int y);

  /// What it looks like.
  ScenePicture look(const Scene& scene);

 private:
  void castAt(const std::vector<QueryRay>& rays, std::array<ErrorSum, kWayCount>& sums);
  std::array<std::uint64_t, kWayCount> doubtful() const;
  void setWorld(const World& world);
  Timing timed(const std::vector<std::vector<double>>& ms, std::size_t way, std::uint64_t rays) const;

  gpu::Device& device_;
  std::vector<std::size_t> ways_;
  int runs_;
  World world_;
  std::array<std::unique_ptr<QueryCaster>, kWayCount> casters_;
};

CastOptions optionsOf(const Way& way);
World worldOf(const Shape& shape);

}  // namespace solidcast::study
