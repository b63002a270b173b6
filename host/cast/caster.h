// Scene -> plan -> records -> pipeline -> dispatches -> bands or hits. The GPU side's two calls.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/gpu/device.h"
#include "host/image/band.h"
#include "host/scene/ray.h"
#include "host/scene/world.h"

namespace solidcast {

enum class Method { naive, fast, exact };
enum class Arithmetic { automatic, fp64, df32 };  // of `exact`
/// How solids are searched; results do not change (plan.h has the costs).
/// automatic: what is expected to be cheapest; a small scene's records become constants of the pipeline once dispatches
/// have taken as long as that compilation, so that it never costs more than twice the best choice.
/// baked: the records are constants of the pipeline. uniform, storage: they are in a buffer of that kind.
/// tiles: in a storage buffer, a dispatch for each tile of the screen with the solids that can be seen in it.
/// lists: small tiles, each walked by one lane with a list of its own (list_build.h).
/// index: in a storage buffer, with a tree of boxes (free rays).
enum class Plan { automatic, baked, uniform, storage, tiles, lists, index };

struct CastOptions {
  Method method = Method::exact;
  Arithmetic arithmetic = Arithmetic::automatic;
  Plan plan = Plan::automatic;
  int pictures = 1;                                   // that the caster is expected to make
  bool moving = false;                                // ... each of another scene or from another place (setScene)
  std::string shaderFolder{};                         // compile from here instead of the carried modules; "" = carried
  std::size_t memoryBudget = std::size_t{512} << 20;  // bytes for host-visible buffers
};

/// Phases in ms and sizes, as `--stats` prints them.
struct CastStats {
  double flatten_ms = 0, shader_ms = 0, first_dispatch_ms = 0, dispatch_ms = 0, readback_ms = 0, fallback_ms = 0;
  std::uint64_t rays = 0, fallbackRays = 0;
  std::uint64_t dispatches = 0;  // of plan index: more than one a block where rays had to go on
  std::uint64_t deviceBytes = 0;
  int pipelines = 0;                                      // made so far
  std::vector<std::string> modules;                       // of the search, one a pass
  std::vector<std::filesystem::path> files;               // that the shaders were compiled from; none: as carried
  std::size_t spirvBytes = 0, specialisedSpirvBytes = 0;  // as written, and as the driver got it
  std::uint64_t nanColours = 0;                           // of users' own GLSL, shown in magenta
  std::string planName;                                   // of the last pass: "baked", "uniform", ...
  std::vector<std::string> plan;                          // lines: what was decided, and why
  std::vector<std::string> leftOut;                       // lines: what this scene does not need
};

using CastProgress = std::function<void(double fraction)>;

/// Renders on the device. Keeps its pipelines and records, so that it can render again. The scene and the job must
/// outlive it.
class ImageCaster {
 public:
  ImageCaster(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options);
  ~ImageCaster();
  /// Bands come to `sink` from the top down, each small enough for the memory budget.
  void render(const BandSink& sink, const CastProgress& progress = {});
  /// Another scene, or the same from another place, from now on, with the same kind of camera: pipelines stay unless
  /// other kinds or numbers of solids ask for others. `scene` must outlive the caster or the next call.
  void setScene(const Scene& scene);
  /// Only the shader, over the whole crop: nothing is read back. GPU time in ms. For benchmarks, and therefore baked
  /// from the first call on where that is possible, unless another plan was asked for.
  double dispatchOnly();
  const CastStats& stats() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// ImageCaster for one picture.
void renderGpu(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options,
               const BandSink& sink, CastStats& stats, const CastProgress& progress = {});

/// Casts free rays. A QueryCaster keeps its pipeline and records between calls, so that rays can stream.
class QueryCaster {
 public:
  QueryCaster(gpu::Device& device, const World& world, const CastOptions& options);
  ~QueryCaster();
  void cast(std::span<const QueryRay> rays, std::span<QueryHit> hits);
  /// Casts at another world from now on, which must outlive the caster. The pipeline stays if both worlds have as many
  /// solids of each kind, so that a solid after the other costs next to nothing.
  void setWorld(const World& world);
  /// Only the shader, over these rays (at most 65536), or those of the last call if there are none: nothing is read
  /// back. GPU time in ms. For benchmarks.
  double dispatchOnly(std::span<const QueryRay> rays = {});
  const CastStats& stats() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace solidcast
