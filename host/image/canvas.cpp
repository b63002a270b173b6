#include "host/image/canvas.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <cstring>

namespace solidcast {
namespace {

std::string ascii(std::string text) {
  for (char& letter : text)
    if (letter < ' ' || letter > '~') letter = '?';
  return text;
}

struct Vertex {
  float x, y, z;
  std::uint8_t colour[4];
};

}  // namespace

Canvas::Canvas(int width, int height, Colour background)
    : width_(width), height_(height), rgb_(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
  fill(0, 0, width, height, background);
}

void Canvas::fill(int x, int y, int width, int height, Colour colour) {
  for (int j = std::max(y, 0); j < std::min(y + height, height_); ++j)
    for (int i = std::max(x, 0); i < std::min(x + width, width_); ++i)
      std::copy(colour.begin(), colour.end(), &rgb_[3 * (static_cast<std::size_t>(j) * width_ + i)]);
}

void Canvas::text(int x, int y, int scale, const std::string& text, Colour colour) {
  std::string letters = ascii(text);
  std::vector<Vertex> vertices(letters.size() * 4 * 24);  // a letter has at most 24 strokes
  const int quads = stb_easy_font_print(0, 0, letters.data(), nullptr, vertices.data(),
                                        static_cast<int>(vertices.size() * sizeof(Vertex)));
  for (int i = 0; i < quads; ++i) {
    const Vertex &from = vertices[4 * i], &to = vertices[4 * i + 2];  // opposite corners, in whole pixels
    fill(x + scale * static_cast<int>(from.x), y + scale * static_cast<int>(from.y),
         scale * static_cast<int>(to.x - from.x), scale * static_cast<int>(to.y - from.y), colour);
  }
}

int Canvas::textWidth(const std::string& text, int scale) { return scale * stb_easy_font_width(ascii(text).data()); }

}  // namespace solidcast
