// What it would cost to leave in what a scene and a job do not need: the same picture with one such thing at a time, all
// interleaved.
#pragma once
#include <functional>
#include <string>

#include "host/cast/caster.h"

namespace solidcast::bench {

/// A table in Markdown for `scene` in its own size. `options` without a plan of its own, or that plan everywhere but in
/// the rows about plans. `device` without the validation layer; a second one is opened with it where it is installed.
std::string leftOutText(gpu::Device& device, const std::string& deviceSelect, const Scene& scene,
                        const CastOptions& options, int rounds,
                        const std::function<void(double fraction)>& progress = {});

}  // namespace solidcast::bench
