// One pass over an image: what is stored of every pixel, read back, and cast again where it is in doubt. How the solids
// are searched is a PixelSearch's business (group_search.h, ...), of which a scene gets the one that plan.h decides for.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "host/cast/custom_stage.h"
#include "host/cast/program.h"
#include "host/cast/second_pass.h"

namespace solidcast {

/// A count or a coordinate, as the shaders take it.
constexpr std::uint32_t u(int v) { return static_cast<std::uint32_t>(v); }

/// Bits of pixels.comp's WANTED, in the order of the planes.
enum Wanted : std::uint32_t { RGB8 = 1, RADIANCE = 2, DISTANCE = 4, SOLID = 8, NORMAL = 16, LOCAL = 32, POSITION = 64 };

/// Buffers hold whole workgroups: the shaders have no branch for pixels beyond the edge. A workgroup of pixels.comp has 8 x 8
/// invocations, each of 4, 8 or 16 pixels of a row; the buffers fit the widest.
inline constexpr int groupWidth = 128, groupRows = 8;
constexpr int padded(int n, int to) { return (n + to - 1) / to * to; }

/// Whether colours of 8 bits are stored as one byte a pixel: the scene's integrator knows grey alone.
bool isGrey(const Scene& scene);

/// Where a dispatch stores.
struct PassTarget {
  const gpu::Buffer& image;   // planes of stride x rows words
  const gpu::Buffer* doubts;  // pixels.comp: Doubts; only exact has it
  int stride, rows;           // in whole workgroups
};

/// What a pass is about, and stays about while scenes change.
struct PassJob {
  gpu::Device& device;
  const RenderJob& job;
  CastOptions options;
  Crop crop;
  Program program;  // `storage` is the search's to decide
  std::uint32_t wanted = 0;
  int samples = 1;
  CastStats& stats;
};

/// Searches the solids and stores what is wanted: records, shader, pipeline and dispatches.
class PixelSearch {
 public:
  virtual ~PixelSearch() = default;
  virtual const Program& program() const = 0;
  /// Another scene of the same kind of camera: records anew; the pipeline only if its constants differ. `scene` must
  /// outlive the search or the next call.
  virtual void setScene(const Scene& scene) = 0;
  /// What the band needs beside the pipeline, where that was not made for it already.
  virtual void prepare(const PassTarget&, const Band&) {}
  /// Bytes of device memory a pixel takes, beside the image.
  virtual std::size_t bytesPerPixel() const { return 0; }
  /// One sample of every pixel of the band; GPU time in ms.
  virtual double dispatch(const PassTarget& target, const Band& band, int sample) = 0;
  /// Change over now to what pays only in the long run.
  virtual void settle() {}
};

/// The search that the plan decides for.
std::unique_ptr<PixelSearch> makeSearch(const PassJob& job, const Scene& scene);

class Pass {
 public:
  /// `others`: all channels but the radiance.
  Pass(gpu::Device& device, const Scene& scene, const RenderJob& job, const Crop& crop, const CastOptions& options,
       bool radiance, bool others, CastStats& stats);

  void setScene(const Scene& scene);
  /// Bytes of device memory a row takes, beside the records.
  std::size_t bytesPerRow(int width) const;
  const Program& program() const { return search_->program(); }
  void makeBuffers(int width, int rows);
  void settle() { search_->settle(); }
  /// Runs the shader over the band and keeps the list of doubts.
  void dispatch(const Band& band);
  /// Fills the band's channels; the band's geometry is set already.
  void run(Band& band);

 private:
  std::size_t words() const;
  void makeDoubts(std::size_t capacity);
  std::vector<std::uint32_t> doubtfulPixels(std::span<const std::uint32_t> entries, const Band& band) const;
  void read(Band& band) const;
  PassTarget target(const Band& band) const;
  double dispatchSample(const Band& band, int sample);
  void secondPass(Band& band);  // pass_doubts.cpp
  void settleDoubts(const Band& band, std::size_t sample);
  RayQ rayOf(const PixelRays& rays, const Band& band, std::size_t pixel, std::size_t sample) const;
  void fillSurfaces(Band& band, const PixelRays& rays);

  const Scene* scene_;
  const RenderJob& job_;
  gpu::Device& device_;
  Crop crop_;
  CastStats& stats_;
  bool exact_ = false, surfaces_ = false, radiance_ = false, others_ = false, warm_ = false;
  bool levels_ = false;  // the device makes 8 bits of the radiance
  int samples_ = 1, stride_ = 0;
  std::uint32_t wanted_ = 0, capacity_ = 0;
  std::unique_ptr<PixelSearch> search_;
  std::unique_ptr<CustomStage> custom_;  // then image_ holds its planes, of which the search fills the first two
  gpu::Buffer image_, doubts_;
  std::vector<std::vector<std::uint32_t>> doubtful_;  // by sample: pixels of the band
  std::optional<SecondPass> second_;
};

/// What a radiance of 0 to 1 is in 8 bits: truncated, as the course's images are.
std::uint8_t toLevel(float radiance);

}  // namespace solidcast
