// Records for the lists of a picture: those of spheres, triangles and quads many at a time (record_batch.h), of other kinds and
// where fp32's do not serve one by one.
#pragma once
#include <array>
#include <optional>
#include <span>

#include "host/cast/list_part.h"
#include "host/cast/record_batch.h"

namespace solidcast {

/// Of one level's solids, kind by kind in the order that they are added.
class ListPacking {
 public:
  /// Into `part`, for those of the tiles that may see a solid by `limits`.
  ListPacking(ListBuilder::Part& part, ListLevel level, const TileLimits& limits, const ListBuilder::Packs& packs)
      : part_(part), level_(level), limits_(limits), packs_(packs) {}

  void add(const ListHead& head);
  /// Solids that lie far apart in memory.
  void add(std::span<const ListHead> heads);
  /// To be called when all have been added.
  void finish();

 private:
  struct Many {
    explicit Many(int kind) : records(kind) {}
    RecordBatch records;
    std::array<ListHead, RecordBatch::block> heads;
  };

  void put(const auto& solid, const ListHead& head) { alone(solid, head); }
  void put(const Sphere& solid, const ListHead& head) { together(solid, head, spheres_); }
  void put(const Triangle& solid, const ListHead& head) { together(solid, head, triangles_); }
  void put(const Quad& solid, const ListHead& head) { together(solid, head, quads_); }
  void together(const auto& solid, const ListHead& head, std::optional<Many>& many);
  void flush(std::optional<Many>& many);
  void alone(const auto& solid, const ListHead& head);
  std::byte* room(std::size_t kind, std::size_t bytes, const ListHead& head) {
    return part_.add(kind, bytes, head, level_, limits_);
  }

  ListBuilder::Part& part_;
  const ListLevel level_;
  const TileLimits& limits_;
  const ListBuilder::Packs packs_;
  std::optional<Many> spheres_, triangles_, quads_;
};

}  // namespace solidcast
