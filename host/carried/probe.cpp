#include "host/carried/probe.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>

#include "host/carried/carried.h"

namespace solidcast::gpu {
namespace {

template <class Real>
struct Traits;
template <>
struct Traits<float> {
  using Bits = std::uint32_t;
  static constexpr const char* module = "probe_f32";
  static constexpr std::uint32_t splitter = (1u << 12) + 1;
  static constexpr int moderateExponent = 20;  // products' errors stay normal numbers
};
template <>
struct Traits<double> {
  using Bits = std::uint64_t;
  static constexpr const char* module = "probe_f64";
  static constexpr std::uint32_t splitter = (1u << 27) + 1;
  static constexpr int moderateExponent = 200;
};

// The two structs of shaders/probe.comp.
template <class Real>
struct Case {
  Real a, b, c, unused;
};
template <class Real>
struct Outcome {
  Real fusedProduct, productPlus, quotient, root, product, sum, difference, sumError, productError, unused[3];
};

template <class Real>
bool same(Real x, Real y) {
  if (std::isnan(x) || std::isnan(y)) return std::isnan(x) && std::isnan(y);
  using Bits = typename Traits<Real>::Bits;
  return std::bit_cast<Bits>(x) == std::bit_cast<Bits>(y);
}

template <class Real>
bool denormal(Real x) {
  return std::fpclassify(x) == FP_SUBNORMAL;
}

/// Steps between neighbouring numbers from x to y; infinite where one is NaN and the other is not.
template <class Real>
double ulps(Real x, Real y) {
  if (same(x, y)) return 0;
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::infinity();
  // Negative numbers count downwards, so that neighbours are neighbours through zero.
  using Signed = std::make_signed_t<typename Traits<Real>::Bits>;
  const auto place = [](Real value) {
    const auto bits = std::bit_cast<Signed>(value);
    return bits < 0 ? -double(bits & std::numeric_limits<Signed>::max()) : double(bits);
  };
  return std::max(1.0, std::abs(place(x) - place(y)));
}

template <class Real>
std::vector<Case<Real>> makeCases(int count) {
  using Bits = typename Traits<Real>::Bits;
  std::mt19937_64 random(20201119);
  std::uniform_int_distribution<int> exponent(-Traits<Real>::moderateExponent, Traits<Real>::moderateExponent);
  std::uniform_real_distribution<Real> significand(1, 2);
  const auto moderate = [&] {
    const Real value = std::ldexp(significand(random), exponent(random));
    return random() & 1 ? -value : value;
  };
  const auto any = [&] { return std::bit_cast<Real>(Bits(random())); };
  // Exponents drawn at random hardly ever give denormals: one case in sixteen has one on purpose.
  const auto tiny = [&] { return std::numeric_limits<Real>::min() * (significand(random) - 1); };
  std::vector<Case<Real>> cases;
  for (int i = 0; i < count; ++i) {
    if (i % 2 == 0) {
      cases.push_back({moderate(), moderate(), moderate(), 0});
    } else if (i % 16 == 1) {
      cases.push_back({tiny(), moderate(), tiny(), 0});
    } else if (i % 16 == 3) {  // normal operands, denormal product and quotient
      const Real small = std::ldexp(significand(random), std::numeric_limits<Real>::min_exponent + 8);
      cases.push_back({small, std::ldexp(significand(random), i % 32 == 3 ? -20 : 20), small, 0});
    } else {
      cases.push_back({any(), any(), any(), 0});
    }
  }
  return cases;
}

template <class Real>
ArithmeticReport probe(Device& device) {
  constexpr int count = 1 << 16, perGroup = 64;
  const std::vector<Case<Real>> cases = makeCases<Real>(count);
  Buffer in = device.makeBuffer(cases.size() * sizeof cases[0], BufferUse::storage);
  Buffer out = device.makeBuffer(cases.size() * sizeof(Outcome<Real>), BufferUse::readback);
  std::memcpy(in.bytes().data(), cases.data(), in.bytes().size());
  const Pipeline pipeline = device.makePipeline(carriedModule(Traits<Real>::module));
  const std::uint32_t splitter = Traits<Real>::splitter;
  const Dispatch dispatch{&pipeline, {&in, &out}, std::as_bytes(std::span(&splitter, 1)), {count / perGroup, 1, 1}};
  device.run({&dispatch, 1});

  ArithmeticReport report;
  report.cases = count;
  report.denormalInputs = report.denormalResults = true;
  report.uncontracted = report.precise = report.twoSum = report.twoProduct = true;
  bool fused = true, rounded = true;
  const auto outcomes = out.as<Outcome<Real>>();
  for (int i = 0; i < count; ++i) {
    const auto [a, b, c, unused] = cases[i];
    const Outcome<Real>& got = outcomes[i];
    const bool moderate = i % 2 == 0, denormalOperand = denormal(a) || denormal(b);
    const auto compare = [&](Real device, Real truth, double& worst) {
      if (denormalOperand) {
        report.denormalInputs &= same(device, truth);
      } else if (denormal(truth)) {
        report.denormalResults &= same(device, truth);
      } else {
        worst = std::max(worst, ulps(device, truth));
      }
    };
    const Real product = a * b, sum = a + b;
    compare(got.quotient, a / b, report.divisionUlp);
    compare(got.root, std::sqrt(a), report.rootUlp);
    compare(got.product, product, report.productUlp);
    compare(got.sum, sum, report.sumUlp);
    if (!moderate) continue;
    fused &= same(got.fusedProduct, std::fma(a, b, c));
    rounded &= same(got.fusedProduct, product + c);
    report.uncontracted &= same(got.productPlus, product + c);
    report.precise &= same(got.difference, sum - a);
    // Of the larger operand nothing is lost in a subtraction: this is the exact error.
    const Real error = std::abs(a) >= std::abs(b) ? b - (sum - a) : a - (sum - b);
    report.twoSum &= same(got.sumError, error);
    report.twoProduct &= same(got.productError, std::fma(a, b, -product));
  }
  report.fma = fused ? "fused" : rounded ? "not fused" : "mixed";
  return report;
}

}  // namespace

ArithmeticReport probeArithmetic(Device& device, bool float64) {
  return float64 ? probe<double>(device) : probe<float>(device);
}

std::uint32_t loopIterations(Device& device, std::uint32_t wanted) {
  Buffer count = device.makeBuffer(sizeof(std::uint32_t), BufferUse::readback);
  const Pipeline pipeline = device.makePipeline(carriedModule("probe_loop"));
  const Dispatch dispatch{&pipeline, {&count}, std::as_bytes(std::span(&wanted, 1)), {1, 1, 1}};
  device.run({&dispatch, 1});
  return count.as<std::uint32_t>()[0];
}

}  // namespace solidcast::gpu
