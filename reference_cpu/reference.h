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

/// Called after each finished row; `done` of `total` rows.
using Progress = std::function<void(int done, int total)>;

/// Renders `job` with pixels in the job's precision (the world's fp64 numbers are rounded to it once).
/// Rows are shared out to `threads` threads (0: all cores). Bands come to `sink` from the top down.
void render(const Scene& scene, const RenderJob& job, Precision precision, const BandSink& sink, int threads = 0,
            const Progress& progress = {});

/// Casts free rays at the world; `hits[i]` belongs to `rays[i]`.
void cast(const World& world, std::span<const QueryRay> rays, std::span<QueryHit> hits, Precision precision,
          int threads = 0);

}  // namespace solidcast::reference
