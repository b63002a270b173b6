#include "host/cast/list_packing.h"

#include <algorithm>

namespace solidcast {

void ListPacking::add(const ListHead& head) {
  packs_.world.solids.shape(head.solid).visit([&](const auto& solid) { put(solid, head); });
}

void ListPacking::add(std::span<const ListHead> heads) {
  constexpr std::size_t ahead = 16;
  const Solids& solids = packs_.world.solids;
  for (std::size_t i = 0; i < heads.size() + ahead; ++i) {
    if (i < heads.size()) fetch(solids.shape(heads[i].solid));
    if (i >= ahead) add(heads[i - ahead]);
  }
}

void ListPacking::finish() { flush(spheres_), flush(triangles_), flush(quads_); }

void ListPacking::together(const auto& solid, const ListHead& head, std::optional<Many>& many) {
  if (!packs_.eyeForms || packs_.type != RealType::f32) return alone(solid, head);
  if (!many) many.emplace(kindNumber(solid));
  many->heads[many->records.size()] = head;
  if (!many->records.add(solid, head.solid, packs_.eye.plain)) return alone(solid, head);
  if (many->records.full()) flush(many);
}

void ListPacking::flush(std::optional<Many>& many) {
  if (!many) return;
  const RecordBatch& records = many->records;
  const std::uint32_t rows = rowsOf(static_cast<std::size_t>(records.kind()), true);
  for (std::size_t i = 0, count = many->records.pack(packs_.eye.plain); i < count; ++i) {
    const ListHead& head = many->heads[i];
    if (records.poor(i)) {
      packs_.world.solids.shape(head.solid).visit([&](const auto& solid) { alone(solid, head); });
      continue;
    }
    part_.grazing = part_.grazing || records.grazing(i);
    records.copy(i, room(static_cast<std::size_t>(records.kind()), 16 * rows, head), 4 * rows);
  }
}

void ListPacking::alone(const auto& solid, const ListHead& head) {
  const RealType type = packs_.type;
  const EyeFrames& eye = packs_.eye;
  if (!packs_.eyeForms) {
    RowWriter rows(type);
    packWorld(solid, eye.exact.origin, head.solid, rows);
    const auto kind = static_cast<std::size_t>(kindNumber(solid));
    std::ranges::copy(rows.bytes(), room(kind, rows.bytes().size(), head));
    return;
  }
  packed(solid, eye, head.solid, type, [&](const auto& record) {
    if (record.kind < 0) return;
    part_.grazing = part_.grazing || record.grazing;
    const std::size_t rowSize = rowBytes(type);
    std::byte* to = room(static_cast<std::size_t>(record.kind), rowSize * static_cast<std::size_t>(record.rows), head);
    for (int r = 0; r < record.rows; ++r, to += rowSize) writeRow(to, type, record.row[r]);
  });
  if constexpr (std::is_same_v<std::decay_t<decltype(solid)>, AABox>)
    part_.boxOnFace = part_.boxOnFace || eyeOnFacePlane(solid, eye.extended);
}

}  // namespace solidcast
