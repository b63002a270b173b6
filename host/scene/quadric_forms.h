// Named quadrics to the ten coefficients. The gradient, and with it the normal, points away from the region around
// the axis: out of an ellipsoid, a cylinder, a cone, a paraboloid's bowl, each sheet of a hyperboloid.
#pragma once
#include <array>
#include <string_view>
#include <vector>

#include "host/scene/world.h"

namespace solidcast {

/// With p, q the two axes other than `axis` in the order x, y, z, and w along `axis`, all from the center and in radii:
struct QuadricForm {
  const char* name;
  bool usesAxisRadius;  // three radii (x, y, z), or two (the axes other than `axis`, in the order x, y, z)
  bool usesAxis;        // false for the ellipsoid
  int pp, qq, ww;       // pp p^2 + qq q^2 + ww w^2 + ...
  int q, w;             // ... + q q + w w + ...
  int constant;         // ... + constant = 0
};

inline constexpr QuadricForm kQuadricForms[] = {
    {"ellipsoid", true, false, 1, 1, 1, 0, 0, -1},
    {"cylinder", false, true, 1, 1, 0, 0, 0, -1},
    {"cone", true, true, 1, 1, -1, 0, 0, 0},
    {"paraboloid", true, true, 1, 1, 0, 0, -1, 0},
    {"hyperboloid_one_sheet", true, true, 1, 1, -1, 0, 0, -1},
    {"hyperboloid_two_sheets", true, true, 1, 1, -1, 0, 0, 1},
    {"hyperbolic_paraboloid", true, true, 1, -1, 0, 0, -1, 0},
    {"hyperbolic_cylinder", false, true, -1, 1, 0, 0, 0, 1},
    {"parabolic_cylinder", false, true, 1, 0, 0, -1, 0, 0},
};

/// The form of that name, or nullptr.
const QuadricForm* findQuadricForm(std::string_view name);

/// Coefficients in binary128, rounded once to fp64. `axis` is 0, 1, 2 for x, y, z; `mirrored` looks along the negative
/// axis. `radii` has one entry for x, y, z each; that of `axis` is not used by forms without it. Radii must be positive.
/// Where the coefficients leave 2^-100 .. 2^100 they are scaled together by a power of two: the surface stays the same.
Quadric makeQuadric(const QuadricForm& form, const Triple& center, const Triple& radii, int axis = 2,
                    bool mirrored = false);

}  // namespace solidcast
