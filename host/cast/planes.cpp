#include "host/cast/planes.h"

#include "host/cast/wide.h"

namespace solidcast {
namespace {

/// Sixteen pixels in three shuffles.
WIDE void triple(const std::uint8_t* from, std::size_t count, std::uint8_t* to) {
  using Bytes = std::uint8_t __attribute__((vector_size(16)));
  constexpr Bytes first{0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5};
  constexpr Bytes second{5, 5, 6, 6, 6, 7, 7, 7, 8, 8, 8, 9, 9, 9, 10, 10};
  constexpr Bytes third{10, 11, 11, 11, 12, 12, 12, 13, 13, 13, 14, 14, 14, 15, 15, 15};
  std::size_t i = 0;
  for (; i + sizeof(Bytes) <= count; i += sizeof(Bytes), to += 3 * sizeof(Bytes)) {
    Bytes here;
    std::memcpy(&here, from + i, sizeof here);
    const Bytes three[3] = {__builtin_shuffle(here, first), __builtin_shuffle(here, second),
                            __builtin_shuffle(here, third)};
    std::memcpy(to, three, sizeof three);
  }
  for (; i < count; ++i, to += 3) to[0] = to[1] = to[2] = from[i];
}

}  // namespace

void readGreys(const std::uint8_t* plane, int stride, const Band& band, std::vector<std::uint8_t>& to) {
  const auto width = static_cast<std::size_t>(band.width);
  to.resize(width * static_cast<std::size_t>(band.rows) * 3);
  for (std::size_t y = 0; y < static_cast<std::size_t>(band.rows); ++y)
    triple(plane + y * static_cast<std::size_t>(stride), width, to.data() + y * width * 3);
}

}  // namespace solidcast
