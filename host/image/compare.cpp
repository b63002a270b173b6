#include "host/image/compare.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

#include "host/error.h"

namespace solidcast {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Unit unitOf(const Image& a, const Image& b) { return a.isFloat() || b.isFloat() ? Unit::values : Unit::levels; }

/// Channels of one pixel, as the comparison sees them.
struct Pixel {
  std::array<double, 4> value;
  int channels;
};

/// `channels` may be more than the image has: grey is repeated, a missing fourth is opaque.
Pixel pixelOf(const Image& image, std::size_t index, int channels, Unit unit) {
  Pixel pixel{{}, channels};
  const auto at = [&](int channel) -> double {
    const std::size_t place = index * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(channel);
    if (image.isFloat()) return std::get<1>(image.values)[place];
    const double level = std::get<0>(image.values)[place];
    return unit == Unit::levels ? level : level / 255;
  };
  for (int i = 0; i < channels; ++i) {
    if (i < image.channels) pixel.value[i] = at(i);
    else pixel.value[i] = i == 3 ? (unit == Unit::levels ? 255 : 1) : at(0);
  }
  return pixel;
}

double difference(double a, double b) {
  if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
  const double distance = std::fabs(a - b);
  return std::isnan(distance) ? kInfinity : distance;
}

double difference(const Pixel& a, const Pixel& b) {
  double worst = 0;
  for (int i = 0; i < a.channels; ++i) worst = std::max(worst, difference(a.value[i], b.value[i]));
  return worst;
}

bool any(const Pixel& pixel, bool (*is)(double)) {
  return std::any_of(pixel.value.begin(), pixel.value.begin() + pixel.channels, is);
}
bool isNan(double value) { return std::isnan(value); }
bool isInf(double value) { return std::isinf(value); }

/// The (rank + 1)th largest of the differences, of which zeros are left out.
double ranked(std::vector<double>& differences, std::int64_t rank) {
  if (rank >= static_cast<std::int64_t>(differences.size())) return 0;
  const auto place = differences.begin() + rank;
  std::nth_element(differences.begin(), place, differences.end(), std::greater<>());
  return *place;
}

/// Floats as integers in their order, so that neighbours differ by 1.
std::int64_t ordered(float value) {
  const auto bits = std::bit_cast<std::int32_t>(value);
  return bits >= 0 ? bits : std::int64_t{std::numeric_limits<std::int32_t>::min()} - bits;
}

}  // namespace

Census compareImages(const Image& a, const Image& b, const Budget& budget) {
  const auto size = [](const Image& image) { return std::to_string(image.width) + "x" + std::to_string(image.height); };
  if (a.width != b.width || a.height != b.height)
    throw Error(Exit::usage, "the images' sizes differ: " + size(a) + " and " + size(b));

  Census census;
  census.width = a.width;
  census.height = a.height;
  census.unit = unitOf(a, b);
  census.budget = budget;
  census.pixels = static_cast<std::int64_t>(a.width) * a.height;
  const int channels = std::max(a.channels, b.channels);

  double sum = 0, squares = 0, largest = 0;
  std::int64_t finite = 0;
  std::vector<double> differences;  // of the pixels that are not equal
  for (std::int64_t i = 0; i < census.pixels; ++i) {
    const Pixel pa = pixelOf(a, static_cast<std::size_t>(i), channels, census.unit);
    const Pixel pb = pixelOf(b, static_cast<std::size_t>(i), channels, census.unit);
    if (any(pa, isNan)) ++census.nanA;
    if (any(pb, isNan)) ++census.nanB;
    if (any(pa, isInf)) ++census.infA;
    if (any(pb, isInf)) ++census.infB;
    for (int c = 0; c < channels; ++c) {
      if (!std::isfinite(pa.value[c]) || !std::isfinite(pb.value[c])) continue;
      const double error = std::fabs(pa.value[c] - pb.value[c]);
      sum += error;
      squares += error * error;
      largest = std::max(largest, std::fabs(pb.value[c]));
      ++finite;
    }
    const double worst = difference(pa, pb);
    if (worst == 0) {
      ++census.equal;
      continue;
    }
    ++(worst > budget.level ? census.beyond : census.within);
    differences.push_back(worst);
    if (std::isfinite(worst)) census.maxFinite = std::max(census.maxFinite, worst);
    if (worst > census.worst.difference)
      census.worst = {static_cast<int>(i % a.width),
                      static_cast<int>(i / a.width),
                      {pa.value.begin(), pa.value.begin() + channels},
                      {pb.value.begin(), pb.value.begin() + channels},
                      worst};
  }
  census.maxError = census.worst.difference;
  census.meanError = finite > 0 ? sum / static_cast<double>(finite) : 0;
  if (census.unit == Unit::values) census.peak = largest > 0 ? largest : 1;
  census.psnr =
      squares > 0 ? 20 * std::log10(census.peak) - 10 * std::log10(squares / static_cast<double>(finite)) : kInfinity;
  census.passingLevel = ranked(differences, budget.differing);
  return census;
}

double pixelDifference(const Image& a, const Image& b, std::size_t pixel) {
  const int channels = std::max(a.channels, b.channels);
  const Unit unit = unitOf(a, b);
  return difference(pixelOf(a, pixel, channels, unit), pixelOf(b, pixel, channels, unit));
}

HitCensus compareHits(const HitChannels& a, const HitChannels& b, int width) {
  HitCensus census;
  std::vector<std::int64_t> ulps;
  for (std::size_t i = 0; i < a.solid.size(); ++i) {
    const bool hitA = a.solid[i] >= 0, hitB = b.solid[i] >= 0;
    if (hitA != hitB) ++census.hitMissFlips;
    if (hitA && hitB && a.solid[i] != b.solid[i]) ++census.solidFlips;
    if (!hitA || !hitB || a.solid[i] != b.solid[i]) continue;
    ++census.bothHit;
    const std::int64_t ulp = std::abs(ordered(a.distance[i]) - ordered(b.distance[i]));
    ulps.push_back(ulp);
    if (ulp <= census.maxUlp && census.worstX >= 0) continue;
    census.maxUlp = ulp;
    census.worstX = static_cast<int>(i % static_cast<std::size_t>(width));
    census.worstY = static_cast<int>(i / static_cast<std::size_t>(width));
  }
  if (ulps.empty()) return census;
  const auto p99 = ulps.begin() + static_cast<std::ptrdiff_t>((ulps.size() - 1) * 99 / 100);
  std::nth_element(ulps.begin(), p99, ulps.end());
  census.p99Ulp = *p99;
  return census;
}

}  // namespace solidcast
