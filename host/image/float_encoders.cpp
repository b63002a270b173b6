// PFM and Radiance HDR.
//
// PFM (P. Debevec's portable float map): "PF" or "Pf", size, a scale whose sign gives the byte order, then the rows
// from the BOTTOM up. Bands come from the top, so each is written at its place from the end.
//
// Radiance HDR (G. Ward, "Real Pixels", Graphics Gems II): three 8-bit mantissas with one exponent. Mantissas are
// rounded to nearest: at most 1/2 of 2^-7 of the largest component.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>
#include <vector>

#include "host/image/encoders.h"

namespace solidcast {
namespace {

class PfmEncoder final : public RowEncoder {
 public:
  PfmEncoder(OutputFile& file, int width, int height, int channels)
      : file_(file),
        rowFloats_(static_cast<std::size_t>(width) * static_cast<std::size_t>(channels)),
        rowsLeft_(static_cast<std::size_t>(height)) {
    const char* scale = std::endian::native == std::endian::little ? "-1.0" : "1.0";
    const std::string header = std::string(channels == 1 ? "Pf" : "PF") + "\n" + std::to_string(width) + " " +
                               std::to_string(height) + "\n" + scale + "\n";
    headerBytes_ = header.size();
    file_.writeAt(0, header.data(), header.size());
  }

  using RowEncoder::rows;
  void rows(const float* values, int count) override {
    const std::size_t rows = static_cast<std::size_t>(count);
    turned_.resize(rows * rowFloats_);
    for (std::size_t row = 0; row < rows; ++row)
      std::copy_n(values + row * rowFloats_, rowFloats_, turned_.begin() + (rows - 1 - row) * rowFloats_);
    rowsLeft_ -= rows;
    file_.writeAt(headerBytes_ + rowsLeft_ * rowFloats_ * sizeof(float), turned_.data(),
                  turned_.size() * sizeof(float));
  }

 private:
  OutputFile& file_;
  std::size_t rowFloats_, rowsLeft_, headerBytes_ = 0;
  std::vector<float> turned_;
};

using RgbeBytes = std::array<std::uint8_t, 4>;

RgbeBytes rgbe(const float* colour) {
  std::array<float, 3> part;
  for (int i = 0; i < 3; ++i) part[i] = colour[i] > 0 ? std::min(colour[i], 0x1.fep126f) : 0;  // NaN becomes 0
  const float largest = std::max({part[0], part[1], part[2]});
  if (largest < 0x1p-127f) return {};
  int exponent;
  std::frexp(largest, &exponent);
  if (std::nearbyint(std::ldexp(largest, 8 - exponent)) > 255) ++exponent;
  RgbeBytes out;
  for (int i = 0; i < 3; ++i) out[i] = static_cast<std::uint8_t>(std::nearbyint(std::ldexp(part[i], 8 - exponent)));
  out[3] = static_cast<std::uint8_t>(exponent + 128);
  return out;
}

class HdrEncoder final : public RowEncoder {
 public:
  HdrEncoder(OutputFile& file, int width, int height)
      : file_(file), width_(static_cast<std::size_t>(width)), row_(width_) {
    const std::string header =
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " + std::to_string(width) + "\n";
    file_.append(header.data(), header.size());
  }

  using RowEncoder::rows;
  void rows(const float* values, int count) override {
    bytes_.clear();
    for (int row = 0; row < count; ++row) {
      for (RgbeBytes& pixel : row_) {
        pixel = rgbe(values);
        values += 3;
      }
      if (width_ >= 8 && width_ <= 32767) putRunLengths();
      else
        for (const RgbeBytes& pixel : row_) bytes_.insert(bytes_.end(), pixel.begin(), pixel.end());
    }
    file_.append(bytes_.data(), bytes_.size());
  }

 private:
  /// A row of its own length in the head, then each of the four components as runs (128 + n, value) and
  /// literals (n, n values), n at most 127 and 128.
  void putRunLengths() {
    bytes_.insert(bytes_.end(),
                  {2, 2, static_cast<std::uint8_t>(width_ >> 8), static_cast<std::uint8_t>(width_ & 255)});
    for (int part = 0; part < 4; ++part) {
      std::size_t literal = 0;  // where the values start that are in no run
      for (std::size_t i = 0; i < width_;) {
        std::size_t run = 1;
        while (i + run < width_ && run < 127 && row_[i + run][part] == row_[i][part]) ++run;
        if (run < 4 && i + run < width_) {
          i += run;
          continue;
        }
        if (run < 4) i += run;  // the row ends with a literal
        for (; literal < i; literal += std::min<std::size_t>(128, i - literal))
          putLiteral(part, literal, std::min<std::size_t>(128, i - literal));
        if (run < 4) break;
        bytes_.push_back(static_cast<std::uint8_t>(128 + run));
        bytes_.push_back(row_[i][part]);
        i += run;
        literal = i;
      }
    }
  }

  void putLiteral(int part, std::size_t first, std::size_t count) {
    bytes_.push_back(static_cast<std::uint8_t>(count));
    for (std::size_t i = first; i < first + count; ++i) bytes_.push_back(row_[i][part]);
  }

  OutputFile& file_;
  std::size_t width_;
  std::vector<RgbeBytes> row_;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace

std::unique_ptr<RowEncoder> makePfmEncoder(OutputFile& file, int width, int height, int channels) {
  return std::make_unique<PfmEncoder>(file, width, height, channels);
}

std::unique_ptr<RowEncoder> makeHdrEncoder(OutputFile& file, int width, int height) {
  return std::make_unique<HdrEncoder>(file, width, height);
}

}  // namespace solidcast
