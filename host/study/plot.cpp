#include "host/study/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace solidcast::study {
namespace {

std::string format(const char* how, ...) __attribute__((format(printf, 1, 2)));
std::string format(const char* how, ...) {
  char buffer[1024];
  va_list arguments;
  va_start(arguments, how);
  std::vsnprintf(buffer, sizeof buffer, how, arguments);
  va_end(arguments);
  return buffer;
}

constexpr double kLeastUlp = -1, kMostUlp = 9;  // log10; beyond lies the lane of infinity

/// Places of errors on an axis from `start` to `end` (pixels): ten decades and a lane for infinity.
struct UlpAxis {
  double start, end;
  double at(double ulps) const {
    if (!std::isfinite(ulps)) return start + (end - start) * 10.6 / 11;
    const double exponent = ulps > 0 ? std::clamp(std::log10(ulps), kLeastUlp, kMostUlp) : kLeastUlp;
    return start + (end - start) * (exponent - kLeastUlp) / 11;
  }
};

struct LogAxis {
  double start, end, low, high;  // pixels; values
  double at(double value) const {
    const double part = std::log(std::clamp(value, low, high) / low) / std::log(high / low);
    return start + (end - start) * part;
  }
};

std::string text(double x, double y, const char* anchor, const std::string& what, const char* style = "tick") {
  return format("<text class=\"%s\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\">", style, x, y, anchor) + what + "</text>";
}
std::string line(double x1, double y1, double x2, double y2, const char* style) {
  return format("<line class=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>", style, x1, y1, x2, y2);
}

std::string power(int exponent) {
  if (exponent == 0) return "1";
  if (exponent == 1) return "10";
  return "10<tspan class=\"power\" dy=\"-4\">" + std::string(exponent < 0 ? "&#8722;" : "") +
         std::to_string(std::abs(exponent)) + "</tspan>";
}

std::string mark(double x, double y, int misclassification, const std::string& colour) {
  if (misclassification == 0)
    return format("<circle class=\"mark\" cx=\"%.1f\" cy=\"%.1f\" r=\"5.2\" fill=\"%s\"/>", x, y, colour.c_str());
  if (misclassification == 1)
    return format("<path class=\"mark\" d=\"M%.1f %.1fl6.4 11h-12.8z\" fill=\"%s\"/>", x, y - 7, colour.c_str());
  const std::string cross = format("M%.1f %.1fl10 10m0 -10l-10 10", x - 5, y - 5);
  return "<path class=\"crossback\" d=\"" + cross + "\"/><path class=\"cross\" d=\"" + cross + "\" stroke=\"" + colour +
         "\"/>";
}

int misclassification(const Errors& e) { return fails(e) ? 2 : e.wrong() > 0 ? 1 : 0; }

std::string tooltip(const Row& row) {
  const Errors& e = row.errors;
  std::string t = std::string(kWays[row.way].label) + ": error of t p50 " + number(e.p50) + ", p99 " + number(e.p99) +
                  ", p99.9 " + number(e.p999) + ", max " + number(e.max) + " ulp over " + std::to_string(e.agreedHits) +
                  " hits; " + std::to_string(e.misses) + " misses, " + std::to_string(e.falseHits) + " false hits, " +
                  std::to_string(e.otherSolid) + " wrong solids of " + std::to_string(e.rays) + " rays";
  if (row.timing.runs > 0)
    t += "; " + number(row.timing.median) + " ns (" + number(row.timing.quarter) + " to " +
         number(row.timing.threeQuarters) + ")";
  return "<title>" + escaped(t) + "</title>";
}

const std::string& colourOf(const Row& row) {
  static const std::vector<std::string> colours = [] {
    std::vector<std::string> all;
    for (const Way& way : kWays) all.emplace_back(way.colour);
    return all;
  }();
  return colours[row.way];
}

std::string opening(int width, int height, const std::string& title) {
  return format("<svg class=\"plot\" viewBox=\"0 0 %d %d\" role=\"img\">", width, height) +
         text(8, 16, "start", escaped(title), "title");
}

/// Lines and numbers of an axis of errors: across for the horizontal one, along for the vertical one.
std::string ulpGrid(const UlpAxis& axis, double from, double to, bool horizontal) {
  std::string s;
  for (int e = -1; e <= 9; ++e) {
    const double at = axis.at(std::pow(10, e));
    const char* style = e == 0 ? "one" : "grid";
    s += horizontal ? line(at, from, at, to, style) : line(from, at, to, at, style);
    if (e % 2 == 0) s += horizontal ? text(at, to + 14, "middle", power(e)) : text(from - 5, at + 4, "end", power(e));
  }
  const double infinite = axis.at(INFINITY);
  s += horizontal ? line(infinite, from, infinite, to, "lane") : line(from, infinite, to, infinite, "lane");
  s += horizontal ? text(infinite, to + 14, "middle", "&#8734;") : text(from - 5, infinite + 4, "end", "&#8734;");
  return s;
}

}  // namespace

std::string escaped(const std::string& raw) {
  std::string safe;
  for (const char c : raw)
    safe += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
  return safe;
}

std::string number(double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return "inf";
  return format(std::fabs(value) >= 1e5 || (value != 0 && std::fabs(value) < 1e-3) ? "%.1e" : "%.3g", value);
}

bool fails(const Errors& e) { return e.wrongBeyond > 0 || e.notFinite > 0 || std::isinf(e.max); }

double worst(const Errors& e) {
  if (fails(e)) return INFINITY;
  if (e.agreedHits > 0) return e.max;
  return e.wrong() > 0 ? INFINITY : 0;
}

std::vector<const Row*> paretoFront(const std::vector<const Row*>& rows) {
  std::vector<const Row*> front;
  for (const Row* a : rows) {
    const bool beaten = std::any_of(rows.begin(), rows.end(), [&](const Row* b) {
      const double ea = worst(a->errors), eb = worst(b->errors), ta = a->timing.median, tb = b->timing.median;
      return eb <= ea && tb <= ta && (eb < ea || tb < ta);
    });
    if (!beaten) front.push_back(a);
  }
  std::sort(front.begin(), front.end(), [](auto a, auto b) { return worst(a->errors) < worst(b->errors); });
  return front;
}

Range timesOf(const std::vector<const Row*>& rows) {
  double low = INFINITY, high = 0;
  for (const Row* row : rows) {
    if (row->timing.runs == 0) continue;
    low = std::min(low, row->timing.quarter), high = std::max(high, row->timing.threeQuarters);
  }
  if (!(high > 0)) return {};
  // To 1, 2 or 5 times a power of ten, so that the numbers on the axis are short.
  const auto down = [](double v) {
    const double decade = std::pow(10, std::floor(std::log10(v))), part = v / decade;
    return decade * (part >= 5 ? 5 : part >= 2 ? 2 : 1);
  };
  const double above = down(high * 1.05);
  return {down(low * 0.95), above / std::pow(10, std::floor(std::log10(above) + 1e-9)) > 4 ? above * 2 : above * 2.5};
}

std::string workPrecision(const std::vector<const Row*>& rows, const std::string& title, const Range& times) {
  constexpr double left = 44, right = 352, top = 28, bottom = 206;
  const UlpAxis x{left, right};
  const LogAxis y{bottom, top, times.low, times.high};
  std::string s = opening(360, 246, title) + ulpGrid(x, top, bottom, true);
  for (double decade = std::pow(10, std::floor(std::log10(times.low))); decade <= times.high; decade *= 10)
    for (const double step : {1, 2, 5}) {
      const double v = decade * step;
      if (v < times.low * 0.999 || v > times.high * 1.001) continue;
      s += line(left, y.at(v), right, y.at(v), "grid") + text(left - 5, y.at(v) + 4, "end", number(v));
    }
  s += text((left + right) / 2, 240, "middle", "error of t, ulp", "label");
  s += format(
      "<text class=\"label\" transform=\"translate(11 %.0f) rotate(-90)\" text-anchor=\"middle\">ns per test</text>",
      (top + bottom) / 2);

  const std::vector<const Row*> front = paretoFront(rows);
  std::string path;
  for (const Row* row : front) {
    const double px = x.at(worst(row->errors)), py = y.at(row->timing.median);
    path += path.empty() ? format("M%.1f %.1f", px, top) + format("V%.1f", py) : format("H%.1fV%.1f", px, py);
  }
  if (!path.empty()) s += "<path class=\"front\" d=\"" + path + format("H%.1f", right) + "\"/>";

  for (const Row* row : rows) {
    const Errors& e = row->errors;
    const std::string& colour = colourOf(*row);
    const double py = y.at(row->timing.median), end = x.at(worst(e));
    s += "<g class=\"way\">" + tooltip(*row);
    if (e.agreedHits > 0) {
      s += format("<line class=\"reach\" stroke=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>",
                  colour.c_str(), x.at(e.p50), py, end, py);
      for (const auto& [value, radius] : {std::pair{e.p50, 2.0}, {e.p99, 2.6}, {e.p999, 3.2}})
        s +=
            format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/>", x.at(value), py, radius, colour.c_str());
    }
    s += format("<line class=\"spread\" stroke=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>",
                colour.c_str(), end, y.at(row->timing.quarter), end, y.at(row->timing.threeQuarters));
    s += mark(end, py, misclassification(e), colour);
    // Letters of neighbours on opposite sides, so that they stay apart where the marks do not.
    const bool below = row->way % 2 == 1;
    s += format("<text class=\"letter\" fill=\"%s\" x=\"%.1f\" y=\"%.1f\" text-anchor=\"middle\">%c</text></g>",
                colour.c_str(), end + (below ? -11 : 11), py + (below ? 12 : -4), kWays[row->way].letter);
  }
  return s + "</svg>";
}

std::string difficultyPlot(const Sweep& sweep, const std::vector<const Row*>& rows) {
  constexpr double left = 58, right = 350, top = 28, middle = 176, upper = 192, bottom = 262;
  const UlpAxis y{middle, top};
  double low = INFINITY, high = 0;
  for (const double v : sweep.values) low = std::min(low, v), high = std::max(high, v);
  const LogAxis x =
      sweep.smallerIsHarder ? LogAxis{right - 10, left + 10, low, high} : LogAxis{left + 10, right - 10, low, high};
  // Shares from 1e-5 up; 0 has a line of its own at the bottom.
  const LogAxis share{bottom - 10, upper, 1e-5, 1};
  const auto shareAt = [&](double v) { return v > 0 ? share.at(v) : bottom; };

  std::string s = opening(360, 306, sweep.title) + ulpGrid(y, left, right, false);
  for (int e = -5; e <= 0; ++e) {
    s += line(left, share.at(std::pow(10, e)), right, share.at(std::pow(10, e)), "grid");
    if (e % 2 == 0) s += text(left - 5, share.at(std::pow(10, e)) + 4, "end", number(100 * std::pow(10, e)) + " %");
  }
  s += line(left, bottom, right, bottom, "axis") + text(left - 5, bottom + 4, "end", "0");
  for (const double v : sweep.values) {
    const int e = static_cast<int>(std::lround(std::log10(v)));
    s += line(x.at(v), top, x.at(v), middle, "grid") + line(x.at(v), upper, x.at(v), bottom, "grid");
    if (e % 2 == 0 || sweep.values.size() < 6) s += text(x.at(v), bottom + 14, "middle", power(e));
  }
  s += text((left + right) / 2, 296, "middle", escaped(sweep.axis) + ", harder &#8594;", "label");
  s += format(
      "<text class=\"label\" transform=\"translate(11 %.0f) rotate(-90)\" text-anchor=\"middle\">error of t, "
      "ulp</text>",
      (top + middle) / 2);
  s += format("<text class=\"label\" transform=\"translate(11 %.0f) rotate(-90)\" text-anchor=\"middle\">wrong</text>",
              (upper + bottom) / 2);

  for (std::size_t way = 0; way < kWayCount; ++way) {
    // The first of two that lie on each other is larger, so that it shows around the second.
    const double size = way % 2 == 0 ? 4.6 : 2.6, breadth = way % 2 == 0 ? 5 : 1.8;
    std::string p99, most, wrong, marks;
    for (const double v : sweep.values)
      for (const Row* row : rows) {
        if (row->way != way || row->difficulty != v) continue;
        const Errors& e = row->errors;
        const double px = x.at(v);
        const auto to = [&](std::string& path, double py) {
          path += format("%s%.1f %.1f", path.empty() ? "M" : "L", px, py);
        };
        if (e.agreedHits > 0) to(p99, y.at(e.p99)), to(most, y.at(e.max));
        to(wrong, shareAt(e.wrongShare()));
        marks += "<g>" + tooltip(*row) +
                 (e.agreedHits > 0 ? format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/>", px, y.at(e.p99),
                                            size, kWays[way].colour)
                                   : "");
        marks += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\" fill=\"%s\"/></g>", px, shareAt(e.wrongShare()),
                        size, kWays[way].colour);
      }
    if (marks.empty()) continue;
    const std::string stroke = format(" stroke=\"%s\" stroke-width=\"%.1f\"", kWays[way].colour, breadth);
    if (!p99.empty())
      s += "<path class=\"curve\"" + stroke + " d=\"" + p99 + "\"/><path class=\"curve most\"" + stroke + " d=\"" +
           most + "\"/>";
    s += "<path class=\"curve\"" + stroke + " d=\"" + wrong + "\"/>" + marks;
  }
  return s + "</svg>";
}

std::string legendMark(int misclassification, const std::string& colour) {
  return "<svg class=\"key\" viewBox=\"0 0 16 16\">" + mark(8, 8, misclassification, colour) + "</svg>";
}

}  // namespace solidcast::study
