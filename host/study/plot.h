// The plots of the page, as SVG. Written here and not by a plotting program: errors reach from 0 to infinity and both
// ends matter, a mark's shape says what went wrong, and the program that measures needs nothing else installed.
#pragma once
#include <string>
#include <vector>

#include "host/study/study.h"

namespace solidcast::study {

/// "&" and the like made safe for HTML.
std::string escaped(const std::string& text);

/// For people: 0.5, 1.2e+05, "inf", "-" for NaN.
std::string number(double value);

/// Whether the way gave a wrong decision (or no number for t) beyond an edge: no error bound holds for it.
bool fails(const Errors& errors);

/// The error by which a way is judged: the largest, or infinity where it fails; 0 where nothing was to be hit.
double worst(const Errors& errors);

/// Of one family's rows, those that no other is both faster and more exact than.
std::vector<const Row*> paretoFront(const std::vector<const Row*>& rows);

struct Range {
  double low = 1, high = 10;
};
/// Decades that hold the times of all rows.
Range timesOf(const std::vector<const Row*>& rows);

/// Error against time: `rows` are one family's, one a way.
std::string workPrecision(const std::vector<const Row*>& rows, const std::string& title, const Range& times);

/// Error and share of wrong decisions against difficulty: `rows` are the sweep's.
std::string difficultyPlot(const Sweep& sweep, const std::vector<const Row*>& rows);

/// A mark by itself, for legends: 0 no wrong decision, 1 near an edge, 2 beyond.
std::string legendMark(int misclassification, const std::string& colour);

}  // namespace solidcast::study
