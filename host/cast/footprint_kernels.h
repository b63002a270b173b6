// What the loops of footprints.cpp and footprint_spheres.cpp share.
#pragma once
#include <cmath>

#include "host/cast/footprints.h"

namespace solidcast {

struct Slopes {
  double x0, x1, y0, y1;
};

/// The first pixel whose centre is at or beyond `from`, and the last at or before `to`, both in [0, last] or none.
template <class Number>
inline void pixels(Number from, Number to, Number last, std::int32_t& first, std::int32_t& final) {
  from = from < 0 ? 0 : from > last + 1 ? last + 1 : from;
  to = to > last ? last : to < -1 ? -1 : to;
  const auto i = static_cast<std::int32_t>(from), k = static_cast<std::int32_t>(to);
  first = i + (i < from), final = k - (k > to);
}

/// `hides`: the depth beyond which the solid hides what is behind, where `covers`.
inline void store(const Footprints::View& v, const Slopes& s, bool plain, double nearest, double hides, bool covers,
                  std::size_t i, auto& r) {
  const double x0 = s.x0 * v.perX, x1 = s.x1 * v.perX, y0 = s.y0 * v.perY, y1 = s.y1 * v.perY;
  pixels(x0 + v.lowX - 2e-9 * std::abs(x0), x1 + v.highX + 2e-9 * std::abs(x1), v.lastX, r.x0[i], r.x1[i]);
  pixels(y0 + v.lowY - 2e-9 * std::abs(y0), y1 + v.highY + 2e-9 * std::abs(y1), v.lastY, r.y0[i], r.y1[i]);
  r.nearest[i] = v.scale.begins(static_cast<float>(nearest * (1 - 1e-6)));
  const std::int32_t beyond = v.scale.ends(static_cast<float>(hides * (1 + 1e-6)));
  r.hides[i] = covers ? beyond : DepthScale::none;
  r.plain[i] = plain;
}

/// Of `count` spheres, as a batch takes them from `to` on.
void numbersOf(const Sphere* solids, std::size_t count, const Triple& origin, Footprints::Spheres& b, std::size_t to);
/// Where they are seen; with their discs; in fp64 and with what they cover. True: some sphere is farther than 16 radii.
bool ofSpheres(const Footprints::View& view, Footprints::Spheres& b);
bool ofDiscs(const Footprints::View& view, Footprints::Spheres& b);
bool ofCoveringSpheres(const Footprints::View& view, Footprints::Spheres& b);

}  // namespace solidcast
