#include "host/scene/theory.h"

#include <glm/geometric.hpp>

#include "host/error.h"
#include "host/scene/exact.h"
#include "host/scene/glm_triple.h"

namespace solidcast {
InfinitePlane planeFromEquation(double a, double b, double c, double d) {
  const Triple normal = {a, b, c};
  if (isZero(normal)) throw Error(Exit::usage, "plane: A, B and C are zero, expected a normal");
  const Wide squaredLength = Wide(a) * a + Wide(b) * b + Wide(c) * c;
  Triple foot;
  for (int i = 0; i < 3; ++i) foot[i] = d == 0 ? 0.0 : static_cast<double>(-Wide(d) * normal[i] / squaredLength);
  return {foot, normal};
}

InfinitePlane planeFromPoints(const Triple& p1, const Triple& p2, const Triple& p3) {
  const WideTriple normal = exactCross(p1, p2, p3);
  if (isZero(normal)) throw Error(Exit::usage, "plane: the three points are collinear, expected a plane");
  return {p1, roundScaled(normal)};
}

Triple centroidBarycentric() { return {1. / 3, 1. / 3, 1. / 3}; }

Triple incenterBarycentric(const Triangle& triangle) {
  const glm::dvec3 v1 = vec(triangle.v1), v2 = vec(triangle.v2), v3 = vec(triangle.v3);
  const glm::dvec3 opposite{glm::distance(v2, v3), glm::distance(v3, v1), glm::distance(v1, v2)};
  return triple(opposite / (opposite.x + opposite.y + opposite.z));
}

Triple pointFromBarycentric(const Triangle& triangle, const Triple& weights) {
  return triple(weights[0] * vec(triangle.v1) + weights[1] * vec(triangle.v2) + weights[2] * vec(triangle.v3));
}

}  // namespace solidcast
