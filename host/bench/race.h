// One scene, several contestants, round after round: each does its turn in every round, so that a machine with other
// work slows all alike, and all cast the same rays.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/bench/peer.h"
#include "host/cast/caster.h"

namespace solidcast::bench {

/// Times of all rounds, in ms.
class Times {
 public:
  void add(double ms);
  double min() const { return at(0); }
  double median() const;
  double max() const { return at(sorted_.size() - 1); }
  bool empty() const { return sorted_.empty(); }

 private:
  double at(std::size_t i) const { return sorted_.empty() ? 0 : sorted_[i]; }
  std::vector<double> sorted_;
};

struct Result {
  std::string method, plan;
  bool ours = false, wholeProcess = false;
  /// Casting and storing 8-bit colours: ours by the device's clock, a peer's trace by the wall's.
  Times dispatch;
  Times dispatchCpu;  // the same in processor time of all threads: what remains true on a busy machine
  /// From the solids to what rays are cast at: ours flattening and tiles, a peer's build.
  Times build;
  /// From arrays of solids to the finished image. Ours by a caster that gets the scene anew with its pipeline compiled
  /// (ImageCaster::setScene): flattening, dispatch, second pass, reading back.
  Times image;
  /// Ours: the same by a new caster, with everything that compilation costs (the driver's disk cache is warm).
  Times firstImage;
  std::vector<std::pair<const char*, double>> phases;  // ours, of the first image: medians in ms by name
  std::int64_t differing = 0;                          // pixels more than 1 level off what `exact` shows
};

struct Entry {
  std::string name;
  CastOptions options;
};

class Race {
 public:
  /// Ours by `entries`, each with its options; then the peers. The scene must outlive the race; its size is the image's.
  Race(gpu::Device& device, const Scene& scene, const std::vector<Entry>& entries,
       std::vector<std::unique_ptr<Peer>> peers);
  ~Race();
  /// A round that is not counted (it compiles, and its images are compared), then `rounds` that are.
  std::vector<Result> run(int rounds, const std::function<void(double fraction)>& progress = {});

 private:
  class Ours;
  gpu::Device& device_;
  const Scene& scene_;
  std::vector<std::unique_ptr<Ours>> ours_;
  std::vector<std::unique_ptr<Peer>> peers_;
};

}  // namespace solidcast::bench
