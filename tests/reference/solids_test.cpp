// Each solid by itself, in every number type: rays whose answer is known.
#include <gtest/gtest.h>

#include <string>
#include <typeinfo>

#include "reference_cpu/build.h"

namespace solidcast::reference {
namespace {

template <class T>
class Solids : public testing::Test {
 protected:
  using V = Vec<T>;

  static Intersection<T> hit(const Solid<T>& solid, const V& origin, const V& direction, T best = infinity<T>()) {
    return solid.intersect({origin, direction}, best);
  }
  /// t of the hit, or -1 for a miss.
  static double t(const Solid<T>& solid, const V& origin, const V& direction, T best = infinity<T>()) {
    const Intersection<T> found = hit(solid, origin, direction, best);
    return found ? double(found.distance()) : -1;
  }
  static void expectVec(const V& actual, double x, double y, double z) {
    EXPECT_NEAR(double(actual.x), x, 1e-6);
    EXPECT_NEAR(double(actual.y), y, 1e-6);
    EXPECT_NEAR(double(actual.z), z, 1e-6);
  }
};

struct TypeNames {
  template <class T>
  static std::string GetName(int) {
    if (std::is_same_v<T, float>) return "f32";
    if (std::is_same_v<T, double>) return "f64";
    return std::is_same_v<T, long double> ? "f80" : "f128";
  }
};
using NumberTypes = testing::Types<float, double, long double, __float128>;
TYPED_TEST_SUITE(Solids, NumberTypes, TypeNames);

TYPED_TEST(Solids, DistanceLimitsAreStrictAndTheDirectionsLengthCounts) {
  using T = TypeParam;
  const InfinitePlane<T> plane({0, 0, 0}, {0, 0, 1});
  const AABox<T> box({-1, -1, -1}, {1, 1, 0});
  const Disc<T> disc({0, 0, 0}, {0, 0, 1}, 1);
  const Sphere<T> sphere({0, 0, -1}, 1);
  const Triangle<T> triangle({-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
  const Quad<T> quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  const Quadric<T> quadric({1, 1, 1, 0, 0, 0, 0, 0, 2, 0});
  const Solid<T>* solids[] = {&plane, &box, &disc, &sphere, &triangle, &quad, &quadric};
  for (const Solid<T>* solid : solids) {
    SCOPED_TRACE(typeid(*solid).name());
    EXPECT_EQ(this->t(*solid, {0, 0, 4}, {0, 0, -1}), 4);
    EXPECT_EQ(this->t(*solid, {0, 0, 4}, {0, 0, -2}), 2);
    EXPECT_EQ(this->t(*solid, {0, 0, 4}, {0, 0, T(-0.25)}), 16);
    EXPECT_EQ(this->t(*solid, {0, 0, 4}, {0, 0, -1}, 4), -1);
    EXPECT_EQ(this->t(*solid, {0, 0, 4}, {0, 0, -1}, T(4.001)), 4);
    EXPECT_EQ(this->t(*solid, {0, 0, 4}, {0, 0, 1}), -1);  // behind
    EXPECT_EQ(this->t(*solid, {0, 0, 0}, {0, 0, 1}), -1);  // leaving from the surface: t = 0 is no hit
    this->expectVec(this->hit(*solid, {0, 0, 4}, {0, 0, -2}).normal(), 0, 0, 1);
    this->expectVec(this->hit(*solid, {0, 0, 4}, {0, 0, -2}).hitPoint(), 0, 0, 0);
    EXPECT_EQ(this->hit(*solid, {0, 0, 4}, {0, 0, -2}).solid(), solid);
    EXPECT_FALSE(Intersection<T>::failure());
  }
}

TYPED_TEST(Solids, Plane) {
  using T = TypeParam;
  const InfinitePlane<T> plane({0, -1, 0}, {0, 3, 0});
  this->expectVec(this->hit(plane, {0, 5, 0}, {1, -1, 0}).normal(), 0, 1, 0);
  EXPECT_EQ(this->t(plane, {0, 5, 0}, {1, -1, 0}), 6);
  this->expectVec(this->hit(plane, {0, 5, 0}, {1, -1, 0}).local(), 6, -1, 0);
  this->expectVec(this->hit(plane, {0, -5, 0}, {0, 1, 0}).normal(), 0, 1, 0);  // from behind, not turned
  EXPECT_EQ(this->t(plane, {0, 5, 0}, {1, 0, 0}), -1);                         // parallel
  EXPECT_EQ(this->t(plane, {0, -1, 0}, {1, 0, 0}), -1);                        // in the plane
  EXPECT_EQ(this->t(plane, {0, -1, 0}, {0, -1, 0}), -1);                       // on it
  // A grazing ray: no epsilon makes it a miss.
  EXPECT_NEAR(this->t(plane, {0, 0, 0}, {1, T(-1e-7), 0}), 1e7, 2);
  EXPECT_NEAR(this->t(plane, {0, T(-1) + T(ldexpq(1, -23)), 0}, {0, -1, 0}), 0x1p-23, 1e-12);
}

TYPED_TEST(Solids, PlaneNormalsOfAnyLength) {
  using T = TypeParam;
  for (double length : {1e-30, 1e-3, 1e30}) {
    const InfinitePlane<T> plane({0, 0, -5}, {0, 0, T(length)});
    EXPECT_EQ(this->t(plane, {1, 2, 0}, {0, 0, -1}), 5) << length;
    this->expectVec(this->hit(plane, {0, 0, 0}, {0, 0, -1}).normal(), 0, 0, 1);
    const Disc<T> disc({0, 0, -5}, {0, 0, T(length)}, 1);
    EXPECT_EQ(this->t(disc, {0, 1, 0}, {0, 0, -1}), 5) << length;
    this->expectVec(this->hit(disc, {0, 0, 0}, {0, 0, -1}).normal(), 0, 0, 1);
  }
}

TYPED_TEST(Solids, BoxFacesAndAxisParallelRays) {
  using T = TypeParam;
  const AABox<T> box({1, -1, 1}, {-1, 1, -1});  // corners in any order
  const T below = T(1) - Limits<T>::epsilon, above = T(1) + Limits<T>::epsilon;
  for (T zero : {T(0), T(-0.0)}) {
    for (T x : {T(-1), T(0), below, T(1)}) {
      EXPECT_EQ(this->t(box, {x, 0, -5}, {zero, zero, 1}), 4);  // faces belong to the box, whatever the zero's sign
      EXPECT_EQ(this->t(box, {x, 1, -5}, {zero, zero, 1}), 4);  // edges too
    }
    EXPECT_EQ(this->t(box, {above, 0, -5}, {zero, zero, 1}), -1);
    EXPECT_EQ(this->t(box, {-above, 0, -5}, {zero, zero, 1}), -1);
  }
  this->expectVec(this->hit(box, {0, 0, -5}, {0, 0, 1}).normal(), 0, 0, -1);
  this->expectVec(this->hit(box, {-5, 0, 0}, {1, 0, 0}).normal(), -1, 0, 0);
  this->expectVec(this->hit(box, {0, 5, 0}, {0, -1, 0}).normal(), 0, 1, 0);
  EXPECT_EQ(this->t(box, {-2, 0, 0}, {1, 1, 0}), 1);    // through an edge
  EXPECT_EQ(this->t(box, {-2, -2, -2}, {1, 1, 1}), 1);  // through a corner
  EXPECT_EQ(this->t(box, {-3, 0, 0}, {1, 1, 0}), -1);   // past the edge
  EXPECT_EQ(this->t(box, {-2, 0, 1}, {1, 1, 0}), 1);    // grazes the box in one point of an edge
  this->expectVec(this->hit(box, {-5, 0, 0}, {1, 0, 0}).local(), -1, 0, 0);
}

TYPED_TEST(Solids, BoxFromInside) {
  using T = TypeParam;
  const AABox<T> box({-1, -1, -1}, {1, 1, 1});
  EXPECT_EQ(this->t(box, {0, 0, T(0.5)}, {0, 0, 1}), 0.5);
  this->expectVec(this->hit(box, {0, 0, 0}, {0, 0, 1}).normal(), 0, 0, 1);  // outward
  this->expectVec(this->hit(box, {0, 0, 0}, {-1, 0, 0}).normal(), -1, 0, 0);
  EXPECT_EQ(this->t(box, {0, 0, 1}, {0, 0, -1}), 2);  // from a face inwards: the other face
  EXPECT_EQ(this->t(box, {0, 0, 1}, {0, 0, 1}), -1);
  EXPECT_EQ(this->t(box, {0, 0, 0}, {0, 0, 1}, 1), -1);
}

TYPED_TEST(Solids, FlatAndExtremeBoxes) {
  using T = TypeParam;
  const AABox<T> flat({-1, -1, 0}, {1, 1, 0});
  EXPECT_EQ(this->t(flat, {0, 0, -5}, {0, 0, 1}), 5);
  EXPECT_NEAR(this->t(flat, {0, 0, -5}, {T(0.125), 0, 1}), 5, 1e-6);
  const AABox<T> box({-1, -1, -1}, {1, 1, 1});
  EXPECT_EQ(this->t(box, {1, 0, -5}, {T(1e-39), 0, 1}), -1);  // leaves the slab at once
  EXPECT_EQ(this->t(box, {-1, 0, -5}, {T(1e-39), 0, 1}), 4);  // never leaves it
  EXPECT_EQ(this->t(box, {T(-1.5), 0, -5}, {T(1e-9), 0, 1}), -1);
}

TYPED_TEST(Solids, SphereOutsideInsideAndOn) {
  using T = TypeParam;
  const Sphere<T> sphere({1, 0, 0}, 2);
  EXPECT_EQ(this->t(sphere, {1, 0, 5}, {0, 0, -1}), 3);
  this->expectVec(this->hit(sphere, {1, 0, 5}, {0, 0, -1}).normal(), 0, 0, 1);
  EXPECT_EQ(this->t(sphere, {1, 0, 0}, {0, 1, 0}), 2);  // from the center
  EXPECT_EQ(this->t(sphere, {2, 0, 0}, {1, 0, 0}), 1);
  EXPECT_EQ(this->t(sphere, {2, 0, 0}, {-1, 0, 0}), 3);
  this->expectVec(this->hit(sphere, {2, 0, 0}, {-1, 0, 0}).normal(), -1, 0, 0);  // outward from inside too
  EXPECT_EQ(this->t(sphere, {3, 0, 0}, {-1, 0, 0}), 4);                          // from the surface through the sphere
  EXPECT_EQ(this->t(sphere, {3, 0, 0}, {1, 0, 0}), -1);
  EXPECT_EQ(this->t(sphere, {3, 0, -5}, {0, 0, 1}), 5);  // tangent: the outline belongs to the sphere
  EXPECT_EQ(this->t(sphere, {3 + 4 * Limits<T>::epsilon, 0, -5}, {0, 0, 1}), -1);
  EXPECT_EQ(this->t(sphere, {1, 0, 5}, {0, 0, 1}), -1);      // behind
  EXPECT_EQ(this->t(sphere, {1, 0, 5}, {0, 0, -1}, 3), -1);  // the far side does not stand in for a hit too far
}

TYPED_TEST(Solids, FarAndSmallSpheresKeepTheirOutline) {
  using T = TypeParam;
  const T factor = T(0.9e-4);
  const Sphere<T> far({0, 0, 1e4}, 1);
  EXPECT_NEAR(this->t(far, {0, 0, 0}, {factor, 0, 1}), 9999.5640, 2e-3);
  EXPECT_EQ(this->t(far, {0, 0, 0}, {T(1.01e-4), 0, 1}), -1);
  EXPECT_NEAR(double(dot(this->hit(far, {0, 0, 0}, {factor, 0, 1}).normal(),
                         this->hit(far, {0, 0, 0}, {factor, 0, 1}).normal())),
              1, 1e-6);
}

TYPED_TEST(Solids, DiscRimBelongsToIt) {
  using T = TypeParam;
  const Disc<T> disc({2, 0, 0}, {0, 0, -3}, 5);
  EXPECT_EQ(this->t(disc, {2, 0, 4}, {0, 0, -1}), 4);
  EXPECT_EQ(this->t(disc, {7, 0, 4}, {0, 0, -1}), 4);
  EXPECT_EQ(this->t(disc, {5, 4, 4}, {0, 0, -1}), 4);  // 3, 4, 5
  EXPECT_EQ(this->t(disc, {7 + 8 * Limits<T>::epsilon, 0, 4}, {0, 0, -1}), -1);
  EXPECT_EQ(this->t(disc, {0, 0, 0}, {1, 0, 0}), -1);  // in its plane
  this->expectVec(this->hit(disc, {2, 0, 4}, {0, 0, -1}).normal(), 0, 0, -1);
  this->expectVec(this->hit(disc, {3, 1, 4}, {0, 0, -1}).local(), 3, 1, 0);
  // Radii whose squares leave fp32's range.
  const Disc<T> huge({0, 0, 0}, {0, 0, 1}, T(1e20)), tiny({0, 0, 0}, {0, 0, 1}, T(1e-25));
  EXPECT_EQ(this->t(huge, {T(9e19), 0, 4}, {0, 0, -1}), 4);
  EXPECT_EQ(this->t(tiny, {T(1e-24), 0, 4}, {0, 0, -1}), -1);
}

TYPED_TEST(Solids, TriangleWeightsAndEdges) {
  using T = TypeParam;
  const Triangle<T> triangle({0, 0, 0}, {4, 0, 0}, {0, 4, 0});
  this->expectVec(this->hit(triangle, {1, 2, 3}, {0, 0, -1}).local(), 0.25, 0.25, 0.5);
  this->expectVec(this->hit(triangle, {1, 2, -3}, {0, 0, 1}).local(), 0.25, 0.25, 0.5);  // from behind as well
  this->expectVec(this->hit(triangle, {1, 2, -3}, {0, 0, 1}).normal(), 0, 0, 1);
  this->expectVec(this->hit(triangle, {4, 0, 3}, {0, 0, -1}).local(), 0, 1, 0);
  for (const Vec<T>& p : {Vec<T>{0, 0, 3}, {4, 0, 3}, {0, 4, 3}, {2, 0, 3}, {0, 3, 3}, {1, 3, 3}})
    EXPECT_EQ(this->t(triangle, p, {0, 0, -1}), 3) << double(p.x) << " " << double(p.y);
  const T e = T(ldexpq(1, -20));
  for (const Vec<T>& p : {Vec<T>{-e, 1, 3}, {1, -e, 3}, {2, 2 + e, 3}, {4 + e, 0, 3}, {5, 5, 3}})
    EXPECT_EQ(this->t(triangle, p, {0, 0, -1}), -1) << double(p.x) << " " << double(p.y);
  EXPECT_EQ(this->t(triangle, {-1, 1, 0}, {1, 0, 0}), -1);  // in its plane
  const Triangle<T> small({0, 0, 0}, {T(1e-4), 0, 0}, {0, T(1e-4), 0});
  EXPECT_EQ(this->t(small, {T(2e-5), T(2e-5), 1}, {0, 0, -1}), 1);  // no epsilon deletes it
}

TYPED_TEST(Solids, NoRaySlipsBetweenTrianglesThatShareAnEdge) {
  using T = TypeParam;
  const Vec<T> a{T(-1.1), T(-0.3), T(0.2)}, b{T(0.7), T(1.3), T(-0.4)}, c{T(1.9), T(-1.7), T(0.1)},
      d{T(-1.3), T(2.1), T(0.3)};
  const Triangle<T> first(a, b, c), second(b, a, d);
  const Vec<T> eye{T(0.123), T(-0.456), T(7.89)};
  for (int i = 1; i < 2000; ++i) {
    const T s = T(i) / 2000;
    const Ray<T> ray{eye, a + s * (b - a) - eye};
    EXPECT_TRUE(first.intersect(ray, infinity<T>()) || second.intersect(ray, infinity<T>())) << i;
  }
}

TYPED_TEST(Solids, QuadCoordinatesAndEdges) {
  using T = TypeParam;
  const Quad<T> quad({1, 1, 0}, {4, 0, 0}, {2, 2, 0});
  this->expectVec(this->hit(quad, {4, 2, 3}, {0, 0, -1}).local(), 0.5, 0.5, 0);
  this->expectVec(this->hit(quad, {4, 2, -3}, {0, 0, 1}).local(), 0.5, 0.5, 0);
  this->expectVec(this->hit(quad, {4, 2, -3}, {0, 0, 1}).normal(), 0, 0, 1);
  for (const Vec<T>& p : {Vec<T>{1, 1, 3}, {5, 1, 3}, {3, 3, 3}, {7, 3, 3}, {2, 2, 3}, {6, 2, 3}, {5, 3, 3}, {2, 1, 3}})
    EXPECT_EQ(this->t(quad, p, {0, 0, -1}), 3) << double(p.x) << " " << double(p.y);
  const T e = T(ldexpq(1, -20));
  for (const Vec<T>& p : {Vec<T>{2 - e, 2, 3}, {6 + e, 2, 3}, {4, 1 - e, 3}, {4, 3 + e, 3}})
    EXPECT_EQ(this->t(quad, p, {0, 0, -1}), -1) << double(p.x) << " " << double(p.y);
  const Quad<T> mirrored({1, 1, 0}, {2, 2, 0}, {4, 0, 0});
  this->expectVec(this->hit(mirrored, {4, 2, 3}, {0, 0, -1}).normal(), 0, 0, -1);
}

}  // namespace
}  // namespace solidcast::reference
