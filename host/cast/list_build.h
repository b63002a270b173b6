// The lists of shaders/lists.comp: for each tile of the screen the records of the solids that can be seen in it, laid
// out in the order they are walked. Most of a large picture's time is spent here, so the solids are gone over once, on
// all cores: seen or not, record, tiles; and a second time only over what is seen, to copy its record to its tiles.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "host/cast/list_part.h"
#include "host/cast/silhouette.h"
#include "host/cast/workers.h"
#include "host/image/band.h"
#include "host/scene/world.h"

namespace solidcast {

class ListBuilder {
 public:
  ListBuilder();
  ~ListBuilder();

  /// collect() comes soon.
  void prepare() { workers_.wake(); }

  /// Which solids are seen where, and their records: forms for the camera's one eye, correct to 2^-3 of the type's
  /// rounding (docs/numerics.md), or the solids themselves from the camera's centre, for rays that are free.
  /// `eye` is eyeFrame() of the scene, for forms of `type`, otherwise for f64.
  /// `room` is called when what is found is known, but for tiles(), which may still be on its way; to what it says the lists
  /// are then written.
  void collect(const Scene& scene, const EyeFrame& eye, RealType type, bool eyeForms, const Silhouette& silhouette,
               const ListGrid& grid, const std::function<ListRoom()>& room);

  // What collect() found:
  std::array<bool, kindCount> kinds() const { return layout_.kinds(); }
  bool wideOnes() const { return layout_.wideOnes(); }  // some solids are in wide tiles
  bool grazing() const { return grazing_; }
  bool farSphere() const { return farSphere_; }
  bool boxOnFace() const { return boxOnFace_; }
  std::size_t rows() const { return layout_.rows(); }  // that the lists take
  std::size_t seen() const;                            // solids; counts them
  /// Tiles with solids, in the order of the dispatch, then the others in theirs. A dispatch may go beyond listedTiles(), never beyond all.
  std::span<const std::uint32_t> tiles() const { return layout_.tiles(); }
  std::size_t listedTiles() const { return layout_.listedTiles(); }
  std::uint32_t longest() const { return layout_.longest(); }  // list of a tile

 private:
  struct Shared;
  /// A thread's part, together with the others.
  void sift(std::size_t thread, Shared& shared, Footprints& footprints);
  void listAll(std::size_t thread, Shared& shared, Footprints& footprints);
  void listWides(std::size_t thread, const Shared& shared);
  void note(std::size_t patch, const DepthBounds& depths);
  bool someWide(const Crop& area, DepthCode deepest, std::size_t threads) const;
  void layOut();

  ListGrid grid_;
  Workers workers_;
  std::vector<std::unique_ptr<ListPart>> parts_;
  ListLayout layout_;
  std::vector<ListPatch> patches_;  // by wide tile, where there are several rounds
  TileLimits tileLimits_, wideLimits_;
  std::unique_ptr<SmallDisc[]> discs_;  // of a round's solids
  std::size_t discRoom_ = 0;
  bool grazing_ = false, farSphere_ = false, boxOnFace_ = false;
};

}  // namespace solidcast
