// A box that holds a solid, for the index: closed, in fp64, wider than the truth by more than its own rounding.
#pragma once
#include <optional>

#include "host/scene/world.h"

namespace solidcast {

struct Bounds {
  Triple lo, hi;
};

/// Nothing for a solid without an end: infinite planes, quadrics that are no ellipsoids (or so nearly none that binary128
/// cannot tell), and whatever reaches beyond 2^100, where fp32 has no room for differences and their products.
std::optional<Bounds> boundsOf(ShapeRef shape);

/// The same, wider by 2^-24, in a fiftieth of the time.
std::optional<Bounds> quickBounds(const Quadric& quadric);

}  // namespace solidcast
