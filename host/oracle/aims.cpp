// The rays of each family.
#include "host/oracle/aims.h"

#include <cmath>
#include <variant>

#include "host/oracle/oracle.h"

namespace solidcast::oracle {

QueryRay aimed(const Triple& origin, const Triple& target) {
  QueryRay ray;
  for (int i = 0; i < 3; ++i) {
    ray.origin[i] = static_cast<float>(origin[i]);
    ray.direction[i] = static_cast<float>(target[i] - ray.origin[i]);
  }
  if (ray.direction == std::array<float, 3>{}) ray.direction = {0, 0, 1};
  return ray;
}

float nudged(float x, int k) {
  for (; k > 0; --k) x = std::nextafter(x, INFINITY);
  for (; k < 0; ++k) x = std::nextafter(x, -INFINITY);
  return x;
}

namespace {

Triple around(const Subject& subject, Random& random, double half) {
  return sum(subject.center, scaled(subject.size, random.inCube(half)));
}

QueryRay withDirection(const Triple& origin, const Triple& direction) {
  QueryRay ray = aimed(origin, origin);
  for (int i = 0; i < 3; ++i) ray.direction[i] = static_cast<float>(direction[i]);
  if (ray.direction == std::array<float, 3>{}) ray.direction = {0, 0, 1};
  return ray;
}

void rescale(QueryRay& ray, double factor) {
  for (float& x : ray.direction) x = static_cast<float>(x * factor);
}

void nudgeSome(QueryRay& ray, Random& random, int most) {
  for (float& x : ray.direction) {
    if (x != 0 && random.chance(0.5)) x = nudged(x, random.integer(-most, most));
  }
}

bool hits(const Shape& shape, const Triple& origin, const Triple& target) {
  Ray128 ray;
  for (int i = 0; i < 3; ++i) {
    ray.origin[i] = origin[i];
    ray.direction[i] = static_cast<Real>(target[i]) - origin[i];
  }
  return intersect(shape, ray).hit;
}

}  // namespace

bool outline(const Subject& subject, Random& random, Triple& origin, Triple& target, Triple& across) {
  origin = around(subject, random, 4);
  for (double& x : origin) x = static_cast<float>(x);
  Triple inner{}, outer{};
  bool hit = false, miss = false;
  for (int k = 0; k < 24 && !(hit && miss); ++k) {
    const Triple t = around(subject, random, k % 2 == 0 ? 0.7 : 4);
    if (hits(subject.shape, origin, t)) {
      inner = t, hit = true;
    } else {
      outer = t, miss = true;
    }
  }
  if (!hit || !miss) return false;
  across = difference(outer, inner);
  for (int k = 0; k < 32; ++k) {
    target = scaled(0.5, sum(inner, outer));
    (hits(subject.shape, origin, target) ? inner : outer) = target;
  }
  return true;
}

QueryRay genericRay(const Subject& subject, Random& random) {
  QueryRay ray = aimed(around(subject, random, 4), around(subject, random, 1.1));
  if (random.chance(0.5)) {
    const Triple d{ray.direction[0], ray.direction[1], ray.direction[2]};
    ray = withDirection({ray.origin[0], ray.origin[1], ray.origin[2]}, unitOf(d));
  }
  return ray;
}

QueryRay farRay(const Subject& subject, Random& random) {
  const Triple away = scaled(subject.size * random.decade(3, 6), random.direction());
  return aimed(sum(subject.center, away), around(subject, random, 1.1));
}

QueryRay tinyRay(const Subject& subject, Random& random) {
  QueryRay ray = aimed({}, subject.center);
  rescale(ray, std::ldexp(1, random.integer(-3, 3)));
  if (random.chance(0.3)) nudgeSome(ray, random, 1);
  return ray;
}

QueryRay longRay(const Subject& subject, Random& random) {
  QueryRay ray = genericRay(subject, random);
  rescale(ray, random.decade(-15, 15));
  return ray;
}

QueryRay denormalRay(const Subject& subject, Random& random) {
  QueryRay ray = genericRay(subject, random);
  switch (random.integer(0, 2)) {
    case 0:
      ray.origin[random.integer(0, 2)] = static_cast<float>(random.sign() * random.decade(-45, -38));
      break;
    case 1:
      ray.direction[random.integer(0, 2)] = static_cast<float>(random.sign() * random.decade(-45, -38));
      break;
    default: {
      const QueryRay before = ray;
      rescale(ray, random.decade(-42, -39));
      if (ray.direction == std::array<float, 3>{}) ray = before;
    }
  }
  return ray;
}

QueryRay axisRay(const Subject& subject, Random& random) {
  Triple direction = random.direction();
  const int axis = random.integer(0, 2);
  for (int i = 0; i < 3; ++i) {
    if (i != axis && (i == (axis + 1) % 3 || random.chance(0.7))) direction[i] = random.sign() * 0.0;
  }
  return withDirection(difference(around(subject, random, 1), scaled(subject.size * random.uniform(0, 4), direction)),
                       direction);
}

QueryRay boundaryRay(const Subject& subject, Random& random) {
  Triple origin, target, across;
  if (!outline(subject, random, origin, target, across)) return genericRay(subject, random);
  QueryRay ray = aimed(origin, target);
  nudgeSome(ray, random, 16);
  return ray;
}

QueryRay rimRay(const Subject& subject, Random& random) {
  Triple origin, target, across;
  if (!outline(subject, random, origin, target, across)) return genericRay(subject, random);
  return aimed(origin, sum(target, scaled(random.sign() * random.decade(-8, -5), across)));
}

QueryRay surfaceRay(const Subject& subject, Random& random) {
  Triple point, normal;
  if (!pointOn(subject.shape, random, subject.center, subject.size, point, normal)) return genericRay(subject, random);
  const double height = random.chance(0.25) ? 0 : random.sign() * subject.size * random.decade(-9, -3);
  return withDirection(sum(point, scaled(height, normal)), random.direction());
}

QueryRay insideRay(const Subject& subject, Random& random) {
  Triple point, normal;
  if (!pointOn(subject.shape, random, subject.center, subject.size, point, normal)) return genericRay(subject, random);
  const Triple inwards = scaled(1 - random.decade(-9, 0), difference(point, subject.center));
  return withDirection(sum(subject.center, inwards), random.direction());
}

QueryRay grazingRay(const Subject& subject, Random& random) {
  Triple point, normal;
  if (!pointOn(subject.shape, random, subject.center, subject.size, point, normal)) return genericRay(subject, random);
  const Triple along = unitOf(outer(normal, random.direction()));
  const Triple direction = sum(along, scaled(random.sign() * random.decade(-7, -3), normal));
  return aimed(difference(point, scaled(subject.size * random.uniform(0.5, 3), direction)), point);
}

QueryRay faceRay(const Subject& subject, Random& random) {
  const auto& box = std::get<AABox>(subject.shape);
  Triple origin = random.inCube(3), direction = random.direction();
  for (int i = 0; i < 3; ++i) {
    if (random.chance(0.5)) origin[i] = random.chance(0.5) ? box.corner1[i] : box.corner2[i];
    if (random.chance(0.5)) direction[i] = random.sign() * 0.0;
  }
  if (norm(direction) == 0) direction[random.integer(0, 2)] = random.sign();
  return withDirection(origin, direction);
}

QueryRay planetRay(const Subject&, Random& random) {
  Triple direction = random.direction();
  direction[1] = random.sign() * random.decade(-6, 0);
  return withDirection({random.uniform(-1, 1), random.uniform(1, 2), random.uniform(-1, 1)}, direction);
}

QueryRay spannedRay(const Subject& subject, Random& random) {
  Triple corner, a, b;
  if (const auto* quad = std::get_if<Quad>(&subject.shape)) {
    corner = quad->vertex, a = quad->span1, b = quad->span2;
  } else {
    const auto& triangle = std::get<Triangle>(subject.shape);
    corner = triangle.v1, a = difference(triangle.v2, corner), b = difference(triangle.v3, corner);
  }
  const double high = std::holds_alternative<Quad>(subject.shape) ? 1.1 : 0.6;
  const Triple target = sum(corner, sum(scaled(random.uniform(-0.1, high), a), scaled(random.uniform(-0.1, high), b)));
  return aimed(sum(target, scaled(subject.size * random.decade(-1, 1), random.direction())), target);
}

QueryRay nearAxisRay(const Subject& subject, Random& random) {
  Triple direction{};
  direction[subject.axis] = random.sign();
  const double off = random.chance(0.2) ? 0 : random.decade(-9, -3);
  direction = sum(direction, scaled(off, random.inCube(1)));
  return withDirection(around(subject, random, 3), direction);
}

QueryRay generatorRay(const Subject& subject, Random& random) {
  const int axis = subject.axis, u = (axis + 1) % 3, v = (axis + 2) % 3;
  Triple direction{};
  if (random.chance(0.2)) {
    direction[u] = 3 * random.sign(), direction[v] = 4 * random.sign(), direction[axis] = 5 * random.sign();
  } else {
    const double angle = random.uniform(0, 6.283185307179586);
    direction[axis] = 1;
    direction[u] = subject.opening * std::cos(angle), direction[v] = subject.opening * std::sin(angle);
    direction = sum(scaled(random.sign(), direction), scaled(random.decade(-9, -4), random.inCube(1)));
  }
  Triple origin = around(subject, random, 3);
  if (random.chance(0.25)) {
    for (double& x : origin) x = std::round(x);
  }
  return withDirection(origin, direction);
}

QueryRay apexRay(const Subject& subject, Random& random) {
  Triple origin = around(subject, random, 3);
  if (random.chance(0.1)) {
    for (double& x : origin) x = std::round(x);
    return aimed(origin, subject.center);
  }
  return aimed(origin, sum(subject.center, scaled(random.decade(-7, -1), random.inCube(1))));
}

QueryRay latticeRay(const Subject& subject, Random& random) {
  const int axis = subject.axis, u = (axis + 1) % 3, v = (axis + 2) % 3;
  const auto integers = [&](int range) {
    return Triple{double(random.integer(-range, range)), double(random.integer(-range, range)),
                  double(random.integer(-range, range))};
  };
  Triple target = subject.center, origin = sum(subject.center, integers(9));
  // A point at distance 5 from the centre across the axis.
  const double three = 3 * random.sign(), four = 4 * random.sign();
  if (const auto* plane = std::get_if<InfinitePlane>(&subject.shape)) {
    target = random.chance(0.3) ? sum(origin, outer(plane->normal, integers(3))) : sum(target, integers(5));
  } else if (const auto* box = std::get_if<AABox>(&subject.shape)) {
    for (int i = 0; i < 3; ++i) {
      const auto low = static_cast<int>(box->corner1[i]), high = static_cast<int>(box->corner2[i]);
      target[i] = i == axis ? random.integer(low, high) : random.chance(0.5) ? low : high;
    }
  } else if (std::holds_alternative<Disc>(subject.shape)) {
    target[u] += three, target[v] += four;
  } else if (std::holds_alternative<Sphere>(subject.shape) || std::holds_alternative<Quadric>(subject.shape)) {
    target[u] += three, target[v] += four;
    Triple tangent{};
    tangent[u] = -four, tangent[v] = three, tangent[axis] = random.integer(-4, 4);
    origin = difference(target, scaled(random.integer(-1, 3), tangent));
    if (random.chance(0.1)) origin = sum(subject.center, integers(9));
  } else {
    const double quarter = random.integer(0, 4) / 4.0, other = random.chance(0.5) ? 0 : 1;
    Triple a, b;
    bool triangle = false;
    if (const auto* quad = std::get_if<Quad>(&subject.shape)) {
      target = quad->vertex, a = quad->span1, b = quad->span2;
    } else {
      const auto& t = std::get<Triangle>(subject.shape);
      target = t.v1, a = difference(t.v2, t.v1), b = difference(t.v3, t.v1);
      triangle = true;
    }
    const double second = triangle && other == 1 ? 1 - quarter : other;
    if (random.chance(0.5)) std::swap(a, b);
    target = sum(target, sum(scaled(quarter, a), scaled(second, b)));
  }
  QueryRay ray = aimed(origin, target);
  if (random.chance(0.3)) nudgeSome(ray, random, 3);
  if (random.chance(0.3)) rescale(ray, std::ldexp(1, random.integer(-4, 4)));
  return ray;
}

}  // namespace solidcast::oracle
