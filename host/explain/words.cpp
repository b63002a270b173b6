#include "host/explain/words.h"

#include <cstdio>

#include "host/cast/records.h"

namespace solidcast::explain {
namespace {

std::string printed(const char* format, f128 x) {
  char text[64];
  quadmath_snprintf(text, sizeof text, format, x);
  return text;
}

}  // namespace

std::string solidName(const World& world, std::int32_t index) {
  if (index < 0) return "nothing";
  const SolidEntry solid = world.solids[static_cast<std::size_t>(index)];
  return solid.name.empty() ? std::string(kindLabel(kindNumber(solid.shape))) + " " + std::to_string(index)
                            : solid.name;
}

std::string decimal(f128 x) { return printed("%.18Qg", x); }
std::string brief(f128 x) { return printed("%.3Qg", x); }

std::string hex(f128 x) {
  char text[64];
  std::snprintf(text, sizeof text, "%a", static_cast<double>(x));
  return text;
}

}  // namespace solidcast::explain
