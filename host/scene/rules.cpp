#include "host/scene/rules.h"

#include <algorithm>
#include <cfloat>
#include <charconv>
#include <cmath>

#include "host/scene/exact.h"
#include "host/scene/triple.h"

namespace solidcast {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

void checkTriple(const Triple& triple, const std::string& where) {
  for (int i = 0; i < 3; ++i) checkNumber(triple[i], where + numbered("/", i));
}

double length(const Triple& v) { return std::hypot(v[0], v[1], v[2]); }

/// The sine of the angle between two vectors, to a few digits; 0 when one of them is too short to say.
double sine(const Triple& a, const Triple& b) {
  const double lengthA = length(a), lengthB = length(b);
  if (lengthA == 0 || lengthB == 0) return 0;
  const WideTriple normal = exactCross(a, b);
  const Wide scale = Wide(lengthA) * lengthB;
  return std::hypot(double(normal[0] / scale), double(normal[1] / scale), double(normal[2] / scale));
}

/// Area over longest edge squared (twice the area of the triangle), to a few digits.
double fatness(const Triangle& t, const WideTriple& normal) {
  const double longest = std::max({length(minus(t.v2, t.v1)), length(minus(t.v3, t.v2)), length(minus(t.v1, t.v3))});
  if (longest == 0) return 0;  // edges below the smallest fp64
  const Wide scale = Wide(longest) * longest;
  return std::hypot(double(normal[0] / scale), double(normal[1] / scale), double(normal[2] / scale));
}

/// A quick certain yes for the common case; rounding is at most 2^-50 of the terms (underflow is left to the exact test).
bool clearlyFat(const Triangle& t) {
  const Triple a = minus(t.v2, t.v1), b = minus(t.v3, t.v1), c = minus(t.v3, t.v2);
  const Triple n = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const double longest = std::max({length(a), length(b), length(c)});
  return longest > 1e-100 && length(n) > 2 * kSliver * longest * longest;
}

void warnTooSmall(double radius, std::vector<Fault>& warnings) {
  if (radius < FLT_MIN)
    warnings.push_back({"/radius", "radius " + shortest(radius) +
                                       " is below the smallest normal fp32 number, expected at least " +
                                       shortest(FLT_MIN) + ": it will hardly be seen"});
}

void checkTriangle(const Triangle& t, std::vector<Fault>& warnings) {
  checkTriple(t.v1, "/vertices/0");
  checkTriple(t.v2, "/vertices/1");
  checkTriple(t.v3, "/vertices/2");
  if (clearlyFat(t)) return;
  const WideTriple normal = exactCross(t.v1, t.v2, t.v3);
  if (isZero(normal)) refuse("/vertices", "the three vertices are collinear, expected a triangle with an area");
  if (fatness(t, normal) < kSliver)
    warnings.push_back({"/vertices", "sliver: area is below " + shortest(kSliver) + " of the longest edge squared"});
}

void checkQuad(const Quad& quad, std::vector<Fault>& warnings) {
  checkTriple(quad.vertex, "/vertex");
  checkTriple(quad.span1, "/span1");
  checkTriple(quad.span2, "/span2");
  checkNonZero(quad.span1, "/span1");
  checkNonZero(quad.span2, "/span2");
  if (isZero(exactCross(quad.span1, quad.span2)))
    refuse("/span2", "span2 is parallel to span1, expected two directions");
  const double longer = std::max(length(quad.span1), length(quad.span2));
  const double shorter = std::min(length(quad.span1), length(quad.span2));
  if (sine(quad.span1, quad.span2) * (shorter / longer) < kSliver)
    warnings.push_back({"", "sliver: area is below " + shortest(kSliver) + " of the longer span squared"});
}

void checkBox(const AABox& box, std::vector<Fault>& warnings) {
  checkTriple(box.corner1, "/corner1");
  checkTriple(box.corner2, "/corner2");
  std::string flat;
  for (int i = 0; i < 3; ++i)
    if (box.corner1[i] == box.corner2[i]) flat += std::string(flat.empty() ? "" : ", ") + "xyz"[i];
  if (flat.empty()) return;
  const char* what[] = {"a rectangle", "a line, which hardly a ray hits", "a point, which hardly a ray hits"};
  warnings.push_back({"", "the box has no extent along " + flat + ": it is " + what[flat.size() / 3]});
}

void checkQuadric(const Quadric& quadric) {
  bool constant = true;
  for (int i = 0; i < 10; ++i) {
    checkNumber(quadric.coefficients[i], numbered("/coefficients/", i));
    if (i < 9 && quadric.coefficients[i] != 0) constant = false;
  }
  if (constant) refuse("/coefficients", "all of a to i are zero, expected at least one that is not");
}

void checkAngle(double angle, const char* where, double limit, bool limitAllowed) {
  checkNumber(angle, where);
  if (angle > 0 && (angle < limit || (limitAllowed && angle == limit))) return;
  refuse(where, "angle " + shortest(angle) + " is out of range, expected degrees above 0 and " +
                    (limitAllowed ? "at most " : "below ") + shortest(limit));
}

template <class AnyCamera>
void checkFrame(const AnyCamera& camera, std::vector<Fault>& warnings) {
  checkTriple(camera.center, "/center");
  checkTriple(camera.forward, "/forward");
  checkTriple(camera.up, "/up");
  checkNonZero(camera.forward, "/forward");
  checkNonZero(camera.up, "/up");
  if (isZero(exactCross(camera.forward, camera.up)))
    refuse("/up", "up is parallel to forward, expected another direction");
  if (sine(camera.forward, camera.up) < kSliver)
    warnings.push_back({"/up", "up is nearly parallel to forward: the picture's turn about forward is uncertain"});
}

void checkSide(double pixels, const char* where) {
  if (pixels >= 1 && pixels <= kMaxImageSide && pixels == std::floor(pixels)) return;
  refuse(where, "size " + shortest(pixels) + " is out of range, expected a whole number of pixels from 1 to " +
                    std::to_string(kMaxImageSide));
}

}  // namespace

std::string numbered(const char* text, std::size_t number) {
  std::string out = text;
  return out += std::to_string(number);
}

std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

void checkNumber(double value, const std::string& where) {
  if (!std::isfinite(value)) refuse(where, shortest(value) + " is not finite, expected a finite number");
  if (std::abs(value) > double(FLT_MAX))
    refuse(where, "number " + shortest(value) + " is beyond fp32, expected at most " + shortest(FLT_MAX) + " in size");
}

void checkPositive(double value, const std::string& where) {
  checkNumber(value, where);
  if (!(value > 0)) refuse(where, shortest(value) + " is not positive, expected a number above 0");
}

void checkNonZero(const Triple& vector, const std::string& where) {
  if (isZero(vector)) refuse(where, "the vector is zero, expected a direction");
}

void checkShape(const Shape& shape, std::vector<Fault>& warnings) {
  std::visit(Overloaded{[&](const InfinitePlane& plane) {
                          checkTriple(plane.origin, "/origin");
                          checkTriple(plane.normal, "/normal");
                          checkNonZero(plane.normal, "/normal");
                        },
                        [&](const AABox& box) { checkBox(box, warnings); },
                        [&](const Sphere& sphere) {
                          checkTriple(sphere.center, "/center");
                          checkPositive(sphere.radius, "/radius");
                          warnTooSmall(sphere.radius, warnings);
                        },
                        [&](const Disc& disc) {
                          checkTriple(disc.center, "/center");
                          checkTriple(disc.normal, "/normal");
                          checkNonZero(disc.normal, "/normal");
                          checkPositive(disc.radius, "/radius");
                          warnTooSmall(disc.radius, warnings);
                        },
                        [&](const Triangle& triangle) { checkTriangle(triangle, warnings); },
                        [&](const Quad& quad) { checkQuad(quad, warnings); },
                        [&](const Quadric& quadric) { checkQuadric(quadric); }},
             shape);
}

void checkImageSize(double width, double height) {
  checkSide(width, "/width");
  checkSide(height, "/height");
}

void checkCamera(const Camera& camera, std::vector<Fault>& warnings) {
  std::visit([&](const auto& any) { checkFrame(any, warnings); }, camera);
  std::visit(Overloaded{[](const PerspectiveCamera& perspective) {
                          checkAngle(perspective.verticalAngle, "/vertical_angle", 180, false);
                          checkAngle(perspective.horizontalAngle, "/horizontal_angle", 180, false);
                        },
                        [](const OrthographicCamera& orthographic) {
                          checkPositive(orthographic.scaleX, "/scale_x");
                          checkPositive(orthographic.scaleY, "/scale_y");
                        },
                        [](const EnvironmentCamera& environment) {
                          checkAngle(environment.verticalAngle, "/vertical_angle", 180, true);
                          checkAngle(environment.horizontalAngle, "/horizontal_angle", 360, true);
                        }},
             camera);
}

void checkIntegrator(const RayCastingDistIntegrator& integrator) {
  checkTriple(integrator.nearColor, "/near_color");
  checkTriple(integrator.farColor, "/far_color");
  checkNumber(integrator.nearDist, "/near_dist");
  checkNumber(integrator.farDist, "/far_dist");
  if (integrator.nearDist == integrator.farDist)
    refuse("/far_dist", "far_dist equals near_dist (" + shortest(integrator.farDist) + "), expected two distances");
}

}  // namespace solidcast
