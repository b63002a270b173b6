// The search by lists: shaders/lists.comp with what ListBuilder makes. A picture costs about the same however many
// solids there are in the scene, beside the one pass over them that makes the lists.
#pragma once
#include <optional>

#include "host/cast/list_build.h"
#include "host/cast/pass.h"

namespace solidcast {

class ListSearch : public PixelSearch {
 public:
  ListSearch(const PassJob& job, const Scene& scene);

  const Program& program() const override { return program_; }
  void setScene(const Scene& scene) override;
  void prepare(const PassTarget& target, const Band& band) override;
  double dispatch(const PassTarget& target, const Band& band, int sample) override;

 private:
  void build(const PassTarget& target, const Band& band);
  ListRoom room();
  void loadShader();
  void makePipeline();
  void fillUnlisted(const PassTarget& target) const;

  PassJob job_;
  const Scene* scene_;
  Program program_;
  EyeFrame eye_;
  std::optional<Silhouette> silhouette_;
  ListBuilder builder_;
  std::array<bool, kindCount> kinds_{};  // that the pipeline has
  bool grazing_ = false, farSphere_ = false, boxOnFace_ = false, ties_ = false, portioned_ = false, told_ = false;
  int builtRow_ = -1;  // of the band
  std::size_t lanes_ = 0;
  std::uint32_t viewRaws_ = 0;
  std::vector<std::uint32_t> spirv_;
  gpu::Specialisation constants_;
  std::optional<gpu::Pipeline> pipeline_;
  gpu::Buffer records_, lists_, view_, angles_, state_;
};

}  // namespace solidcast
