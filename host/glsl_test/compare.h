// Comparing what a GLSL function gave with the truth: a census of errors, the worst element with its inputs as hex
// floats, and the tolerance that would pass.
//
//   EXPECT_ERROR_AT_MOST(2, Measure::ulp(), call.result(), truth);
#pragma once
#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "function.h"

namespace solidcast::glsl_test {

/// What errors are counted in.
struct Measure {
  enum Kind { ulps, relativeTo, absoluteTo } kind = ulps;
  double unit = 1;
  std::string label = "ulp";
  /// Units of the last place of the output's type (fp32 or fp64) at the truth, denormals included. For int, uint and
  /// bool: the plain difference.
  static Measure ulp() { return {}; }
  /// |got - truth| / |truth| in units of `unit`, e.g. 2^-48.
  static Measure relative(double unit, std::string label) { return {relativeTo, unit, std::move(label)}; }
  /// |got - truth| in units of `unit`.
  static Measure absolute(double unit, std::string label) { return {absoluteTo, unit, std::move(label)}; }
};

/// Results as numbers, exactly. `elements` of `width` components each.
struct Numbers {
  std::vector<__float128> values;
  std::size_t width = 1;
  Numbers() = default;
  template <class T>
  Numbers(const std::vector<T>& from) {
    for (const T& element : from) append(element);
  }
  std::size_t elements() const { return values.size() / width; }

 private:
  template <class T>
  void append(const T& element) {
    if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, __float128>) {
      values.push_back(element);
    } else {
      width = element.size();
      for (const auto& c : element) values.push_back(c);
    }
  }
};

/// An output as numbers, with what messages need.
struct Measured {
  Output output;
  Numbers numbers;
  bool isSum = false;
  Measured(const Output& output);
};
/// The components of each element added up exactly: for a double-float that is returned as vec2(hi, lo).
Measured sum(const Output& output);

/// Truths made by calling f with the same arrays: truths(f, x, y)[i] = f(x[i], y[i]).
template <class F, class First, class... Rest>
auto truths(F&& f, const std::vector<First>& first, const std::vector<Rest>&... rest) {
  std::vector<decltype(f(first[0], rest[0]...))> out;
  out.reserve(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) out.push_back(f(first[i], rest[i]...));
  return out;
}

/// Errors of all components. NaN agrees with NaN alone, an infinity with itself and with truths that round to it;
/// everything else of that kind is an infinite error. -0 and 0 are the same.
struct Census {
  std::size_t components = 0, exact = 0;
  std::size_t nan = 0;                 // NaN where a number was due
  std::size_t missingNan = 0;          // a number where NaN was due
  std::map<int, std::size_t> classes;  // by k: errors in (2^(k-1), 2^k] units
  std::size_t infinite = 0;            // beyond any tolerance, NaN included
  double worst = 0;
  std::size_t worstElement = 0;
  int worstComponent = 0;
  std::size_t above(double tolerance) const;  // components with a larger error
  std::string histogram(const Measure& measure) const;

  std::vector<double> errors;  // by component
};

/// Throws Exit::usage where the truth has another number of elements or components.
Census census(const Measure& measure, const Measured& got, const Numbers& truth);

/// For EXPECT_ERROR_AT_MOST.
testing::AssertionResult errorAtMost(const char* toleranceText, const char* measureText, const char* gotText,
                                     const char* truthText, double tolerance, const Measure& measure,
                                     const Measured& got, const Numbers& truth);

}  // namespace solidcast::glsl_test

/// Passes when every component's error is at most `tolerance`. `got` is an Output or sum(Output), `truth` a vector
/// with one entry an element: numbers (float, double, __float128, ...) or std::array of them.
#define EXPECT_ERROR_AT_MOST(tolerance, measure, got, truth) \
  EXPECT_PRED_FORMAT4(::solidcast::glsl_test::errorAtMost, tolerance, measure, got, truth)
