#include "host/study/sweeps.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "host/oracle/aims.h"

namespace solidcast::study {
namespace {

using namespace oracle;

/// A unit vector across `axis`.
Triple across(const Triple& axis, Random& random) {
  for (;;) {
    const Triple v = outer(axis, random.direction());
    if (norm(v) > 0.1) return unitOf(v);
  }
}

QueryRay directed(const Triple& origin, const Triple& direction) {
  QueryRay ray;
  for (std::size_t i = 0; i < 3; ++i) {
    ray.origin[i] = static_cast<float>(origin[i]);
    ray.direction[i] = static_cast<float>(direction[i]);
  }
  return ray;
}

/// A point of the disc around `center`, across `axis`.
Triple inDisc(const Triple& center, const Triple& axis, double radius, Random& random) {
  const Triple u = across(axis, random), v = outer(axis, u);
  const double r = radius * std::sqrt(random.uniform(0, 1)), angle = random.uniform(0, 6.283185307179586);
  return sum(center, sum(scaled(r * std::cos(angle), u), scaled(r * std::sin(angle), v)));
}

/// One solid of this difficulty, and rays at it.
struct Target {
  Shape shape;
  std::function<QueryRay(Random&)> ray;
};

Target farSphere(double distance, Random& random) {
  const Triple axis = random.direction(), center = scaled(distance, axis);
  return {Sphere{center, 1}, [=](Random& r) { return aimed(r.inCube(0.5), inDisc(center, axis, 1.02, r)); }};
}

Target planet(double radius, Random& random) {
  const Triple up = random.direction();
  return {Sphere{scaled(-radius, up), radius}, [=](Random& r) {
            const Triple level = across(up, r);
            const double down = r.chance(0.5) ? r.decade(-3, 0) : r.uniform(0.7, 1);
            return directed(sum(scaled(r.uniform(1, 2), up), scaled(r.uniform(-1, 1), level)),
                            sum(scaled(-down, up), scaled(std::sqrt(1 - down * down), level)));
          }};
}

Target grazedSphere(double relative, Random& random) {
  const Triple center = random.inCube(4);
  return {Sphere{center, 1}, [=](Random& r) {
            const Triple away = r.direction(), side = across(away, r);
            const double distance = r.uniform(2, 6), sine = (1 + r.sign() * relative) / distance;
            const Triple origin = sum(center, scaled(distance, away));
            return directed(origin, sum(scaled(-std::sqrt(1 - sine * sine), away), scaled(sine, side)));
          }};
}

Target grazedPlane(double angle, Random& random) {
  const Triple n = random.direction(), p = random.inCube(1);
  return {InfinitePlane{p, n}, [=](Random& r) {
            const Triple level = across(n, r);
            const Triple origin = sum(p, sum(scaled(r.uniform(0.5, 2), n), scaled(r.uniform(-3, 3), level)));
            return directed(origin, sum(scaled(-std::sin(angle), n), scaled(std::cos(angle), level)));
          }};
}

Target discRim(double relative, Random& random) {
  const Triple n = random.direction(), c = random.inCube(4);
  return {Disc{c, n, 1}, [=](Random& r) {
            const Triple rim = sum(c, scaled(1 + r.sign() * relative, across(n, r)));
            return aimed(sum(c, scaled(r.uniform(2, 5), r.direction())), rim);
          }};
}

Target sliver(double ratio, Random& random) {
  const Triple along = random.direction(), aside = across(along, random), v = random.inCube(3);
  const Triple e1 = scaled(2, along), e2 = sum(along, scaled(2 / ratio, aside));
  return {Triangle{v, sum(v, e1), sum(v, e2)}, [=](Random& r) {
            const double beta = r.uniform(-0.2, 1.2), gamma = r.uniform(-0.2, 1.2 - std::max(beta, 0.0));
            const Triple at = sum(v, sum(scaled(beta, e1), scaled(gamma, e2)));
            return aimed(sum(at, scaled(r.uniform(2, 5), r.direction())), at);
          }};
}

Target narrowQuad(double angle, Random& random) {
  const Triple along = random.direction(), aside = across(along, random), v = random.inCube(3);
  const Triple e1 = scaled(2, along),
               e2 = scaled(2, sum(scaled(std::cos(angle), along), scaled(std::sin(angle), aside)));
  return {Quad{v, e1, e2}, [=](Random& r) {
            const double beta = r.uniform(-0.2, 1.2), gamma = r.uniform(-0.2, 1.2);
            const Triple at = sum(v, sum(scaled(beta, e1), scaled(gamma, e2)));
            return aimed(sum(at, scaled(r.uniform(2, 5), r.direction())), at);
          }};
}

Target movedBox(double offset, Random& random) {
  const Triple c = scaled(offset, random.direction());
  const Triple half{random.uniform(0.3, 1), random.uniform(0.3, 1), random.uniform(0.3, 1)};
  return {AABox{oracle::difference(c, half), sum(c, half)},
          [=](Random& r) { return aimed(sum(c, scaled(r.uniform(2, 5), r.direction())), sum(c, r.inCube(1))); }};
}

Target spreadEllipsoid(double spread, Random& random) {
  const Triple squares{1, std::sqrt(spread), spread}, c = random.inCube(1);
  return {aboutCenter(squares, {0, 0, 0}, {0, 0, 0}, -1, c), [=](Random& r) {
            Triple p = scaled(r.uniform(0.5, 1.05), r.direction());
            for (std::size_t i = 0; i < 3; ++i) p[i] /= std::sqrt(squares[i]);
            return aimed(sum(c, scaled(r.uniform(2, 5), r.direction())), sum(c, p));
          }};
}

Target movedQuadric(double offset, Random& random) {
  const Triple c = scaled(offset, random.direction());
  return {aboutCenter({1, 1, 1}, {0, 0, 0}, {0, 0, 0}, -1, c), [=](Random& r) {
            return aimed(sum(c, scaled(r.uniform(2, 5), r.direction())), sum(c, scaled(1.02, r.direction())));
          }};
}

std::vector<double> decades(double first, double last) {
  std::vector<double> values;
  const double step = last > first ? 10 : 0.1;
  for (double v = first; step > 1 ? v < last * 1.1 : v > last * 0.9; v *= step) values.push_back(v);
  return values;
}

struct Definition {
  Kind kind;
  Sweep sweep;
  Target (*target)(double, Random&);
};

const std::vector<Definition>& definitions() {
  const auto define = [](Kind kind, const char* id, const char* title, const char* axis, double first, double last,
                         const char* note, Target (*target)(double, Random&)) {
    return Definition{kind, {id, nameOf(kind), title, axis, note, decades(first, last), last < first}, target};
  };
  static const std::vector<Definition> list{
      define(Kind::plane, "plane_grazing", "Plane seen at a flat angle", "angle between ray and plane, rad", 1, 1e-7,
             "Eye 0.5 to 2 above the plane. The flatter the ray, the more a rounding of its direction moves the hit.",
             grazedPlane),
      define(Kind::box, "box_offset", "Box far from the origin", "distance of the box from the origin, box size 1", 1,
             1e7, "Eye 2 to 5 beside the box: both have large coordinates, and their difference is small.", movedBox),
      define(Kind::sphere, "sphere_distance", "Sphere far away", "distance / radius", 10, 1e7,
             "Aimed all over the sphere and just beside it.", farSphere),
      define(Kind::sphere, "sphere_ground", "On a planet", "radius / height of the eye", 1, 1e9,
             "Eye 1 to 2 above the ground of a sphere as large as a planet, looking down or along.", planet),
      define(Kind::sphere, "sphere_grazing", "Sphere grazed", "distance from the silhouette / radius", 0.1, 1e-8,
             "Half of the rays pass inside the silhouette, half outside.", grazedSphere),
      define(Kind::disc, "disc_rim", "Disc hit near the rim", "distance from the rim / radius", 0.1, 1e-8,
             "Half of the rays inside the rim, half outside.", discRim),
      define(Kind::triangle, "triangle_sliver", "Slivers", "length / width of the triangle", 1, 1e7,
             "Aimed at the triangle and closely beside it.", sliver),
      define(Kind::quad, "quad_parallel", "Quad of nearly parallel spans", "angle between the spans, rad", 1, 1e-7,
             "Aimed at the quad and closely beside it.", narrowQuad),
      define(Kind::quadric, "quadric_spread", "Stiff quadric", "largest / smallest coefficient", 1, 1e12,
             "Ellipsoids x^2 + sqrt(k) y^2 + k z^2 = 1.", spreadEllipsoid),
      define(Kind::quadric, "quadric_offset", "Quadric far from the origin", "distance from the origin, radius 1", 1,
             1e6, "A unit sphere given by its ten coefficients; the constant grows with the square of the distance.",
             movedQuadric),
  };
  return list;
}

}  // namespace

std::vector<Sweep> sweepsOf(Kind kind) {
  std::vector<Sweep> all;
  for (const Definition& d : definitions())
    if (d.kind == kind) all.push_back(d.sweep);
  return all;
}

std::vector<Batch> makeSweep(const Sweep& sweep, double value, std::size_t rays, std::uint64_t seed,
                             std::size_t raysPerShape) {
  const auto& list = definitions();
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Definition& d) { return d.sweep.id == sweep.id; });
  if (found == list.end()) throw std::invalid_argument("no sweep " + sweep.id);
  Random random(seed * 1000003 + static_cast<std::uint64_t>(found - list.begin()) * 1009);
  std::vector<Batch> batches;
  for (std::size_t done = 0; done < rays; done += raysPerShape) {
    const Target target = found->target(value, random);
    Batch& batch = batches.emplace_back(Batch{target.shape, {}});
    for (std::size_t i = 0; i < std::min(raysPerShape, rays - done); ++i) batch.rays.push_back(target.ray(random));
  }
  return batches;
}

}  // namespace solidcast::study
