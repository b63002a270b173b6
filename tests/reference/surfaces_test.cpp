// Bounds, areas and uniform samples of every solid, against closed forms, integrals and statistics.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <typeinfo>
#include <vector>

#include "reference_cpu/build.h"

namespace solidcast::reference {
namespace {

using V = Vec<double>;
using SolidPtr = std::shared_ptr<Solid<double>>;

// x^2/9 + y^2/4 + z^2 = 1 moved to (1, -2, 3): a scalene ellipsoid whose area has no elementary form.
const QuadricCoefficients movedEllipsoid{1 / 9.0, 1 / 4.0, 1, 0, 0, 0, -2 / 9.0, 1, -6, 1 / 9.0 + 1 + 9 - 1};
// Turned by 45 degrees in the plane z = 0: semi-axes 2 along (1,1,0), 1 along (1,-1,0) and 0.5 along z.
const QuadricCoefficients turnedEllipsoid{0.625, 0.625, 4, -0.75, 0, 0, 0, 0, 0, -1};

std::vector<SolidPtr> finiteSolids() {
  return {std::make_shared<Sphere<double>>(V{1, -2, 3}, 1.5),
          std::make_shared<AABox<double>>(V{-1, 2, 5}, V{2, 1, -2}),
          std::make_shared<Disc<double>>(V{1, 2, 3}, V{1, -2, 0.5}, 2.5),
          std::make_shared<Disc<double>>(V{1, 2, 3}, V{0, 0, -2}, 2.5),
          std::make_shared<Triangle<double>>(V{0, 1, 2}, V{3, -1, 1}, V{1, 4, -2}),
          std::make_shared<Quad<double>>(V{1, 1, 1}, V{2, -1, 0.5}, V{0.5, 3, -1}),
          std::make_shared<Quadric<double>>(movedEllipsoid),
          std::make_shared<Quadric<double>>(turnedEllipsoid)};
}

void expectNear(const V& a, const V& b, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

/// Area and mean of f over the ellipsoid with semi-axes a, b, c along the axes, by a fine midpoint rule.
struct Integral {
  double area = 0, mean = 0;
};
Integral overEllipsoid(double a, double b, double c, const std::function<double(V)>& f) {
  Integral integral;
  constexpr int n = 800;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double polar = M_PI * (i + 0.5) / n, turn = 2 * M_PI * (k + 0.5) / n;
      const double x = std::sin(polar) * std::cos(turn), y = std::sin(polar) * std::sin(turn), z = std::cos(polar);
      const double element = std::sin(polar) * (M_PI / n) * (2 * M_PI / n) *
                             std::sqrt(b * b * c * c * x * x + a * a * c * c * y * y + a * a * b * b * z * z);
      integral.area += element;
      integral.mean += element * f({a * x, b * y, c * z});
    }
  integral.mean /= integral.area;
  return integral;
}

TEST(Area, ClosedForms) {
  const auto solids = finiteSolids();
  const double expected[] = {4 * M_PI * 2.25, 2 * (3 * 1 + 3 * 7 + 1 * 7), M_PI * 6.25, M_PI * 6.25,
                             // |(3,-2,-1) x (1,3,-4)| / 2 = |(11, 11, 11)| / 2
                             11 * std::sqrt(3.0) / 2,
                             // |(2,-1,0.5) x (0.5,3,-1)| = |(-0.5, 2.25, 6.5)|
                             std::sqrt(0.25 + 5.0625 + 42.25)};
  for (std::size_t i = 0; i < std::size(expected); ++i) EXPECT_NEAR(solids[i]->getArea(), expected[i], 1e-13 * 100);
  EXPECT_EQ(InfinitePlane<double>({0, 0, 0}, {0, 1, 0}).getArea(), infinity<double>());
}

TEST(Area, Ellipsoids) {
  EXPECT_NEAR(Quadric<double>({1, 1, 1, 0, 0, 0, 0, 0, 0, -4}).getArea(), 16 * M_PI, 1e-13);
  // Spheroids: oblate with a = 2, c = 1 and prolate with a = 1, c = 3 (closed forms).
  const double e1 = std::sqrt(1 - 1 / 4.0), e2 = std::sqrt(1 - 1 / 9.0);
  EXPECT_NEAR(Quadric<double>({1 / 4.0, 1 / 4.0, 1, 0, 0, 0, 0, 0, 0, -1}).getArea(),
              2 * M_PI * 4 * (1 + (1 - e1 * e1) / e1 * std::atanh(e1)), 1e-13);
  EXPECT_NEAR(Quadric<double>({1, 1, 1 / 9.0, 0, 0, 0, 0, 0, 0, -1}).getArea(), 2 * M_PI * (1 + 3 / e2 * std::asin(e2)),
              1e-13);
  EXPECT_NEAR(Quadric<double>(movedEllipsoid).getArea(), overEllipsoid(3, 2, 1, [](V) { return 0; }).area, 1e-3);
  EXPECT_NEAR(Quadric<double>(turnedEllipsoid).getArea(), overEllipsoid(2, 1, 0.5, [](V) { return 0; }).area, 1e-3);
  // A needle of 1e6 : 1 : 1 is a prolate spheroid too; a coin's area tends to twice its disc.
  EXPECT_NEAR(Quadric<double>({1e-12, 1, 1, 0, 0, 0, 0, 0, 0, -1}).getArea() / (M_PI * M_PI * 1e6), 1, 1e-9);
  EXPECT_NEAR(Quadric<double>({1, 1, 1e12, 0, 0, 0, 0, 0, 0, -1}).getArea() / (2 * M_PI), 1, 1e-9);
  // Barely an ellipsoid: (x + y)^2 + 2^-52 y^2 + z^2 = 1 has the semi-axes 2^26.5, 1 and sqrt(1/2): a needle's area is
  // pi/2 times its length's half times the girth, here 5.40258.
  EXPECT_NEAR(
      Quadric<double>({1, 1 + 0x1p-52, 1, 2, 0, 0, 0, 0, 0, -1}).getArea() / (M_PI / 2 * std::exp2(26.5) * 5.40258), 1,
      1e-5);
  for (const QuadricCoefficients& endless : {QuadricCoefficients{1, 1, 0, 0, 0, 0, 0, 0, 0, -1},
                                             {1, 1, -1, 0, 0, 0, 0, 0, 0, 0},
                                             {1, 1, 0, 0, 0, 0, 0, 0, -1, 0},
                                             {0, 0, 0, 0, 0, 0, 1, 0, 0, 0}})
    EXPECT_EQ(Quadric<double>(endless).getArea(), infinity<double>());
  EXPECT_EQ(Quadric<double>({1, 1, 1, 0, 0, 0, 0, 0, 0, 0}).getArea(), 0);  // a point
  EXPECT_EQ(Quadric<double>({1, 1, 1, 0, 0, 0, 0, 0, 0, 1}).getArea(), 0);  // nothing
}

TEST(Bounds, HoldEverySampleAndAreTouched) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform;
  for (const SolidPtr& solid : finiteSolids()) {
    SCOPED_TRACE(typeid(*solid).name());
    const BBox<double> bounds = solid->getBounds();
    ASSERT_FALSE(bounds.isUnbounded());
    BBox<double> seen;
    for (int i = 0; i < 6000; ++i) seen.extend(solid->sample(uniform(random), uniform(random)));
    const double slack = 1e-12;
    const V size = bounds.max - bounds.min;
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(seen.min[axis], bounds.min[axis] - slack);
      EXPECT_LE(seen.max[axis], bounds.max[axis] + slack);
      EXPECT_LE(seen.min[axis], bounds.min[axis] + 0.04 * size[axis]);
      EXPECT_GE(seen.max[axis], bounds.max[axis] - 0.04 * size[axis]);
    }
  }
}

TEST(Bounds, OfQuadrics) {
  const BBox<double> moved = Quadric<double>(movedEllipsoid).getBounds();
  expectNear(moved.min, {-2, -4, 2}, 1e-14);
  expectNear(moved.max, {4, 0, 4}, 1e-14);
  QuadricCoefficients negated = movedEllipsoid;
  for (double& value : negated) value = -value;
  EXPECT_EQ(Quadric<double>(negated).getBounds().max, moved.max);
  const double reach = std::sqrt(2.5);  // of the turned one: sqrt((2^2 + 1^2) / 2)
  expectNear(Quadric<double>(turnedEllipsoid).getBounds().max, {reach, reach, 0.5}, 1e-15);
  // Unbounded: cylinder, cone, paraboloid, hyperboloids, planes, an exactly singular mixed form.
  for (const QuadricCoefficients& endless : {QuadricCoefficients{1, 0, 1, 0, 0, 0, -4, 0, 0, 2},
                                             {1, 1, -1, 0, 0, 0, 0, 0, 0, 0},
                                             {0, 1, 1, 0, 0, 0, -0.25, 4, -2, 4},
                                             {1, 1, -1, 0, 0, 0, 0, 0, 0, -1},
                                             {1, -1, -1, 0, 0, 0, 0, 0, 0, -1},
                                             {0, 0, 0, 0, 0, 0, 1, 2, 3, 4},
                                             {1, 1, 1, 2, 0, 0, 0, 0, 0, -1},
                                             {0.1, 0.4, 1, 0.4, 0, 0, 0, 0, 0, -1}}) {
    const BBox<double> bounds = Quadric<double>(endless).getBounds();
    EXPECT_TRUE(bounds.isUnbounded());
    EXPECT_TRUE(bounds.contains({1e30, -1e30, 1e30}));
  }
  // (x + 2y + 4z)^2 + (3x + y - z)^2 = 1 is a cylinder, whatever it is multiplied with: its determinant is all rounding.
  for (double factor :
       {0x1.23456789abdp0, 0x1.fedcba98765p-3, 0x1.0f1e2d3c4b5p7, 0x1.89abcdef013p0, 0x1.7e151628aedp1}) {
    QuadricCoefficients cylinder{10, 5, 17, 10, 2, 14, 0, 0, 0, -1};
    for (double& value : cylinder) value *= factor;
    EXPECT_TRUE(Quadric<double>(cylinder).getBounds().isUnbounded()) << factor;
    EXPECT_EQ(Quadric<double>(cylinder).getArea(), infinity<double>()) << factor;
  }
  const BBox<double> point = Quadric<double>({1, 1, 1, 0, 0, 0, -2, 0, 0, 1}).getBounds();
  EXPECT_EQ(point.min, (V{1, 0, 0}));
  EXPECT_EQ(point.max, (V{1, 0, 0}));
  EXPECT_TRUE(Quadric<double>({1, 1, 1, 0, 0, 0, 0, 0, 0, 1}).getBounds().isEmpty());
}

TEST(Bounds, OfPlanes) {
  EXPECT_TRUE(InfinitePlane<double>({0, 3, 0}, {1, 2, 0}).getBounds().contains({1e300, -1e300, 5}));
  const BBox<double> level = InfinitePlane<double>({0, 3, 0}, {0, -2, 0}).getBounds();
  EXPECT_TRUE(level.isUnbounded());
  EXPECT_TRUE(level.contains({1e300, 3, -1e300}));
  EXPECT_FALSE(level.contains({0, 3.0001, 0}));
}

TEST(Bounds, OfGroups) {
  auto inner = std::make_shared<SimpleGroup<double>>();
  inner->add(std::make_shared<Sphere<double>>(V{5, 0, 0}, 1));
  inner->add(std::make_shared<Quadric<double>>(QuadricCoefficients{1, 1, 1, 0, 0, 0, 0, 0, 0, 1}));  // nothing
  inner->rebuildIndex();
  SimpleGroup<double> outer;
  EXPECT_TRUE(outer.getBounds().isEmpty());
  outer.add(inner);
  outer.add(std::make_shared<Sphere<double>>(V{-5, 0, 0}, 2));
  outer.rebuildIndex();
  EXPECT_EQ(outer.getBounds().min, (V{-7, -2, -2}));
  EXPECT_EQ(outer.getBounds().max, (V{6, 2, 2}));
  outer.add(std::make_shared<InfinitePlane<double>>(V{0, -9, 0}, V{0, 1, 0}));
  outer.rebuildIndex();
  EXPECT_TRUE(outer.getBounds().isUnbounded());
  EXPECT_EQ(outer.getBounds().min.y, -9);
}

TEST(Sample, PointsLieOnTheSurface) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform;
  for (const SolidPtr& solid : finiteSolids()) {
    SCOPED_TRACE(typeid(*solid).name());
    for (int i = 0; i < 300; ++i) {
      // A ray towards the sample from a random side must find the surface there (or nearer, on a closed solid).
      const V p = solid->sample(uniform(random), uniform(random));
      const V side = normalized(V{uniform(random) - 0.5, uniform(random) - 0.5, uniform(random) - 0.5});
      double nearest = infinity<double>();
      V origin = p + 1e-3 * side;
      for (const V& offset :
           {V{0, 0, 0}, 1e-9 * V{1, 0, 0}, 1e-9 * V{-1, 1, 0}, 1e-9 * V{-1, -1, 1}, 1e-9 * V{-1, -1, -1}})
        if (const auto hit = solid->intersect({origin + offset, -side}, 1))
          nearest = std::min(nearest, std::abs(hit.distance() - 1e-3));
      EXPECT_LT(nearest, 1e-6) << i;
    }
  }
}

/// The mean of f over n samples must be the expected mean within 5 standard errors.
void expectMean(const Solid<double>& solid, const std::function<double(V)>& f, double expected, const char* what) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> uniform;
  constexpr int n = 8000;
  double sum = 0, squares = 0;
  for (int i = 0; i < n; ++i) {
    const double value = f(solid.sample(uniform(random), uniform(random)));
    sum += value;
    squares += value * value;
  }
  const double mean = sum / n, spread = std::sqrt(std::max(0.0, squares / n - mean * mean) / n);
  EXPECT_NEAR(mean, expected, 5 * spread + 1e-12) << what;
}

TEST(Sample, IsUniformByArea) {
  const auto solids = finiteSolids();
  const auto fromCenter = [](V center) { return [=](V p) { return dot(p - center, p - center); }; };
  // Sphere: z uniform over its range, so z > c + r/2 has a quarter of the area.
  expectMean(
      *solids[0], [](V p) { return p.z > 3.75; }, 0.25, "sphere cap");
  expectMean(
      *solids[0], [](V p) { return p.x > 1 && p.y > -2; }, 0.25, "sphere wedge");
  // Box 3 x 1 x 7: shares of the faces in 62, and a half of one face.
  expectMean(
      *solids[1], [](V p) { return p.z == 5; }, 3 / 62.0, "box +z");
  expectMean(
      *solids[1], [](V p) { return p.z == -2; }, 3 / 62.0, "box -z");
  expectMean(
      *solids[1], [](V p) { return p.y == 1; }, 21 / 62.0, "box -y");
  expectMean(
      *solids[1], [](V p) { return p.y == 2 && p.z > 1.5; }, 10.5 / 62.0, "half of box +y");
  expectMean(
      *solids[1], [](V p) { return p.x == 2 && p.y > 1.5; }, 3.5 / 62.0, "half of box +x");
  expectMean(
      *solids[1], [](V p) { return p.x == -1; }, 7 / 62.0, "box -x");
  // Disc: the inner half of the radius has a quarter of the area; half a turn has a half.
  expectMean(
      *solids[2],
      [&](V p) {
        return fromCenter({1, 2, 3})(p) < 1.5625;
      },
      0.25, "disc middle");
  expectMean(
      *solids[2], [](V p) { return p.z > 3; }, 0.5, "half disc");
  // Triangle: the mean is the centroid, and the quarter triangle at v1 has a quarter of the area.
  expectMean(
      *solids[4], [](V p) { return p.x; }, 4 / 3.0, "triangle x");
  expectMean(
      *solids[4], [](V p) { return p.y; }, 4 / 3.0, "triangle y");
  expectMean(
      *solids[4],
      [&](V p) {
        return solids[4]->intersect({p + V{1, 1, 1}, {-1, -1, -1}}, 9).local().x > 0.5;
      },
      0.25, "triangle corner");
  expectMean(
      *solids[5], [](V p) { return p.x; }, 2.25, "quad x");
  expectMean(
      *solids[5],
      [&](V p) {
        const V n = cross(V{2, -1, 0.5}, V{0.5, 3, -1});
        const V uv = solids[5]->intersect({p + n, -n}, 9).local();
        return uv.x < 0.3 && uv.y > 0.8;
      },
      0.06, "quad corner");
  // Ellipsoids: moments and a cap by integration.
  const V c{1, -2, 3};
  for (int axis = 0; axis < 3; ++axis) {
    const auto square = [=](V p) { return p[axis] * p[axis]; };
    expectMean(
        *solids[6], [=](V p) { return square(p - c); }, overEllipsoid(3, 2, 1, square).mean, "ellipsoid");
    expectMean(
        *solids[6], [=](V p) { return p[axis] - c[axis]; }, 0, "ellipsoid's middle");
  }
  expectMean(
      *solids[6], [=](V p) { return p.x - c.x > 2 && p.y > c.y; },
      overEllipsoid(3, 2, 1, [](V p) { return p.x > 2 && p.y > 0; }).mean, "ellipsoid's end");
  const auto along = [](V p) { return (p.x + p.y) * (p.x + p.y) / 2; };
  expectMean(*solids[7], along, overEllipsoid(2, 1, 0.5, [](V p) { return p.x * p.x; }).mean, "turned ellipsoid");
}

TEST(Sample, IsRefusedWithoutAFiniteArea) {
  const InfinitePlane<double> plane({0, 0, 0}, {0, 1, 0});
  const Quadric<double> cylinder({1, 1, 0, 0, 0, 0, 0, 0, 0, -1});
  const AABox<double> point({1, 1, 1}, {1, 1, 1});
  for (const Solid<double>* solid :
       {static_cast<const Solid<double>*>(&plane), static_cast<const Solid<double>*>(&cylinder),
        static_cast<const Solid<double>*>(&point)})
    EXPECT_THROW(solid->sample(0.5, 0.5), Error);
}

TEST(Sample, TheSquaresCornersGiveFinitePoints) {
  const double nearlyOne = std::nextafter(1.0, 0.0);
  auto solids = finiteSolids();
  solids.push_back(std::make_shared<AABox<double>>(V{0, 0, 0}, V{0, 2, 3}));  // flat
  solids.push_back(std::make_shared<Quadric<double>>(QuadricCoefficients{1e-12, 1, 1e12, 0, 0, 0, 0, 0, 0, -1}));
  for (const SolidPtr& solid : solids)
    for (double u : {0.0, 0.5, nearlyOne})
      for (double v : {0.0, 0.25, nearlyOne}) {
        const V p = solid->sample(u, v);
        const BBox<double> bounds = solid->getBounds();
        const V slack = 1e-9 * (bounds.max - bounds.min) + 1e-12 * V{1, 1, 1};
        EXPECT_TRUE((BBox<double>{bounds.min - slack, bounds.max + slack}).contains(p)) << u << " " << v;
      }
}

TEST(Solid, KeepsMaterialAndCoordMapper) {
  Sphere<double> sphere({0, 0, 0}, 1);
  EXPECT_FALSE(sphere.material());
  const std::shared_ptr<int> owner = std::make_shared<int>(1);
  const std::shared_ptr<Material> material(owner, reinterpret_cast<Material*>(owner.get()));
  const std::shared_ptr<CoordMapper> mapper(owner, reinterpret_cast<CoordMapper*>(owner.get()));
  sphere.setMaterial(material);
  sphere.setCoordMapper(mapper);
  EXPECT_EQ(sphere.material(), material);
  EXPECT_EQ(sphere.coordMapper(), mapper);
}

}  // namespace
}  // namespace solidcast::reference
