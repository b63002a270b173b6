// Sweeps: one difficulty at a time, from easy to hard, so that one sees where each method falls off.
#pragma once
#include <vector>

#include "host/study/study.h"

namespace solidcast::study {

std::vector<Sweep> sweepsOf(oracle::Kind kind);

/// Rays of difficulty `value`: batches of `raysPerShape`. The same on every machine.
std::vector<oracle::Batch> makeSweep(const Sweep& sweep, double value, std::size_t rays, std::uint64_t seed,
                                     std::size_t raysPerShape);

}  // namespace solidcast::study
