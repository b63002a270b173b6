#include "host/study/pictures.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "host/image/writer.h"

namespace solidcast::study {
namespace {

using Colour = std::array<std::uint8_t, 3>;

// Light to dark, so that the order survives grey printing and colour blindness; red is kept for wrong decisions.
constexpr std::array<Colour, 5> kScale{
    {{255, 255, 255}, {199, 218, 240}, {120, 160, 214}, {84, 88, 170}, {52, 12, 92}}};
constexpr Colour kNothing{222, 222, 218}, kWrong{230, 0, 20};

Colour colourOf(double ulps) {
  if (ulps <= 1) return {255, 255, 255};
  const double at = std::min(1.0, std::log10(ulps) / 6) * (kScale.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, kScale.size() - 1);
  Colour c;
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = static_cast<std::uint8_t>(std::lround(kScale[low][i] + (at - low) * (kScale[high][i] - kScale[low][i])));
  return c;
}

}  // namespace

std::string pngOf(int width, int height, std::vector<std::uint8_t> rgb) {
  static int counter = 0;
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() /
      ("solidcast-" + std::to_string(getpid()) + "-" + std::to_string(counter++) + ".png");
  {
    ImageWriter writer(file.string(), width, height);
    Band band;
    band.width = width, band.rows = height;
    band.rgb8 = std::move(rgb);
    writer.rows(band);
    writer.finish();
  }
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  std::filesystem::remove(file);
  return bytes.str();
}

std::string errorColour(double ulps) {
  const Colour c = colourOf(ulps);
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", c[0], c[1], c[2]);
  return text;
}

ScenePicture errorPicture(const Scene& scene, const std::vector<Verdict>& truth, const Pixels& answers,
                          std::size_t way) {
  std::vector<std::uint8_t> rgb(truth.size() * 3);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    Colour c = kNothing;
    if (answers.solid[i] != truth[i].index) c = kWrong;
    else if (truth[i].index >= 0) {
      const double ulps = oracle::ulpError(answers.distance[i], truth[i].t);
      c = std::isfinite(ulps) ? colourOf(ulps) : kWrong;
    }
    std::copy(c.begin(), c.end(), rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
  }
  return {scene.file,  kWays[way].label, way, pngOf(scene.width, scene.height, std::move(rgb)),
          scene.width, scene.height};
}

}  // namespace solidcast::study
