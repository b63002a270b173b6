// The solids of each family.
#include <cmath>
#include <variant>

#include "host/oracle/aims.h"

namespace solidcast::oracle {

Subject genericSubject(Kind kind, Random& random) {
  const Triple center = random.inCube(2);
  return {makeShape(kind, random, center, 1), center, 1};
}

Subject tinySubject(Kind kind, Random& random) {
  // The rays start at 0; the solid sits on a direction that fp32 can hold, or it would never be hit.
  Triple center = random.direction();
  for (double& x : center) x = static_cast<float>(x);
  const double size = random.decade(-12, -3);
  return {makeShape(kind, random, center, size), center, size};
}

Subject offsetSubject(Kind kind, Random& random) {
  const Triple center = random.inCube(1e7);
  const double size = random.decade(0, 3);
  return {makeShape(kind, random, center, size), center, size};
}

Subject scaledSubject(Kind kind, Random& random) {
  const double scale = random.decade(-30, 30);
  if (kind != Kind::quadric) {
    const Triple center = scaled(scale, random.inCube(2));
    return {makeShape(kind, random, center, scale), center, scale};
  }
  Subject subject = genericSubject(kind, random);
  for (double& x : std::get<Quadric>(subject.shape).coefficients) x *= scale;
  return subject;
}

Subject denormalSubject(Kind kind, Random& random) {
  if (kind == Kind::quadric && random.chance(0.5)) {
    Subject subject = genericSubject(kind, random);
    const double scale = random.decade(-44, -38);
    for (double& x : std::get<Quadric>(subject.shape).coefficients) x = static_cast<float>(x * scale);
    return subject;
  }
  // Placed at denormal coordinates, of ordinary size.
  const Triple center = scaled(1e-40, random.inCube(5));
  return {makeShape(kind, random, center, 1), center, 1};
}

Subject closedSubject(Kind kind, Random& random) {
  Subject subject = genericSubject(kind, random);
  if (kind == Kind::quadric) {
    const auto radius = [&] { return random.decade(-1, 1); };
    const Triple radii{radius(), radius(), radius()};
    subject.size = std::fmax(radii[0], std::fmax(radii[1], radii[2]));
    subject.shape = aboutCenter({1 / (radii[0] * radii[0]), 1 / (radii[1] * radii[1]), 1 / (radii[2] * radii[2])}, {},
                                {}, -1, subject.center);
  }
  return subject;
}

Subject floatBoxSubject(Kind, Random& random) {
  Triple low, high;
  for (int i = 0; i < 3; ++i) {
    low[i] = static_cast<float>(random.uniform(-2, 0));
    high[i] = static_cast<float>(random.uniform(0, 2));
  }
  return {AABox{low, high}, {}, 2};
}

Subject planetSubject(Kind kind, Random& random) {
  double radius = random.decade(6, 8);
  if (random.chance(0.5)) radius = static_cast<float>(radius);
  const Triple center{0, -radius, 0};
  if (kind == Kind::sphere) return {Sphere{center, radius}, center, radius};
  const double scale = random.chance(0.5) ? 1 : 1 / (radius * radius);
  return {aboutCenter({scale, scale, scale}, {}, {}, -radius * radius * scale, center), center, radius};
}

namespace {

Subject spanned(Kind kind, const Triple& corner, const Triple& a, const Triple& b) {
  if (kind == Kind::quad) return {Quad{corner, a, b}, corner, norm(a)};
  return {Triangle{corner, sum(corner, a), sum(corner, b)}, corner, norm(a)};
}

}  // namespace

Subject sliverSubject(Kind kind, Random& random) {
  const Triple a = random.direction(), b = unitOf(outer(a, random.direction()));
  const double length = random.decade(-2, 2);
  const Triple narrow = sum(scaled(random.uniform(0, 1), a), scaled(random.decade(-7, -3), b));
  return spanned(kind, random.inCube(2), scaled(length, a),
                 scaled(length, kind == Kind::quad ? scaled(random.decade(-7, -3), b) : narrow));
}

Subject parallelSubject(Kind kind, Random& random) {
  const Triple a = random.direction(), b = unitOf(outer(a, random.direction()));
  const double angle = random.decade(-7, -3), length = random.decade(-2, 2);
  const Triple turned = sum(scaled(std::cos(angle), a), scaled(std::sin(angle), b));
  return spanned(kind, random.inCube(2), scaled(length, a), scaled(random.sign() * length, turned));
}

Subject spreadSubject(Kind, Random& random) {
  Quadric quadric;
  for (double& x : quadric.coefficients) x = random.sign() * random.decade(-6, 6);
  return {quadric, {}, 1};
}

Subject paraboloidSubject(Kind, Random& random) {
  Subject subject{{}, random.inCube(2), 1, random.integer(0, 2)};
  Triple squares{random.decade(-1, 1), random.decade(-1, 1), random.decade(-1, 1)}, linear{};
  squares[subject.axis] = 0;
  linear[subject.axis] = random.sign();
  if (random.chance(0.25)) squares[(subject.axis + 1) % 3] *= -1;
  subject.shape = aboutCenter(squares, {}, linear, 0, subject.center);
  return subject;
}

Subject coneSubject(Kind, Random& random) {
  Subject subject{{}, random.inCube(2), 1, random.integer(0, 2), random.decade(-1, 1)};
  if (random.chance(0.25)) {  // integers: its generators along (3,4,5) and (1,0,1) are exact
    for (double& x : subject.center) x = random.integer(-2, 2);
    subject.opening = 1;
  }
  Triple squares{1, 1, 1};
  squares[subject.axis] = -subject.opening * subject.opening;
  subject.shape = aboutCenter(squares, {}, {}, 0, subject.center);
  return subject;
}

Subject cylinderSubject(Kind, Random& random) {
  Subject subject{{}, random.inCube(2), random.decade(-1, 1), random.integer(0, 2)};
  Triple squares{1, 1, 1};
  squares[subject.axis] = 0;
  subject.shape = aboutCenter(squares, {}, {}, -subject.size * subject.size, subject.center);
  return subject;
}

// Small integers with rational edges: the 3-4-5 triangle gives exact points of circles and spheres of radius 5.
Subject latticeSubject(Kind kind, Random& random) {
  const auto point = [&](int range, int step) {
    return Triple{double(step * random.integer(-range, range)), double(step * random.integer(-range, range)),
                  double(step * random.integer(-range, range))};
  };
  Subject subject{{}, point(4, 1), 5, random.integer(0, 2)};
  Triple axis{};
  axis[subject.axis] = random.integer(1, 3);
  switch (kind) {
    case Kind::plane:
      subject.shape = InfinitePlane{subject.center, sum(point(3, 1), axis)};
      break;
    case Kind::box: {
      const Triple extent{double(random.integer(1, 4)), double(random.integer(1, 4)), double(random.integer(1, 4))};
      subject.shape = AABox{subject.center, sum(subject.center, extent)};
      break;
    }
    case Kind::sphere:
      subject.shape = Sphere{subject.center, 5};
      break;
    case Kind::disc:
      subject.shape = Disc{subject.center, axis, 5};
      break;
    case Kind::triangle:
    case Kind::quad: {  // spans are multiples of 4, so quarters of edges are integers
      Triple a, b;
      do { a = point(2, 4), b = point(2, 4); } while (norm(outer(a, b)) == 0);
      subject = spanned(kind, subject.center, a, b);
      break;
    }
    case Kind::quadric: {
      Triple squares{1, 1, 1};
      if (random.chance(0.5)) squares[subject.axis] = 0;
      subject.shape = aboutCenter(squares, {}, {}, -25, subject.center);
      break;
    }
  }
  if (const auto* plane = std::get_if<InfinitePlane>(&subject.shape); plane != nullptr && norm(plane->normal) == 0) {
    subject.shape = InfinitePlane{subject.center, axis};
  }
  return subject;
}

}  // namespace solidcast::oracle
