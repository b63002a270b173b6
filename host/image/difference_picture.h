// What differs, for people: A, B and a heat map beside each other, with a legend.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/image/compare.h"
#include "host/image/writer.h"

namespace solidcast {

/// The heat map shows A darkened, and on it every pixel that differs, by its worst channel, on a logarithmic scale from
/// blue to yellow; cyan where one side is NaN or infinite. Marks are 3x3 pixels unless the image is so small that it is
/// magnified. Float images outside [0,1] are shown from their least to their largest number.
/// The heat map alone, 3 bytes a pixel, as large as the images.
std::vector<std::uint8_t> heatMap(const Image& a, const Image& b, const Census& census);

class DifferencePicture {
 public:
  /// Opens a PNG file at once, for images of this size: see ImageWriter for what it throws. Other endings than .png
  /// throw Error(Exit::usage).
  DifferencePicture(const std::string& path, int width, int height);

  /// `nameA` and `nameB` stand above the images. Writes and finishes the file.
  void write(const Image& a, const Image& b, const Census& census, const std::string& nameA, const std::string& nameB);

 private:
  int scale_;       // magnification of small images
  int panelWidth_;  // of each of the three
  int textScale_;
  int panelHeight_;
  ImageWriter writer_;
};

}  // namespace solidcast
