#include "host/glsl_test/compare.h"

#include <quadmath.h>

#include <cmath>
#include <cstdio>

namespace solidcast::glsl_test {
namespace {

using f128 = __float128;
constexpr double infinity = std::numeric_limits<double>::infinity();

struct Format {
  int digits, least;  // significand bits, exponent of the smallest denormal
  f128 overflow;      // smallest magnitude that rounds to infinity
};
Format formatOf(Base base) {
  if (base == Base::f64) return {53, -1074, ldexpq(2 - ldexpq(1, -53), 1023)};
  return {24, -149, ldexpq(2 - ldexpq(1, -24), 127)};
}

bool isReal(Base base) { return base == Base::f32 || base == Base::f64; }

double errorOf(const Measure& measure, Base base, f128 got, f128 truth) {
  if (isnanq(got) || isnanq(truth)) return isnanq(got) && isnanq(truth) ? 0 : infinity;
  if (got == truth) return 0;
  if (isinfq(got) || isinfq(truth)) {
    const bool beyond = isinfq(got) && isReal(base) && fabsq(truth) >= formatOf(base).overflow;
    return beyond && (got > 0) == (truth > 0) ? 0 : infinity;
  }
  const f128 off = fabsq(got - truth);
  if (measure.kind == Measure::absoluteTo) return static_cast<double>(off / measure.unit);
  if (measure.kind == Measure::relativeTo)
    return truth == 0 ? infinity : static_cast<double>(off / (fabsq(truth) * measure.unit));
  if (!isReal(base)) return static_cast<double>(off);
  const Format format = formatOf(base);
  int exponent = format.least + 1;
  if (truth != 0) frexpq(truth, &exponent);
  return static_cast<double>(off / ldexpq(1, std::max(exponent - format.digits, format.least)));
}

std::string f128Text(f128 value) {
  char hex[80], decimal[80];
  quadmath_snprintf(hex, sizeof hex, "%Qa", value);
  quadmath_snprintf(decimal, sizeof decimal, "%.25Qg", value);
  return std::string(hex) + " (" + decimal + ")";
}

std::string shortText(double value) {
  char out[40];
  std::snprintf(out, sizeof out, "%.4g", value);
  return out;
}

}  // namespace

Measured::Measured(const Output& from) : output(from) {
  const Type type = from.type();
  numbers.width = static_cast<std::size_t>(type.width);
  for (std::size_t i = 0; i < from.count(); ++i) {
    for (int c = 0; c < type.width; ++c) numbers.values.push_back(component(type, from.element(i), c));
  }
}

Measured sum(const Output& output) {
  Measured m(output);
  Numbers sums;
  for (std::size_t i = 0; i < m.numbers.elements(); ++i) {
    f128 total = 0;
    for (std::size_t c = 0; c < m.numbers.width; ++c) total += m.numbers.values[i * m.numbers.width + c];
    sums.values.push_back(total);
  }
  m.numbers = std::move(sums);
  m.isSum = true;
  return m;
}

std::size_t Census::above(double tolerance) const {
  std::size_t n = 0;
  for (const double error : errors) n += !(error <= tolerance);
  return n;
}

std::string Census::histogram(const Measure& measure) const {
  std::string out;
  const auto line = [&](const std::string& label, std::size_t n) {
    if (n == 0) return;
    char text[120];
    std::snprintf(text, sizeof text, "    %-22s %10zu\n", label.c_str(), n);
    out += text;
  };
  line("equal", exact);
  for (const auto& [k, n] : classes) line("<= " + shortText(std::ldexp(1, k)) + " " + measure.label, n);
  line("beyond any tolerance", infinite);
  line("  NaN, number due", nan);
  line("  number, NaN due", missingNan);
  return out;
}

Census census(const Measure& measure, const Measured& got, const Numbers& truth) {
  const Numbers& numbers = got.numbers;
  if (numbers.elements() != truth.elements() || numbers.width != truth.width) {
    throw Error(Exit::usage, "\"" + got.output.name() + "\" has " + std::to_string(numbers.elements()) +
                                 " elements of " + std::to_string(numbers.width) + " components, the truth " +
                                 std::to_string(truth.elements()) + " of " + std::to_string(truth.width));
  }
  Census c;
  c.components = numbers.values.size();
  c.errors.reserve(c.components);
  for (std::size_t i = 0; i < c.components; ++i) {
    const f128 value = numbers.values[i], due = truth.values[i];
    const double error = errorOf(measure, got.output.type().base, value, due);
    c.errors.push_back(error);
    if (error == 0) {
      ++c.exact;
    } else if (std::isinf(error)) {
      ++c.infinite;
      c.nan += isnanq(value) != 0;
      c.missingNan += isnanq(due) != 0;
    } else {
      ++c.classes[static_cast<int>(std::ceil(std::log2(error)))];
    }
    if (error > c.worst) {
      c.worst = error;
      c.worstElement = i / numbers.width;
      c.worstComponent = static_cast<int>(i % numbers.width);
    }
  }
  return c;
}

testing::AssertionResult errorAtMost(const char* toleranceText, const char*, const char* gotText, const char* truthText,
                                     double tolerance, const Measure& measure, const Measured& got,
                                     const Numbers& truth) {
  const Census c = census(measure, got, truth);
  if (c.worst <= tolerance) return testing::AssertionSuccess();
  const std::size_t at = c.worstElement * got.numbers.width + static_cast<std::size_t>(c.worstComponent);
  std::string message = std::string(gotText) + " against " + truthText + ": " + std::to_string(c.above(tolerance)) +
                        " of " + std::to_string(c.components) + " differ by more than " + toleranceText + " " +
                        measure.label + "\n" + c.histogram(measure);
  message += std::isinf(c.worst)
                 ? "  no tolerance would pass\n"
                 : "  a tolerance of " + shortText(c.worst * 1.0005) + " " + measure.label + " would pass\n";
  message += "  worst: element " + std::to_string(c.worstElement);
  if (got.numbers.width > 1) message += ", component " + std::to_string(c.worstComponent);
  message += ", off by " + shortText(c.worst) + " " + measure.label + "\n";
  message += "    got   = " + (got.isSum ? f128Text(got.numbers.values[at]) + " as " : std::string()) +
             text(got.output.type(), got.output.element(c.worstElement)) + "\n";
  message += "    truth = " + f128Text(truth.values[at]) + "\n";
  message += got.output.inputsOf(c.worstElement);
  return testing::AssertionFailure() << message;
}

}  // namespace solidcast::glsl_test
