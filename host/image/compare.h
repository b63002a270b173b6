// A census of what differs between two images: classes and counts instead of one mean, because a mean hides what
// matters (a flipped solid, one NaN) and a bare count hides how far off it is.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "host/image/reader.h"

namespace solidcast {

/// The unit of differences and of Budget::level: for two 8-bit images levels, 1/255 of full scale; else the numbers
/// themselves (an 8-bit image beside a float one counts as v/255).
enum class Unit { levels, values };

struct Budget {
  std::int64_t differing = 0;  // so many pixels may differ by more than `level`
  double level = 0;            // a pixel differs when any of its channels differs by more than this
};

/// Hits of one side beside its colours; both spans hold one number a pixel.
struct HitChannels {
  std::span<const float> distance;      // +inf: miss
  std::span<const std::int32_t> solid;  // -1: miss
};

struct WorstPixel {
  int x = -1, y = -1;  // -1: no pixel
  std::vector<double> a, b;
  double difference = 0;
};

struct HitCensus {
  std::int64_t hitMissFlips = 0, solidFlips = 0;  // hit on one side only; another solid on each side
  std::int64_t bothHit = 0;                       // the same solid on both sides: only these count for t
  std::int64_t maxUlp = 0, p99Ulp = 0;            // of t, in units of its last place in float32
  int worstX = -1, worstY = -1;                   // where maxUlp is
};

struct Census {
  int width = 0, height = 0;
  Unit unit = Unit::levels;
  Budget budget;
  std::int64_t pixels = 0, equal = 0, within = 0, beyond = 0;  // of the budget's level
  std::int64_t nanA = 0, nanB = 0, infA = 0, infB = 0;         // pixels with such a channel
  double maxError = 0;   // +inf where one side is NaN or infinite and the other is not the same
  double maxFinite = 0;  // the largest difference but +inf
  double meanError = 0;  // over all channels of all pixels, where both are finite
  double psnr = 0;       // dB, of the finite ones; +inf when they are equal. The peak is `peak`.
  double peak = 255;     // 255 for levels, else the largest finite magnitude in b, 1 if there is none
  WorstPixel worst;
  double passingLevel = 0;  // least level that would keep budget.differing; +inf if none does. `beyond` is the least
                            // number of pixels that would keep budget.level.
  bool hasHits = false;
  HitCensus hits;

  bool pass() const { return beyond <= budget.differing; }
};

/// NaN equals NaN, an infinity equals itself; else they differ by +inf from everything. A missing fourth channel counts
/// as opaque, one channel beside three counts as grey. Throws Error(Exit::usage) when the sizes differ, naming both.
Census compareImages(const Image& a, const Image& b, const Budget& budget);

/// The flips and the errors of t. The spans of both sides must have the same size.
HitCensus compareHits(const HitChannels& a, const HitChannels& b, int width);

/// Difference of each pixel (its worst channel) in `unit`, row after row: what the heat map shows.
double pixelDifference(const Image& a, const Image& b, std::size_t pixel);

/// Lines of text for people, aligned, without the last line's end.
std::string censusText(const Census& census);

/// "1 level", "0.25".
std::string withUnit(double difference, Unit unit);

/// Four digits: 3, 0.25, 1.234e-07, inf, nan.
std::string brief(double value);

}  // namespace solidcast
