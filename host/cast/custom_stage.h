// What comes after the search where users' own GLSL takes part: surfaces of the hits, custom solids in front of them, and
// colours (shaders/custom/hits.glsl has the order). The search itself does not know of it.
#pragma once
#include <map>
#include <memory>
#include <vector>

#include "host/cast/custom_code.h"
#include "host/cast/program.h"

namespace solidcast {

class CustomStage {
 public:
  static constexpr std::size_t hitWords = 17;  // planes of shaders/custom/hits.glsl

  struct Job {
    gpu::Device& device;
    const RenderJob& job;
    const CastOptions& options;
    Crop crop;
    bool radiance, eightBits;  // whether colours are wanted, and as bytes or as floats
    bool others;               // whether all other channels are
    int samples;
    CastStats& stats;
  };
  CustomStage(const Job& job, const Scene& scene);

  /// Compiles only what has changed, the users' files included.
  void setScene(const Scene& scene);
  /// Words a pixel takes in the buffer of colours.
  std::size_t colourWords() const { return !job_.radiance ? 0 : job_.eightBits ? 1 : 3; }
  void makeBuffers(std::size_t pixels);
  /// One sample, whose distances and solids the search has left in `hits`. Gives GPU time in ms. Throws
  /// Error(Exit::shader) `file:line: error: ...` where a loop had to be stopped.
  double dispatch(const gpu::Buffer& hits, int stride, int rows, const Band& band, int sample);
  /// Fills the band's channels: the colours, and all that hits have.
  void read(const gpu::Buffer& hits, int stride, int rows, Band& band) const;

 private:
  struct Code {
    CustomModule module;
    gpu::Pipeline pipeline;
  };
  struct Solid {
    std::shared_ptr<Code> code;
    gpu::Buffer values;
    const CustomSolid* solid;
  };
  std::shared_ptr<Code> codeFor(CustomKind kind, const CustomCode& code, const std::vector<std::shared_ptr<Code>>& old);
  void addFiles(const std::vector<std::filesystem::path>& files);
  void checkReport();

  Job job_;
  const Scene* scene_ = nullptr;
  std::vector<gpu::Buffer> buffers_;  // by binding; 3 is the pass's
  std::optional<gpu::Pipeline> surfaces_, shade_;
  gpu::Specialisation surfacesConstants_, shadeConstants_;
  std::vector<std::shared_ptr<Code>> codes_;  // of all custom files, each once
  std::vector<Solid> solids_;
  std::shared_ptr<Code> radiance_;
  gpu::Buffer radianceValues_;
};

}  // namespace solidcast
