// Which quadrics are bounded, and the size of those that are: bounding box, axes, area, and a uniform choice of points.
// In binary128 whatever the caller's number type: the coefficients are fp64 and the question "is this determinant
// zero" must not depend on the precision that a picture is rendered with.
#pragma once
#include <array>
#include <optional>

#include "reference_cpu/vec.h"

namespace solidcast::reference {

using Quadruple = __float128;
using QuadricCoefficients = std::array<double, 10>;  // a..j as in the plain scene description

/// A quadric whose quadratic part is definite: an ellipsoid, a point (size 0) or nothing (`empty`).
struct BoundedQuadric {
  bool empty = false;
  Vec<Quadruple> center, halfExtents;  // of the bounding box, which touches the surface on all sides
};

/// With M the matrix of the quadratic part, l half the linear one and k = l.M^-1 l - j, the surface is
/// (p - c).M (p - c) = k around c = -M^-1 l; the box reaches sqrt(k (M^-1)_ii) along axis i.
/// Nothing when the surface has no bounds. A minor below its rounding error counts as zero, which is: no bounds.
std::optional<BoundedQuadric> boundedQuadric(const QuadricCoefficients& coefficients);

struct EllipsoidAxes {
  Vec<Quadruple> center;
  std::array<Quadruple, 3> semiAxes;         // from the longest to the shortest
  std::array<Vec<Quadruple>, 3> directions;  // unit, at right angles
};

/// Semi-axes sqrt(k / eigenvalue of M), by Jacobi's rotations. Nothing unless the quadric is an ellipsoid.
std::optional<EllipsoidAxes> ellipsoidAxes(const QuadricCoefficients& coefficients);

/// 4 pi R_G(a^2 b^2, a^2 c^2, b^2 c^2) with Carlson's symmetric elliptic integral (DLMF 19.33.1).
Quadruple ellipsoidArea(const std::array<Quadruple, 3>& semiAxes);

/// The unit vector whose image under the semi-axes is uniform by area on the ellipsoid, for u, v uniform in [0,1).
/// Found by inverting the distribution functions of longitude and height in double; the chances are right to about
/// 1e-6 for a needle of 1e6 : 1 and to rounding for round ones.
std::array<double, 3> sampleEllipsoidDirection(const std::array<Quadruple, 3>& semiAxes, double u, double v);

}  // namespace solidcast::reference
