// Records for the lists of a picture: those of spheres, triangles and quads many at a time (record_batch.h), of other kinds and
// where fp32's do not serve one by one.
#pragma once
#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "host/cast/list_layout.h"
#include "host/cast/list_sieve.h"
#include "host/cast/record_batch.h"

namespace solidcast {

/// What a picture's records are made for.
struct ListPacks {
  const World& world;
  RealType type;
  bool eyeForms;
  const EyeFrames& eye;
};

/// Some record needs the shader's code for these (Records).
struct ListFlags {
  bool grazing = false, boxOnFace = false;
};

/// Head: anything with the `solid`'s index in the world. room(kind, bytes, head) says where a record is to be written, kind by
/// kind in the order that the solids were added.
template <class Head, class Room>
class ListPacking {
 public:
  ListPacking(const ListPacks& packs, ListFlags& flags, Room room) : packs_(packs), flags_(flags), room_(room) {}

  void add(const Head& head) {
    packs_.world.solids.shape(head.solid).visit([&](const auto& solid) { put(solid, head); });
  }
  /// Solids that lie far apart in memory.
  void add(std::span<const Head> heads) {
    constexpr std::size_t ahead = 16;
    const Solids& solids = packs_.world.solids;
    for (std::size_t i = 0; i < heads.size() + ahead; ++i) {
      if (i < heads.size()) fetch(solids.shape(heads[i].solid));
      if (i >= ahead) add(heads[i - ahead]);
    }
  }
  /// To be called when all have been added.
  void finish() { flush(spheres_), flush(triangles_), flush(quads_); }

 private:
  struct Many {
    explicit Many(int kind) : records(kind) {}
    RecordBatch records;
    std::array<Head, RecordBatch::block> heads;
  };

  void put(const auto& solid, const Head& head) { alone(solid, head); }
  void put(const Sphere& solid, const Head& head) { together(solid, head, spheres_); }
  void put(const Triangle& solid, const Head& head) { together(solid, head, triangles_); }
  void put(const Quad& solid, const Head& head) { together(solid, head, quads_); }

  void together(const auto& solid, const Head& head, std::optional<Many>& many) {
    if (!packs_.eyeForms || packs_.type != RealType::f32) return alone(solid, head);
    if (!many) many.emplace(kindNumber(solid));
    many->heads[many->records.size()] = head;
    many->records.add(solid, head.solid);
    if (many->records.full()) flush(many);
  }

  void flush(std::optional<Many>& many) {
    if (!many) return;
    const RecordBatch& records = many->records;
    const auto kind = static_cast<std::size_t>(records.kind());
    const std::uint32_t rows = rowsOf(kind, true);
    for (std::size_t i = 0, count = many->records.pack(packs_.eye.plain); i < count; ++i) {
      const Head& head = many->heads[i];
      if (records.poor(i)) {
        packs_.world.solids.shape(head.solid).visit([&](const auto& solid) { alone(solid, head); });
        continue;
      }
      flags_.grazing = flags_.grazing || records.grazing(i);
      records.copy(i, room_(kind, 16 * rows, head));
    }
  }

  void alone(const auto& solid, const Head& head) {
    const RealType type = packs_.type;
    const EyeFrames& eye = packs_.eye;
    if (!packs_.eyeForms) {
      RowWriter rows(type);
      packWorld(solid, eye.exact.origin, head.solid, rows);
      std::ranges::copy(rows.bytes(), room_(static_cast<std::size_t>(kindNumber(solid)), rows.bytes().size(), head));
      return;
    }
    packed(solid, eye, head.solid, type, [&](const auto& record) {
      if (record.kind < 0) return;
      flags_.grazing = flags_.grazing || record.grazing;
      const std::size_t rowSize = rowBytes(type);
      std::byte* to =
          room_(static_cast<std::size_t>(record.kind), rowSize * static_cast<std::size_t>(record.rows), head);
      for (int r = 0; r < record.rows; ++r, to += rowSize) writeRow(to, type, record.row[r]);
    });
    if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, AABox>)
      flags_.boxOnFace = flags_.boxOnFace || eyeOnFacePlane(solid, eye.extended);
  }

  const ListPacks packs_;
  ListFlags& flags_;
  Room room_;
  std::optional<Many> spheres_, triangles_, quads_;
};
template <class Head, class Room>
ListPacking<Head, Room> packingOf(const ListPacks& packs, ListFlags& flags, Room room) {
  return {packs, flags, room};
}

}  // namespace solidcast
