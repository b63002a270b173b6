// What both tests of the oracle are written with.
#pragma once
#include <vector>

#include "host/oracle/oracle.h"

namespace solidcast::oracle {

inline double relative(Real a, Real b) {
  return a == b ? 0 : static_cast<double>(fabsq(a - b) / fmaxq(fabsq(a), fabsq(b)));
}

inline World worldOf(const std::vector<Shape>& shapes) {
  World world;
  for (const Shape& shape : shapes) {
    world.groups[0].members.push_back({false, static_cast<std::uint32_t>(world.solids.size())});
    world.solids.push_back({"", shape, 0});
  }
  return world;
}

}  // namespace solidcast::oracle
