// Image files to compare: PNG, PFM and Radiance HDR, told apart by their first bytes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace solidcast {

/// Rows from the top down, channels of a pixel side by side: 1 (PFM "Pf"), 3, or 4 (PNG with transparency).
/// 8-bit PNGs keep their bytes (grey becomes RGB); 16-bit PNGs become floats, 1.0 is full scale.
struct Image {
  int width = 0, height = 0, channels = 3;
  std::variant<std::vector<std::uint8_t>, std::vector<float>> values;

  bool isFloat() const { return values.index() == 1; }
};

/// Larger images are refused: readers and `compare` hold whole images. 100 million.
constexpr std::int64_t kMostPixels = 100'000'000;

/// Throws Error(Exit::usage) with one line for whatever is wrong with the file.
Image readImage(const std::string& path);

/// The same from a file's content; `name` is used in messages.
Image decodeImage(const std::vector<std::uint8_t>& content, const std::string& name);

}  // namespace solidcast
