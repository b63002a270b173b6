// Random solids of a given place and size, and points on them.
#include <cmath>
#include <variant>

#include "host/oracle/families.h"
#include "host/oracle/oracle.h"
#include "host/oracle/random.h"
#include "host/oracle/vectors.h"

namespace solidcast::oracle {
namespace {

void roundToFloat(double& x) { x = static_cast<float>(x); }
void roundToFloat(Triple& v) {
  for (double& x : v) roundToFloat(x);
}

struct RoundToFloat {
  void operator()(InfinitePlane& s) const { roundToFloat(s.origin), roundToFloat(s.normal); }
  void operator()(AABox& s) const { roundToFloat(s.corner1), roundToFloat(s.corner2); }
  void operator()(Sphere& s) const { roundToFloat(s.center), roundToFloat(s.radius); }
  void operator()(Disc& s) const { roundToFloat(s.center), roundToFloat(s.normal), roundToFloat(s.radius); }
  void operator()(Triangle& s) const { roundToFloat(s.v1), roundToFloat(s.v2), roundToFloat(s.v3); }
  void operator()(Quad& s) const { roundToFloat(s.vertex), roundToFloat(s.span1), roundToFloat(s.span2); }
  void operator()(Quadric& s) const {
    for (double& x : s.coefficients) roundToFloat(x);
  }
};

}  // namespace

/// x^2, y^2, z^2 coefficients, linear ones and constant about `center`, expanded to the ten of the sheet.
Quadric aboutCenter(const Triple& squares, const Triple& mixed, const Triple& linear, double constant,
                    const Triple& center) {
  const auto& [a, b, c] = squares;
  const auto& [d, e, f] = mixed;
  const auto& [x, y, z] = center;
  const double value = a * x * x + b * y * y + c * z * z + d * x * y + e * x * z + f * y * z;
  return {{a, b, c, d, e, f, linear[0] - 2 * a * x - d * y - e * z, linear[1] - 2 * b * y - d * x - f * z,
           linear[2] - 2 * c * z - e * x - f * y, value - linear[0] * x - linear[1] * y - linear[2] * z + constant}};
}

namespace {

Quadric makeQuadric(Random& random, const Triple& center, double size) {
  const double s2 = 1 / (size * size);
  const auto radius = [&] { return s2 / std::pow(random.uniform(0.4, 1.2), 2); };
  const Triple r{radius(), radius(), radius()};
  const int axis = random.integer(0, 2);
  Triple squares = r, mixed{}, linear{};
  double constant = -1;
  switch (random.integer(0, 7)) {
    case 0:
      break;  // ellipsoid
    case 1:
      squares[axis] = 0;
      break;  // cylinder
    case 2:
      squares[axis] *= -1, constant = 0;
      break;  // cone
    case 3:
      squares[axis] *= -1;
      break;  // hyperboloid of one sheet
    case 4:
      squares[axis] *= -1, constant = 1;
      break;  // of two sheets
    case 5:   // paraboloid, elliptic or hyperbolic
      squares[axis] = 0, linear[axis] = random.sign() / size, constant = 0;
      squares[(axis + 1) % 3] *= random.sign();
      break;
    case 6:
      squares[axis] = 0, squares[(axis + 1) % 3] *= -1;
      break;  // hyperbolic cylinder
    default:  // anything
      for (double* v : {squares.data(), mixed.data()}) {
        for (int i = 0; i < 3; ++i) v[i] = random.uniform(-1, 1) * s2;
      }
      for (double& x : linear) x = random.uniform(-1, 1) / size;
      constant = random.uniform(-1, 1);
  }
  return aboutCenter(squares, mixed, linear, constant, center);
}

}  // namespace

Shape makeShape(Kind kind, Random& random, const Triple& center, double size) {
  const auto vector = [&] { return scaled(random.uniform(0.4, 1.2) * size, random.direction()); };
  Shape shape;
  switch (kind) {
    case Kind::plane:
      shape = InfinitePlane{center, scaled(random.decade(-2, 2), random.direction())};
      break;
    case Kind::box: {
      const Triple half{random.uniform(0.2, 1) * size, random.uniform(0.2, 1) * size, random.uniform(0.2, 1) * size};
      shape = AABox{sum(center, {-half[0], half[1], -half[2]}), sum(center, {half[0], -half[1], half[2]})};
      break;
    }
    case Kind::sphere:
      shape = Sphere{center, random.uniform(0.4, 1.2) * size};
      break;
    case Kind::disc:
      shape = Disc{center, scaled(random.decade(-2, 2), random.direction()), random.uniform(0.4, 1.2) * size};
      break;
    case Kind::triangle:
      shape = Triangle{sum(center, vector()), sum(center, vector()), sum(center, vector())};
      break;
    case Kind::quad: {
      const Triple a = vector(), b = vector();
      shape = Quad{difference(center, scaled(0.5, sum(a, b))), a, b};
      break;
    }
    case Kind::quadric:
      shape = makeQuadric(random, center, size);
      break;
  }
  // Not where rounding would flatten the solid.
  const bool coarse = size < 0x1p-12 * norm(center);
  if (random.chance(0.5) && !coarse) std::visit(RoundToFloat{}, shape);
  return shape;
}

bool pointOn(const Shape& shape, Random& random, const Triple& center, double size, Triple& point, Triple& normal) {
  for (int k = 0; k < 20; ++k) {
    const Triple from = sum(center, scaled(size, random.inCube(3)));
    const Triple to = sum(center, scaled(size, random.inCube(0.7)));
    Ray128 ray;
    for (int i = 0; i < 3; ++i) {
      ray.origin[i] = from[i];
      ray.direction[i] = to[i] - from[i];
    }
    const Truth truth = intersect(shape, ray);
    if (!truth.hit) continue;
    for (int i = 0; i < 3; ++i) {
      point[i] = static_cast<double>(truth.position[i]);
      normal[i] = static_cast<double>(truth.normal[i]);
    }
    return true;
  }
  return false;
}

}  // namespace solidcast::oracle
