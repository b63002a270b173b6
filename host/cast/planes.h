// From a shader's planes (one word a pixel, rows of a stride in whole workgroups) to the channels of a band.
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

#include "host/image/band.h"

namespace solidcast {

/// `to` becomes the band's pixels, `count` values each, from `count` planes of `words` words.
template <class T>
void readPlanes(const std::uint32_t* plane, std::size_t words, int stride, int count, const Band& band,
                std::vector<T>& to) {
  const auto values = static_cast<std::size_t>(count);
  to.resize(static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.rows) * values);
  for (int c = 0; c < count; ++c, plane += words)
    for (int y = 0; y < band.rows; ++y) {
      const std::uint32_t* row = plane + static_cast<std::size_t>(y) * static_cast<std::size_t>(stride);
      T* out = to.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(band.width) * values + c;
      for (int x = 0; x < band.width; ++x) out[static_cast<std::size_t>(x) * values] = std::bit_cast<T>(row[x]);
    }
}

/// Three bytes a pixel, from a plane of words.
inline void readLevels(const std::uint32_t* plane, int stride, const Band& band, std::vector<std::uint8_t>& to) {
  to.resize(static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.rows) * 3);
  std::uint8_t *out = to.data(), *const last = out + to.size() - 3;
  for (int y = 0; y < band.rows; ++y) {
    const std::uint32_t* row = plane + static_cast<std::size_t>(y) * static_cast<std::size_t>(stride);
    // Four bytes at a time; the fourth is where the next pixel begins. Three stores a pixel take three times as long.
    for (int x = 0; x < band.width; ++x, out += 3) std::memcpy(out, row + x, out == last ? 3 : 4);
  }
}

/// Three equal bytes a pixel, from a plane of bytes.
void readGreys(const std::uint8_t* plane, int stride, const Band& band, std::vector<std::uint8_t>& to);

}  // namespace solidcast
