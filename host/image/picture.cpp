#include "host/image/picture.h"

#include <array>
#include <cmath>

namespace solidcast {
namespace {

using Colour = std::array<std::uint8_t, 3>;

/// Neighbouring indices get hues far from each other: the hue steps by the golden ratio.
Colour solidColour(std::int32_t index) {
  if (index < 0) return {0, 0, 0};
  const double hue = 6 * std::fmod(0.61803398874989485 * index + 0.6, 1.0);
  const double value = 1 - 0.2 * (index / 7 % 3);
  const auto ramp = [&](double shift) {
    const double place = std::fmod(hue + shift, 6.0);
    const double amount = std::fmin(std::fmax(std::fabs(place - 3) - 1, 0.0), 1.0);
    return level(static_cast<float>(value * (0.25 + 0.75 * amount)));
  };
  return {ramp(0), ramp(4), ramp(2)};
}

float squash(float distance) { return std::isinf(distance) ? 1.0f : distance / (1 + distance); }
float signedSquash(float x) { return std::isinf(x) ? (x > 0 ? 1.0f : 0.0f) : 0.5f + 0.5f * (x / (1 + std::fabs(x))); }
float halved(float n) { return 0.5f * n + 0.5f; }
float fraction(float x) { return x >= 0 && x <= 1 ? x : x - std::floor(x); }

template <class Map>
std::vector<std::uint8_t> mapped(const std::vector<float>& values, Map map) {
  std::vector<std::uint8_t> bytes(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) bytes[i] = level(map(values[i]));
  return bytes;
}

std::vector<std::uint8_t> solidPicture(const std::vector<std::int32_t>& solids) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * solids.size());
  for (const std::int32_t index : solids)
    for (const std::uint8_t part : solidColour(index)) bytes.push_back(part);
  return bytes;
}

std::vector<std::uint8_t> grey(const std::vector<std::uint8_t>& levels) {
  std::vector<std::uint8_t> bytes(3 * levels.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = levels[i / 3];
  return bytes;
}

}  // namespace

std::uint8_t level(float value) {
  if (!(value > 0)) return 0;  // NaN as well
  return value >= 1 ? 255 : static_cast<std::uint8_t>(255 * value);
}

std::vector<std::uint8_t> picture(const Band& band, ImageKind kind) {
  switch (kind) {
    case ImageKind::radiance:
      return band.rgb8;
    case ImageKind::distance:
      return grey(mapped(band.distance, squash));
    case ImageKind::solid:
      return solidPicture(band.solid);
    case ImageKind::normal:
      return mapped(band.normal, halved);
    case ImageKind::local:
      return mapped(band.local, fraction);
    case ImageKind::position:
      return mapped(band.position, signedSquash);
  }
  return {};
}

}  // namespace solidcast
