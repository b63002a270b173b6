// Random numbers that are the same on every machine: the standard distributions are not.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "host/scene/world.h"

namespace solidcast::oracle {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// splitmix64 (Steele, Lea, Flood 2014).
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) { return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53); }
  /// From low to high, both included.
  int integer(int low, int high) { return low + static_cast<int>(bits() % static_cast<std::uint64_t>(high - low + 1)); }
  bool chance(double probability) { return uniform(0, 1) < probability; }
  double sign() { return (bits() >> 63) != 0 ? 1 : -1; }
  /// 10 to a uniformly drawn exponent.
  double decade(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  Triple inCube(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  /// Not uniform over the sphere, but everywhere: a unit vector through a point of the cube.
  Triple direction() {
    for (;;) {
      const Triple v = inCube(1);
      const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      if (length > 0.01) return {v[0] / length, v[1] / length, v[2] / length};
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace solidcast::oracle
