// The search over all solids: every ray tries every record, from a uniform buffer, from constants of the pipeline (baked), from
// storage buffers in portions, or, by screen tiles, the records of its own tile.
#pragma once
#include <map>

#include "host/cast/pass.h"
#include "host/cast/plan.h"
#include "host/cast/tiles.h"

namespace solidcast {

class GroupSearch : public PixelSearch {
 public:
  GroupSearch(const PassJob& job, const Scene& scene, const PlanChoice& choice);

  const Program& program() const override { return program_; }
  void setScene(const Scene& scene) override;
  std::size_t bytesPerPixel() const override { return portions_.size() > 1 ? stateBytes : 0; }
  void prepare(const PassTarget&, const Band& band) override { prepareTiles(band); }
  double dispatch(const PassTarget& target, const Band& band, int sample) override;
  void settle() override;

 private:
  static constexpr std::size_t stateBytes = 48;  // pixels.comp: Kept, at most

  void chooseStorage(const Records& search, std::size_t worldBytes);
  void makePipeline(const Records& search, const Records& world, std::size_t viewRaws);
  void loadModule();
  void usePipeline(std::span<const std::uint32_t> spirv);
  void bake();
  void prepareTiles(const Band& band);

  PassJob job_;
  const Scene* scene_;
  Program program_;
  Plan asked_;
  std::optional<double> bakingCosts_;  // ms; none: not possible, not wanted, or done
  bool bakeAtOnce_;
  bool wide_, address_;  // PlanChoice
  int turn_;             // the same
  double spent_ = 0;     // ms of dispatches so far, without the first
  bool warm_ = false;
  std::vector<SearchPortion> portions_;
  std::optional<Records> tiledSearch_;  // what tiles are made from
  std::vector<TileSearch> tiles_;       // of the band that starts at tiledRow_; empty: the whole band at once
  int tiledRow_ = -1, tileRows_ = 0;
  std::string compiled_;              // name of the module in spirv_
  std::vector<std::uint32_t> spirv_;  // before constants are set
  gpu::Specialisation constants_;
  std::uint32_t solids_ = 0;
  std::optional<gpu::Pipeline> pipeline_;
  std::vector<gpu::Buffer> buffers_;  // by binding; the target's are not here
};

}  // namespace solidcast
