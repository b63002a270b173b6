// The course sheet's theory tasks as functions; docs/theory.md derives each of them.
#pragma once
#include "host/scene/world.h"

namespace solidcast {

/// Plane Ax+By+Cz+D = 0 as point and normal: the normal is (A,B,C) as given (unique up to sign and length), the point
/// is the plane's nearest to the zero point, -D (A,B,C)/|(A,B,C)|^2, computed in binary128 and rounded once.
/// Throws Error(Exit::usage) when A, B and C are zero.
InfinitePlane planeFromEquation(double a, double b, double c, double d);

/// Plane through three points that run counter-clockwise for one who looks against the normal, (p2-p1) x (p3-p1).
/// The point is p1; the normal is rounded once (and scaled by a power of two where fp64 could not hold it).
/// Throws Error(Exit::usage) when the points are exactly collinear.
InfinitePlane planeFromPoints(const Triple& p1, const Triple& p2, const Triple& p3);

/// Weights of (v1, v2, v3) in the centroid of any triangle: a third each.
Triple centroidBarycentric();

/// Weights of (v1, v2, v3) in the centre of the inscribed circle: the lengths of the opposite edges over their sum.
Triple incenterBarycentric(const Triangle& triangle);

/// The point with these weights, w1 v1 + w2 v2 + w3 v3.
Triple pointFromBarycentric(const Triangle& triangle, const Triple& weights);

}  // namespace solidcast
