// The census for people: one fact a line, counts in a column.
#include <charconv>
#include <cmath>
#include <cstdio>

#include "host/image/compare.h"

namespace solidcast {
namespace {

std::string row(const char* name, const std::string& value) {
  char line[32];
  std::snprintf(line, sizeof line, "%-20s", name);
  return line + value + "\n";
}

std::string count(std::int64_t number, std::int64_t of) {
  char text[64];
  std::snprintf(text, sizeof text, "%12lld   %.6g %%", static_cast<long long>(number),
                100.0 * static_cast<double>(number) / static_cast<double>(of));
  return text;
}

std::string place(int x, int y) { return std::to_string(x) + "," + std::to_string(y); }

std::string tuple(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) {
    char number[32];
    std::snprintf(number, sizeof number, "%.9g", value);
    text += (text.empty() ? "" : ", ") + std::string(number);
  }
  return "(" + text + ")";
}

/// As few digits as give the same number when read again: a limit must not be rounded down.
std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string pixels(std::int64_t number) { return std::to_string(number) + (number == 1 ? " pixel" : " pixels"); }

std::string hitText(const Census& census) {
  const HitCensus& hits = census.hits;
  std::string text = row("hit/miss flips", count(hits.hitMissFlips, census.pixels)) +
                     row("solid flips", count(hits.solidFlips, census.pixels));
  if (hits.bothHit == 0) return text + row("error of t", "no pixel where both hit the same solid");
  return text +
         row("error of t", "at most " + std::to_string(hits.maxUlp) + " ulp (pixel " + place(hits.worstX, hits.worstY) +
                               "), 99 % at most " + std::to_string(hits.p99Ulp) + " ulp");
}

}  // namespace

std::string brief(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string withUnit(double difference, Unit unit) {
  if (unit == Unit::values) return brief(difference);
  return brief(difference) + (difference == 1 ? " level" : " levels");
}

std::string censusText(const Census& census) {
  const Unit unit = census.unit;
  const std::string level = withUnit(census.budget.level, unit);
  std::string text = row("size", std::to_string(census.width) + "x" + std::to_string(census.height)) +
                     row("equal", count(census.equal, census.pixels)) +
                     row("within tolerance", count(census.within, census.pixels) + "   differ by at most " + level) +
                     row("beyond tolerance", count(census.beyond, census.pixels) + "   differ by more than " + level);
  if (census.nanA + census.nanB > 0) text += row("NaN", "A " + pixels(census.nanA) + ", B " + pixels(census.nanB));
  if (census.infA + census.infB > 0) text += row("infinite", "A " + pixels(census.infA) + ", B " + pixels(census.infB));
  if (census.hasHits) text += hitText(census);
  if (census.worst.x >= 0)
    text += row("worst pixel", place(census.worst.x, census.worst.y) + "   A " + tuple(census.worst.a) + "   B " +
                                   tuple(census.worst.b));
  text +=
      row("error", "max " + withUnit(census.maxError, unit) + ", mean " + brief(census.meanError) + ", PSNR " +
                       brief(census.psnr) + " dB" + (unit == Unit::values ? " (peak " + brief(census.peak) + ")" : ""));
  const std::string byCount =
      "--max-differing " + std::to_string(census.beyond) + " --max-level " + shortest(census.budget.level);
  const std::string byLevel =
      "--max-differing " + std::to_string(census.budget.differing) + " --max-level " + shortest(census.passingLevel);
  const bool both = std::isfinite(census.passingLevel) && byCount != byLevel;
  if (!census.pass()) text += row("would pass", both ? byCount + ", or " + byLevel : byCount);
  text += row("budget",
              pixels(census.budget.differing) + " beyond " + level + ": " + (census.pass() ? "kept" : "exceeded"));
  text.pop_back();
  return text;
}

}  // namespace solidcast
