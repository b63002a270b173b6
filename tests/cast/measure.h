// The GPU side's answers counted against the oracle's: what the tests hold to the bars, and the sweep prints.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "host/cast/caster.h"
#include "host/oracle/families.h"
#include "host/oracle/oracle.h"

namespace solidcast {

/// Errors in the units of oracle.h: ulps of t, 2^-23 for normals, ulps of the largest component for local coordinates
/// and positions.
struct Tally {
  std::uint64_t rays = 0, hits = 0;
  std::uint64_t wrong = 0;   // hit or miss, or the solid
  std::uint64_t misses = 0;  // of these, the ones where a solid was missed
  double t = 0, normal = 0, local = 0, position = 0;
  std::uint64_t doubtful = 0;           // CastStats::fallbackRays
  double seconds = 0;                   // of the caster alone
  std::vector<std::string> complaints;  // the first few results beyond the bars, as one solid and one ray
  /// Issue 3's bars for `exact`.
  bool exact() const { return wrong == 0 && t <= 1 && normal <= 1 && local <= 2 && position <= 2; }
  void add(const Tally& other);
};

/// One answer: of a free ray, or a pixel. `where` is asked for where the answer is beyond the bars.
struct Answer {
  std::int32_t index = -1;
  float t = 0;
  std::array<float, 3> normal{}, local{}, position{};
};
void compare(const Answer& answer, const oracle::WorldTruth& truth, Tally& tally,
             const std::function<std::string()>& where);

/// Rays at one world.
void castAndCompare(gpu::Device& device, const World& world, const std::vector<QueryRay>& rays,
                    const CastOptions& options, Tally& tally);

struct FamilyPlan {
  std::size_t rays = 10000, raysPerShape = 100;
  std::size_t shapesPerWorld = 1;  // more: the nearest of several
  std::uint64_t seed = 1;
};
Tally measureFamily(gpu::Device& device, oracle::Kind kind, const std::string& family, const FamilyPlan& plan,
                    const CastOptions& options);

/// All channels of a picture of one solid or many, from the ideal rays.
Tally measureImage(gpu::Device& device, const Scene& scene, const CastOptions& options);

World worldOf(const std::vector<Shape>& shapes);
/// Hex numbers, so that a complaint can be made a test.
std::string text(const World& world);
std::string text(const QueryRay& ray);
std::string text(const Tally& tally);

/// The whole picture as one band.
Band renderWhole(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options,
                 CastStats* stats = nullptr);
RenderJob jobOf(const Scene& scene, const Channels& channels);

}  // namespace solidcast
