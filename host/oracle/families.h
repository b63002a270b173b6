// Families of rays and scenes by which every method is measured: seeded, the same on every machine, exponents drawn
// uniformly. A family's name says where the difficulty lies; not every family exists for every kind of solid.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/scene/ray.h"
#include "host/scene/world.h"

namespace solidcast::oracle {

enum class Kind { plane, box, sphere, disc, triangle, quad, quadric };
inline constexpr Kind kKinds[] = {Kind::plane,    Kind::box,  Kind::sphere, Kind::disc,
                                  Kind::triangle, Kind::quad, Kind::quadric};

/// As in scene files: "infinite_plane", "box", ...
const char* nameOf(Kind kind);

/// One solid and the rays cast at it.
struct Batch {
  Shape shape;
  std::vector<QueryRay> rays;
};

/// The families of free rays for a kind of solid:
///   generic         solids of size 1, eye and aim around them
///   far             eye at 1e3..1e6 times the size
///   tiny            size 1e-12..1e-3 at distance 1
///   offset          solid and eye together 1e7 from the origin
///   length          |direction| 1e-15..1e15
///   scaled          coordinates (quadric: coefficients) times 1e-30..1e30
///   denormal        denormal fp32 components of origin or direction; quadric: denormal coefficients
///   axis            one or two direction components +0 or -0
///   boundary        aimed at the solid's outline as found by bisection, within 16 ulp
///   lattice         small integers, aimed exactly at edges, corners, rims, silhouettes; some nudged by up to 3 ulp
///   rim             aimed 1e-8..1e-5 (of the size) off an edge or outline
///   surface         origin on the surface or 1e-9..1e-3 above or below it
///   inside          origin inside a sphere, box or ellipsoid, 1e-9..1 below the surface
///   grazing         direction 1e-7..1e-3 off the plane of the solid
///   face            box: origin in the plane of a face, direction along it or not
///   planet          sphere, quadric: radius 1e6..1e8, eye 1 to 2 above the ground
///   sliver          triangle, quad: sides 1 : 1e3..1e7
///   parallel        triangle, quad: spans 1e-7..1e-3 rad apart
///   spread          quadric: coefficients over 12 orders of magnitude
///   paraboloid      quadric: rays 1e-9..1e-3 off the axis (A near 0), some exactly along it
///   generator       quadric: rays 1e-9..1e-4 off a generator of a cone, some exactly parallel to one
///   apex            quadric: aimed 1e-7..1e-1 beside a cone's apex, some exactly at it
///   cylinder        quadric: rays tangent to a cylinder within 16 ulp
const std::vector<std::string>& familiesOf(Kind kind);

/// `rays` rays of a family, `raysPerShape` for each solid (the last batch may be shorter). Throws std::invalid_argument
/// for a family that the kind does not have.
std::vector<Batch> makeBatches(Kind kind, const std::string& family, std::size_t rays, std::uint64_t seed,
                               std::size_t raysPerShape = 1);

/// A closed mesh of triangles around the origin of its rays, which are aimed at shared edges (or, `vertices`, at the
/// vertices, where 4 to 9 triangles meet), some nudged by up to 3 ulp. Every ray must hit some triangle.
struct CrackBatch {
  World world;
  std::vector<QueryRay> rays;
};
CrackBatch makeCracks(bool vertices, std::size_t rays, std::uint64_t seed);

/// The families of images: "perspective", "narrow" (1e-6 degrees), "wide" (179.9999 degrees), "far", "surface" (eye on
/// or 1e-9..1e-3 from the solid), "inside", "planet", "orthographic", "environment"; for a kind that has no such
/// picture (a plane has no inside) the family is not listed.
const std::vector<std::string>& imageFamiliesOf(Kind kind);

/// A scene of one solid, width x height pixels.
Scene makeImage(Kind kind, const std::string& family, int width, int height, std::uint64_t seed);

// --- the parts that both kinds of family are made of -----------------------------------------------------------

class Random;

/// A solid of about `size` around `center`; half of them have all numbers rounded to fp32 (none that this would flatten).
Shape makeShape(Kind kind, Random& random, const Triple& center, double size);

/// A point of the surface and the unit normal there, found by casting rays; false where none was found.
bool pointOn(const Shape& shape, Random& random, const Triple& center, double size, Triple& point, Triple& normal);

}  // namespace solidcast::oracle
