// PFM (both byte orders, Pf and PF) and Radiance HDR (RGBE; plain, old and new run lengths). See float_encoders.cpp
// for the formats' sources.
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "host/image/decoders.h"

namespace solidcast {
namespace {

/// Reads a header: words and lines from the front of the content.
class Cursor {
 public:
  Cursor(Content content, const std::string& name) : content_(content), name_(name) {}

  /// Up to white space, of which exactly one character is taken.
  std::string_view word() {
    while (at_ < content_.size() && isSpace(content_[at_])) ++at_;
    const std::size_t start = at_;
    while (at_ < content_.size() && !isSpace(content_[at_]) && at_ - start < 64) ++at_;
    const std::string_view found = text(start, at_);
    if (at_ < content_.size() && isSpace(content_[at_])) ++at_;
    return found;
  }

  /// Up to a line feed, which is taken.
  std::string_view line() {
    const std::size_t start = at_;
    while (at_ < content_.size() && content_[at_] != '\n') ++at_;
    if (at_ == content_.size()) badImage(name_, "ends within its header");
    return text(start, at_++);
  }

  Content rest() const { return content_.subspan(at_); }

 private:
  static bool isSpace(std::uint8_t letter) { return letter == ' ' || (letter >= '\t' && letter <= '\r'); }
  std::string_view text(std::size_t from, std::size_t to) const {
    return {reinterpret_cast<const char*>(content_.data()) + from, to - from};
  }

  Content content_;
  const std::string& name_;
  std::size_t at_ = 0;
};

template <class Number>
Number number(std::string_view word, const char* what, const std::string& name) {
  Number value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    badImage(name, std::string("its header has no readable ") + what);
  return value;
}

float swapped(float value) { return std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value))); }

using Rgbe = std::uint8_t[4];

/// One row of RGBE pixels at a time; every read is checked against the end.
class HdrRows {
 public:
  HdrRows(Content content, const std::string& name) : content_(content), name_(name) {}

  /// `pixels` grows with what is read, so that a small file with a large header asks for little memory.
  void row(std::vector<std::uint8_t>& pixels, std::size_t width) {
    pixels.clear();
    const Content head = content_.subspan(0, std::min<std::size_t>(4, content_.size()));
    if (head.size() == 4 && head[0] == 2 && head[1] == 2 && head[2] < 128 && width >= 8 && width <= 32767) {
      if (static_cast<std::size_t>(head[2] << 8 | head[3]) != width) damaged();
      content_ = content_.subspan(4);
      pixels.resize(4 * width);
      for (std::size_t part = 0; part < 4; ++part) component(pixels, width, part);
    } else {
      plain(pixels, width);
    }
  }

  bool atEnd() const { return content_.empty(); }

 private:
  [[noreturn]] void damaged() const { badImage(name_, "not a readable HDR: damaged or cut short"); }

  std::uint8_t next() {
    if (content_.empty()) damaged();
    const std::uint8_t byte = content_.front();
    content_ = content_.subspan(1);
    return byte;
  }

  void component(std::vector<std::uint8_t>& pixels, std::size_t width, std::size_t part) {
    for (std::size_t x = 0; x < width;) {
      const std::size_t code = next(), count = code > 128 ? code - 128 : code;
      if (count == 0 || count > width - x) damaged();
      const bool run = code > 128;
      const std::uint8_t value = run ? next() : 0;
      for (std::size_t i = 0; i < count; ++i, ++x) pixels[4 * x + part] = run ? value : next();
    }
  }

  /// Four bytes a pixel; (1, 1, 1, n) repeats the one before n times, several in a row count as higher bytes of n.
  void plain(std::vector<std::uint8_t>& pixels, std::size_t width) {
    int shift = 0;
    for (std::size_t x = 0; x < width;) {
      Rgbe pixel;
      for (std::uint8_t& part : pixel) part = next();
      if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
        pixels.insert(pixels.end(), pixel, pixel + 4);
        ++x;
        shift = 0;
        continue;
      }
      const std::size_t count = static_cast<std::size_t>(pixel[3]) << shift;
      if (x == 0 || count > width - x || shift > 16) damaged();
      pixels.resize(4 * (x + count));
      for (std::size_t i = 0; i < count; ++i, ++x) std::memcpy(&pixels[4 * x], &pixels[4 * x - 4], 4);
      shift += 8;
    }
  }

  Content content_;
  const std::string& name_;
};

}  // namespace

Image decodePfm(Content content, const std::string& name) {
  Cursor cursor(content, name);
  const std::string_view kind = cursor.word();
  if (kind != "PF" && kind != "Pf") badImage(name, "not a readable PFM: it must start with PF or Pf and white space");
  const auto width = number<std::int64_t>(cursor.word(), "width", name);
  const auto height = number<std::int64_t>(cursor.word(), "height", name);
  const auto scale = number<double>(cursor.word(), "scale", name);
  checkImageSize(width, height, name);
  if (!(std::fabs(scale) > 0) || std::isinf(scale)) badImage(name, "its header's scale must be a number but 0");

  const int channels = kind == "PF" ? 3 : 1;
  const std::size_t rowFloats = static_cast<std::size_t>(width) * channels, rows = static_cast<std::size_t>(height);
  const Content body = cursor.rest();
  const std::size_t expected = rowFloats * rows * sizeof(float);
  if (body.size() != expected)
    badImage(name, "has " + std::to_string(body.size()) + " bytes of pixels, expected " + std::to_string(expected));

  std::vector<float> values(rowFloats * rows);
  for (std::size_t row = 0; row < rows; ++row)
    std::memcpy(&values[row * rowFloats], &body[(rows - 1 - row) * rowFloats * sizeof(float)],
                rowFloats * sizeof(float));
  if ((scale < 0) != (std::endian::native == std::endian::little))
    for (float& value : values) value = swapped(value);
  return {static_cast<int>(width), static_cast<int>(height), channels, std::move(values)};
}

Image decodeHdr(Content content, const std::string& name) {
  Cursor cursor(content, name);
  while (true) {
    const std::string_view line = cursor.line();
    if (line.empty()) break;
    if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
      badImage(name, "unknown HDR format, expected 32-bit_rle_rgbe");
  }
  Cursor size(cursor.rest(), name);
  const std::string_view down = size.word();
  const auto height = number<std::int64_t>(size.word(), "height", name);
  const std::string_view right = size.word();
  const auto width = number<std::int64_t>(size.word(), "width", name);
  if (down != "-Y" || right != "+X") badImage(name, "unknown order of pixels, expected -Y HEIGHT +X WIDTH");
  checkImageSize(width, height, name);
  HdrRows rows(size.rest(), name);
  const std::size_t columns = static_cast<std::size_t>(width);
  std::vector<std::uint8_t> pixels;
  std::vector<float> values;
  for (std::int64_t y = 0; y < height; ++y) {
    rows.row(pixels, columns);
    for (std::size_t i = 0; i < pixels.size(); i += 4)
      for (std::size_t part = 0; part < 3; ++part)
        values.push_back(pixels[i + 3] == 0 ? 0.0f
                                            : std::ldexp(static_cast<float>(pixels[i + part]), pixels[i + 3] - 136));
  }
  if (!rows.atEnd()) badImage(name, "has bytes after its last pixel");
  return {static_cast<int>(width), static_cast<int>(height), 3, std::move(values)};
}

}  // namespace solidcast
