// What the rest of the project sees of the scalar CPU reference: two calls. Everything behind them is written
// on its own (course class model, textbook formulas) and shares only host/scene's plain description.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "host/image/band.h"
#include "host/scene/ray.h"
#include "host/scene/world.h"

namespace solidcast::reference {

enum class Precision { f32, f64, f128 };

/// Called after each finished row, from one thread at a time; `done` of `total` rows.
using Progress = std::function<void(int done, int total)>;

/// Renders `job` with pixels in the job's precision (the world's fp64 numbers are rounded to it once).
/// Rows are shared out to `threads` threads (0: all cores). Bands come to `sink` from the top down, each of at most
/// 64 MiB or one row. Radiance is two-sided when the scene or the job says so. Throws Error(Exit::usage) for an empty
/// image, a crop outside it, no samples, and groups that form no tree; what `sink` and `progress` throw passes through.
void render(const solidcast::Scene& scene, const RenderJob& job, Precision precision, const BandSink& sink,
            int threads = 0, const Progress& progress = {});

/// Casts free rays at the world; `hits[i]` belongs to `rays[i]`, and both have one length. t, normal, local coordinates
/// and position are rounded to fp32 at the end. A ray of zero direction hits nothing.
void cast(const solidcast::World& world, std::span<const QueryRay> rays, std::span<QueryHit> hits, Precision precision,
          int threads = 0);

}  // namespace solidcast::reference
