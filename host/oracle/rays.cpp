// Rays of cameras in binary128, and the error measures of fp32 results.
#include <quadmath.h>

#include <cmath>
#include <variant>

#include "host/oracle/oracle.h"

namespace solidcast::oracle {
namespace {

Real length(const Real3& v) { return sqrtq(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

Real3 unit(const Real3& v) {
  const Real l = length(v);
  return {v[0] / l, v[1] / l, v[2] / l};
}

Real3 cross(const Real3& a, const Real3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Real3 widened(const Triple& v) { return {v[0], v[1], v[2]}; }

Real3 combined(Real a, const Real3& u, Real b, const Real3& v, Real c, const Real3& w) {
  Real3 result;
  for (int i = 0; i < 3; ++i) result[i] = a * u[i] + b * v[i] + c * w[i];
  return result;
}

Real radians(double degrees) { return degrees * (M_PIq / 180); }

// x and y run from -1 to 1, y upwards.
Ray128 rayOf(const PerspectiveCamera&, const PixelGrid& f, Real x, Real y) {
  Ray128 ray;
  ray.origin = f.center;
  ray.direction = combined(1, f.forward, x * f.halfX, f.right, y * f.halfY, f.upward);
  ray.length = length(ray.direction);
  return ray;
}

Ray128 rayOf(const OrthographicCamera& camera, const PixelGrid& f, Real x, Real y) {
  Ray128 ray;
  ray.origin = combined(1, f.center, x * f.halfX, f.right, y * f.halfY, f.upward);
  ray.direction = widened(camera.forward);  // not normalised: exact
  ray.length = length(ray.direction);
  return ray;
}

Ray128 rayOf(const EnvironmentCamera&, const PixelGrid& f, Real x, Real y) {
  const Real theta = x * f.halfX, phi = y * f.halfY;
  Ray128 ray;
  ray.origin = f.center;
  ray.direction = combined(cosq(phi) * cosq(theta), f.forward, cosq(phi) * sinq(theta), f.right, sinq(phi), f.upward);
  ray.length = length(ray.direction);
  return ray;
}

struct Halves {
  Real x, y;
  explicit Halves(const PerspectiveCamera& c)
      : x(tanq(radians(c.horizontalAngle) / 2)), y(tanq(radians(c.verticalAngle) / 2)) {}
  explicit Halves(const OrthographicCamera& c) : x(Real(c.scaleX) / 2), y(Real(c.scaleY) / 2) {}
  explicit Halves(const EnvironmentCamera& c) : x(radians(c.horizontalAngle) / 2), y(radians(c.verticalAngle) / 2) {}
};

// Unit of the last place of fp32 at x.
Real unitAt(Real x) {
  int exponent = 0;
  frexpq(x, &exponent);  // |x| in [2^(exponent-1), 2^exponent)
  if (x == 0) exponent = -1000;
  return ldexpq(1, std::max(exponent - 24, -149));
}

Real distance(float got, Real truth) {
  const Real difference = got - truth;
  return difference < 0 ? -difference : difference;
}

}  // namespace

Ray128 exactRay(const QueryRay& ray) {
  Ray128 result;
  for (int i = 0; i < 3; ++i) {
    result.origin[i] = ray.origin[i];
    result.direction[i] = ray.direction[i];
  }
  result.tMax = ray.tMax;
  return result;
}

PixelGrid::PixelGrid(const Camera& given, int w, int h) : camera(given), width(w), height(h) {
  std::visit(
      [&](const auto& c) {
        center = widened(c.center);
        forward = unit(widened(c.forward));
        right = unit(cross(forward, unit(widened(c.up))));
        upward = cross(right, forward);
        const Halves halves(c);
        halfX = halves.x, halfY = halves.y;
      },
      camera);
}

Ray128 PixelGrid::ray(double x, double y) const {
  const Real across = 2 * static_cast<Real>(x) / width - 1, up = 1 - 2 * static_cast<Real>(y) / height;
  return std::visit([&](const auto& c) { return rayOf(c, *this, across, up); }, camera);
}

Ray128 pixelRay(const Camera& camera, int width, int height, double x, double y) {
  return PixelGrid(camera, width, height).ray(x, y);
}

bool beyondFloat(Real truth) { return (truth < 0 ? -truth : truth) >= Real(0x1.ffffffp127); }

double ulpError(float got, Real truth) {
  if (std::isnan(got)) return std::numeric_limits<double>::infinity();
  if (std::isinf(got)) {
    return beyondFloat(truth) && (got > 0) == (truth > 0) ? 0 : std::numeric_limits<double>::infinity();
  }
  return static_cast<double>(distance(got, truth) / unitAt(truth));
}

double normalError(const std::array<float, 3>& got, const Real3& truth) {
  double worst = 0;
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(got[i])) return std::numeric_limits<double>::infinity();
    worst = std::fmax(worst, static_cast<double>(distance(got[i], truth[i]) * 0x1p23));
  }
  return worst;
}

double localError(const std::array<float, 3>& got, const Real3& truth) {
  Real largest = 0;
  for (const Real x : truth) largest = std::max(largest, x < 0 ? -x : x);
  double worst = 0;
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(got[i])) return std::numeric_limits<double>::infinity();
    worst = std::fmax(worst, static_cast<double>(distance(got[i], truth[i]) / unitAt(largest)));
  }
  return worst;
}

}  // namespace solidcast::oracle
