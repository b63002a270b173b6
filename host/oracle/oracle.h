// What a ray truly hits: the third, independent set of formulas (beside the GPU's and reference_cpu's), by which errors
// are counted. Each decision is proven: first in extended precision with a running error bound, where that does not
// decide in binary128 with its bound, and where a sign is still in doubt in exact dyadic rationals. Ties are compared
// as algebraic numbers. Nothing here is a tolerance.
#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "host/scene/ray.h"
#include "host/scene/world.h"

namespace solidcast::oracle {

using Real = __float128;
using Real3 = std::array<Real, 3>;

/// p(s) = origin + s direction. Hits are reported with t = s * length: `length` is 1 for free rays and |direction| for
/// pixel rays, whose t is a distance although the direction is not normalised (that would round it once more).
/// Components are taken as exact. The direction must not be zero and everything finite but tMax.
struct Ray128 {
  Real3 origin{}, direction{};
  Real length = 1;
  Real tMax = std::numeric_limits<double>::infinity();
};

/// The very numbers of a free ray.
Ray128 exactRay(const QueryRay& ray);

/// The ideal ray through (x, y) of a width x height image, in pixels from the upper left corner; pixel (i, j) has its
/// centre at (i + 0.5, j + 0.5). Directions are right to about 1e-33; zeros of an axis-parallel camera stay exact.
Ray128 pixelRay(const Camera& camera, int width, int height, double x, double y);

/// The same for many pixels: what they share is calculated once.
struct PixelGrid {
  PixelGrid(const Camera& camera, int width, int height);
  Ray128 ray(double x, double y) const;

  Camera camera;
  int width, height;
  Real3 center{}, forward{}, right{}, upward{};
  Real halfX = 0, halfY = 0;  // tangents, lengths or radians from the middle to the border
};

enum class Level : std::uint8_t { extended, binary128, exact };

/// `enough`: t to 2^-48 relative, normal and local to 2^-40; `full`: always by exact arithmetic, all of binary128.
enum class Effort { enough, full };

struct Truth {
  bool hit = false;
  Real t = 0;
  /// Unit, geometric, never flipped. At a quadric's singular point (zero gradient) it is -direction/|direction|.
  Real3 normal{};
  /// Triangle: weights of v1, v2, v3; quad: (u, v, 0); all others: the position.
  Real3 local{}, position{};
  /// Relative change of the inputs that might turn the decision (hit or miss, origin inside or outside), in units of
  /// 2^-24: the smallest |form| / sum of its terms' magnitudes. 0: some form is exactly zero.
  double marginUlps = 0;
  /// The same for a box's choice of the face whose normal is reported (lowest axis on an edge); infinite elsewhere.
  double faceMarginUlps = std::numeric_limits<double>::infinity();
  /// A hit only because edges are closed: rim, edge, silhouette touched exactly.
  bool exactlyOnEdge = false;
  Level level = Level::extended;  // of the arithmetic that decided
};

/// One solid. Hits have 0 < t < tMax, both strict; smallest such t.
Truth intersect(const Shape& shape, const Ray128& ray, Effort effort = Effort::enough);

/// Sign of t(a) - t(b) for two solids that the ray hits, exactly: -1, 0, 1.
int compareHits(const Shape& a, const Shape& b, const Ray128& ray);

struct WorldTruth {
  std::int32_t index = -1;  // of the solid hit; -1: none
  Truth truth;
  Real secondT = std::numeric_limits<double>::infinity();  // of the next solid behind (or equal); infinite: none
  /// Smallest margin of all decisions that could change the answer: each solid missed, the one hit, and the gap to
  /// the second in t.
  double marginUlps = std::numeric_limits<double>::infinity();
  bool tie = false;  // another solid has exactly the same t; the earlier is reported
};

WorldTruth cast(const World& world, const Ray128& ray, Effort effort = Effort::enough);

/// Whether one of 8 rays tilted by `angle` (relative to |direction|, all around) gets another hit/miss or solid.
bool flipsWhenTilted(const World& world, const Ray128& ray, double angle);

// --- errors of fp32 results ---------------------------------------------------------------------------------

/// |got - truth| in units of the last place of fp32 at the truth; infinite for NaN, and for infinity unless the truth
/// itself is beyond fp32.
double ulpError(float got, Real truth);
/// Whether round-to-nearest takes it to infinity.
bool beyondFloat(Real truth);
/// Largest component error in units of 2^-23.
double normalError(const std::array<float, 3>& got, const Real3& truth);
/// Largest component error in ulps of the truth's largest component.
double localError(const std::array<float, 3>& got, const Real3& truth);

}  // namespace solidcast::oracle
