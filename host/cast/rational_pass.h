// The last word on free rays: where even binary128 is too near to a decision (a direction with a denormal component
// passes an edge by 1e-45 of its length), exact rationals decide. Rays of pixels have irrational directions: they have
// no such word, and need none.
#pragma once
#include <optional>

#include "host/cast/solids/forms.h"

namespace solidcast {

/// The smallest t > 0 at which the ray meets the solid, decided exactly; t is right to binary128's last places. The
/// ray's numbers must be fp32 or fp64 numbers.
Cut rationalCut(const Shape& shape, const RayQ& ray);

/// Sign of t(a) - t(b) of two solids that the ray hits: -1, 0 or 1, exactly.
int rationalOrder(const Shape& a, const Shape& b, const RayQ& ray);

/// The same of t(shape) - limit.
int rationalOrder(const Shape& shape, double limit, const RayQ& ray);

/// The axis of the face by which the ray enters a box or, `entering` false, leaves it; the lowest of several.
int rationalFace(const AABox& box, const RayQ& ray, bool entering);

}  // namespace solidcast
