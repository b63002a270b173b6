#include "host/image/difference_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host/error.h"
#include "host/image/canvas.h"
#include "host/image/picture.h"

namespace solidcast {
namespace {

constexpr Colour kPaper{24, 24, 28}, kInk{230, 230, 230}, kNotFinite{0, 255, 255};
constexpr int kNarrowest = 320, kGap = 8;
constexpr int kHeadLines = 2, kFootLines = 7;  // in heights of a letter

int headHeight(int textScale) { return kHeadLines * Canvas::kLetterHeight * textScale; }
int footHeight(int textScale) { return kFootLines * Canvas::kLetterHeight * textScale; }

int magnification(int width, int height) { return std::clamp(kNarrowest / width, 1, std::max(1, 960 / height)); }

std::string checkedPng(const std::string& path) {
  if (imageFormat(path) != ImageFormat::png)
    throw Error(Exit::usage, path + ": a difference picture is a PNG image, expected the ending .png");
  return path;
}

/// Place on the colour bar, 0 to 1. The scale is linear near 0 and logarithmic beyond: one level stays visible beside
/// flips of 255, and for floats 1/1000 of the largest difference.
class Heat {
 public:
  explicit Heat(const Census& census) : largest_(census.maxFinite), unit_(census.unit) {}

  double place(double difference) const { return largest_ > 0 ? std::log1p(difference / knee()) / full() : 0; }

  Colour colour(double difference) const { return std::isfinite(difference) ? at(place(difference)) : kNotFinite; }

  /// Blue, violet, orange, yellow.
  static Colour at(double place) {
    constexpr std::array<std::array<double, 3>, 4> kStops{
        {{70, 110, 255}, {170, 40, 170}, {240, 110, 40}, {255, 245, 120}}};
    const double along = std::clamp(place, 0.0, 1.0) * (kStops.size() - 1);
    const std::size_t from = std::min<std::size_t>(static_cast<std::size_t>(along), kStops.size() - 2);
    const double part = along - static_cast<double>(from);
    Colour colour;
    for (std::size_t i = 0; i < 3; ++i)
      colour[i] = static_cast<std::uint8_t>(kStops[from][i] + part * (kStops[from + 1][i] - kStops[from][i]));
    return colour;
  }

  /// Numbers for the bar, from the largest down.
  std::vector<double> ticks() const {
    if (!(largest_ > 0)) return {};
    std::vector<double> values{largest_};
    if (unit_ == Unit::values) {
      for (const double part : {10, 100, 1000}) values.push_back(largest_ / part);
      return values;
    }
    for (const double level : {100, 30, 10, 3, 1})
      if (level < largest_) values.push_back(level);
    return values;
  }

 private:
  double knee() const { return unit_ == Unit::levels ? 1 : largest_ / 1000; }
  double full() const { return std::log1p(largest_ / knee()); }

  double largest_;
  Unit unit_;
};

/// Numbers of an image as levels that can be shown.
class Tone {
 public:
  Tone(const Image& a, const Image& b) {
    float least = 0, largest = 1;
    for (const Image* image : {&a, &b}) {
      if (!image->isFloat()) continue;
      for (const float value : std::get<1>(image->values)) {
        if (!std::isfinite(value)) continue;
        least = std::min(least, value);
        largest = std::max(largest, value);
      }
    }
    offset_ = least;
    factor_ = 1 / (static_cast<double>(largest) - least);
  }

  Colour colour(const Image& image, std::size_t pixel) const {
    Colour colour;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t place = pixel * static_cast<std::size_t>(image.channels) + (image.channels == 1 ? 0 : i);
      colour[i] = image.isFloat() ? level(static_cast<float>((std::get<1>(image.values)[place] - offset_) * factor_))
                                  : std::get<0>(image.values)[place];
    }
    return colour;
  }

 private:
  double offset_, factor_;
};

/// Differences of a row with the largest of the 3x3 pixels around each; rows are asked for in order.
class Marks {
 public:
  Marks(const Image& a, const Image& b, bool spread) : a_(a), b_(b), spread_(spread) {
    if (spread_) {
      below_ = across(0);
      here_.assign(below_.size(), 0);
    }
  }

  std::vector<double> row(int y) {
    if (!spread_) return across(y);
    std::vector<double> above = std::move(here_);
    here_ = std::move(below_);
    below_ = y + 1 < a_.height ? across(y + 1) : std::vector<double>(here_.size());
    for (std::size_t x = 0; x < above.size(); ++x) above[x] = std::max({above[x], here_[x], below_[x]});
    return above;
  }

 private:
  std::vector<double> across(int y) const {
    const std::size_t width = static_cast<std::size_t>(a_.width);
    std::vector<double> row(width);
    for (std::size_t x = 0; x < width; ++x) row[x] = pixelDifference(a_, b_, static_cast<std::size_t>(y) * width + x);
    if (!spread_) return row;
    std::vector<double> wide = row;
    for (std::size_t x = 0; x < width; ++x)
      for (const std::size_t side : {x > 0 ? x - 1 : x, x + 1 < width ? x + 1 : x})
        wide[x] = std::max(wide[x], row[side]);
    return wide;
  }

  const Image &a_, &b_;
  bool spread_;
  std::vector<double> here_, below_;
};

/// A, B and the heat map of each pixel; rows are asked for in order.
class Panels {
 public:
  Panels(const Image& a, const Image& b, const Census& census, bool spread)
      : a_(a), b_(b), tone_(a, b), heat_(census), marks_(a, b, spread) {}

  const Heat& heat() const { return heat_; }

  std::vector<std::array<Colour, 3>> row(int y) {
    const std::vector<double> differences = marks_.row(y);
    std::vector<std::array<Colour, 3>> pixels(differences.size());
    for (std::size_t x = 0; x < pixels.size(); ++x) {
      const std::size_t pixel = static_cast<std::size_t>(y) * pixels.size() + x;
      auto& [a, b, heat] = pixels[x];
      a = tone_.colour(a_, pixel);
      b = tone_.colour(b_, pixel);
      for (std::size_t i = 0; i < 3; ++i) heat[i] = a[i] / 4;
      if (differences[x] > 0) heat = heat_.colour(differences[x]);
    }
    return pixels;
  }

 private:
  const Image &a_, &b_;
  Tone tone_;
  Heat heat_;
  Marks marks_;
};

std::string fitting(std::string text, int width, int textScale) {
  while (!text.empty() && Canvas::textWidth(text, textScale) > width) text.pop_back();
  return text;
}

void drawBar(Canvas& canvas, int x, int y, int width, int textScale, const Heat& heat, const Census& census) {
  const int letter = Canvas::kLetterHeight * textScale, barWidth = width - 12 * letter / 2;
  const std::vector<double> ticks = heat.ticks();
  if (ticks.empty()) {
    canvas.text(x, y, textScale, census.worst.x < 0 ? "no pixel differs" : "cyan: NaN or infinite on one side", kInk);
    return;
  }
  for (int i = 0; i < barWidth; ++i)
    canvas.fill(x + i, y, 1, letter, Heat::at(static_cast<double>(i) / (barWidth - 1)));
  int free = x + width;  // numbers must not touch the one to their right
  for (const double tick : ticks) {
    const int place = x + static_cast<int>(heat.place(tick) * (barWidth - 1));
    const std::string number = brief(tick);
    if (place + Canvas::textWidth(number, textScale) > free) continue;
    canvas.fill(place, y, textScale, letter + letter / 2, kInk);
    canvas.text(place, y + 3 * letter / 2, textScale, number, kInk);
    free = place - letter;
  }
  const std::string unit =
      census.unit == Unit::levels ? "levels of 255, worst channel" : "difference of the worst channel";
  canvas.text(x, y + 3 * letter, textScale, unit, kInk);
  if (std::isinf(census.maxError))
    canvas.text(x, y + 17 * letter / 4, textScale, "cyan: NaN or infinite on one side", kNotFinite);
}

std::vector<std::string> facts(const Census& census) {
  std::vector<std::string> lines{
      std::to_string(census.beyond) + " of " + std::to_string(census.pixels) + " pixels differ by more than " +
          withUnit(census.budget.level, census.unit),
      std::to_string(census.within) + " differ within the tolerance",
      "max " + withUnit(census.maxError, census.unit) +
          (census.worst.x < 0 ? "" : " at " + std::to_string(census.worst.x) + "," + std::to_string(census.worst.y))};
  if (census.hasHits)
    lines.push_back(std::to_string(census.hits.hitMissFlips) + " hit/miss flips, " +
                    std::to_string(census.hits.solidFlips) + " solid flips");
  return lines;
}

Band bandOf(const Canvas& canvas, int firstRow) {
  Band band;
  band.firstRow = firstRow;
  band.rows = canvas.height();
  band.width = canvas.width();
  band.rgb8 = canvas.rgb();
  return band;
}

}  // namespace

std::vector<std::uint8_t> heatMap(const Image& a, const Image& b, const Census& census) {
  Panels panels(a, b, census, true);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(std::size_t{3} * a.width * a.height);
  for (int y = 0; y < a.height; ++y)
    for (const auto& pixel : panels.row(y)) rgb.insert(rgb.end(), pixel[2].begin(), pixel[2].end());
  return rgb;
}

DifferencePicture::DifferencePicture(const std::string& path, int width, int height)
    : scale_(magnification(width, height)),
      panelWidth_(std::max(width * scale_, kNarrowest)),
      textScale_(std::clamp(panelWidth_ / kNarrowest, 1, 8)),
      panelHeight_(height * scale_),
      writer_(checkedPng(path), 3 * panelWidth_ + 2 * kGap,
              headHeight(textScale_) + panelHeight_ + footHeight(textScale_)) {}

void DifferencePicture::write(const Image& a, const Image& b, const Census& census, const std::string& nameA,
                              const std::string& nameB) {
  const int step = panelWidth_ + kGap, total = 2 * step + panelWidth_;
  const int letter = Canvas::kLetterHeight * textScale_;

  Canvas head(total, headHeight(textScale_), kPaper);
  const std::string titles[3] = {"A: " + nameA, "B: " + nameB, "difference of A and B"};
  for (int i = 0; i < 3; ++i)
    head.text(i * step + kGap, letter / 2, textScale_, fitting(titles[i], panelWidth_ - 2 * kGap, textScale_), kInk);
  writer_.rows(bandOf(head, 0));

  Panels panels(a, b, census, scale_ == 1);
  for (int y = 0; y < a.height; ++y) {
    const std::vector<std::array<Colour, 3>> pixels = panels.row(y);
    Canvas row(total, scale_, kPaper);
    for (int x = 0; x < a.width; ++x)
      for (int i = 0; i < 3; ++i) row.fill(i * step + x * scale_, 0, scale_, scale_, pixels[x][i]);
    writer_.rows(bandOf(row, head.height() + y * scale_));
  }

  Canvas foot(total, footHeight(textScale_), kPaper);
  int line = letter;
  for (const std::string& fact : facts(census)) {
    foot.text(kGap, line, textScale_, fact, kInk);
    line += 3 * letter / 2;
  }
  drawBar(foot, 2 * step + kGap, letter, panelWidth_ - 2 * kGap, textScale_, panels.heat(), census);
  writer_.rows(bandOf(foot, head.height() + panelHeight_));
  writer_.finish();
}

}  // namespace solidcast
