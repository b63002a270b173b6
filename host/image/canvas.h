// A small picture with text in it: the legend of a difference picture.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace solidcast {

using Colour = std::array<std::uint8_t, 3>;

class Canvas {
 public:
  Canvas(int width, int height, Colour background);

  int width() const { return width_; }
  int height() const { return height_; }
  const std::vector<std::uint8_t>& rgb() const { return rgb_; }  // 3 a pixel, rows from the top down

  /// What lies outside is left out.
  void fill(int x, int y, int width, int height, Colour colour);
  /// Upper left corner; letters are kLetterHeight x scale high. Only ASCII, others show as '?'.
  void text(int x, int y, int scale, const std::string& text, Colour colour);

  static constexpr int kLetterHeight = 10;  // with the descenders
  static int textWidth(const std::string& text, int scale);

 private:
  int width_, height_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace solidcast
