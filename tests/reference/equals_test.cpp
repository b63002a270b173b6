// Solids that can be written as other solids: different formulas, one answer. In binary128 on random rays.
#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

#include "reference_cpu/build.h"

namespace solidcast::reference {
namespace {

using T = __float128;
using Vec128 = Vec<T>;

/// Casts rays from in and around the solids at both groups.
void expectEqual(const SimpleGroup<T>& one, const SimpleGroup<T>& other, int minimumHits) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-4, 4);
  const auto vec = [&] { return Vec128{uniform(random), uniform(random), uniform(random)}; };
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Ray<T> ray{vec(), vec()};
    const Intersection<T> a = one.intersect(ray, infinity<T>()), b = other.intersect(ray, infinity<T>());
    ASSERT_EQ(bool(a), bool(b)) << i;
    if (!a) continue;
    ++hits;
    ASSERT_LT(double(absolute(a.distance() / b.distance() - 1)), 1e-25) << i;
    ASSERT_LT(double(length(a.normal() - b.normal())), 1e-25) << i;
  }
  EXPECT_GT(hits, minimumHits);
}

SimpleGroup<T> groupOf(std::vector<std::shared_ptr<Primitive<T>>> members) {
  SimpleGroup<T> group;
  for (auto& member : members) group.add(std::move(member));
  return group;
}

TEST(Equal, SphereAndItsQuadric) {
  // (x-1)^2 + (y+0.5)^2 + (z-0.25)^2 = 4
  expectEqual(groupOf({std::make_shared<Sphere<T>>(Vec128{1, T(-0.5), T(0.25)}, T(2))}),
              groupOf({std::make_shared<Quadric<T>>(
                  QuadricCoefficients{1, 1, 1, 0, 0, 0, -2, 1, -0.5, 1 + 0.25 + 0.0625 - 4})}),
              1000);
}

TEST(Equal, BoxAndItsSixQuads) {
  const Vec128 low{-1, T(-0.5), -2}, high{2, 1, T(0.5)}, x{3, 0, 0}, y{0, T(1.5), 0}, z{0, 0, T(2.5)};
  expectEqual(groupOf({std::make_shared<AABox<T>>(low, high)}),
              groupOf({std::make_shared<Quad<T>>(low, z, y), std::make_shared<Quad<T>>(low, x, z),
                       std::make_shared<Quad<T>>(low, y, x), std::make_shared<Quad<T>>(high, -y, -z),
                       std::make_shared<Quad<T>>(high, -z, -x), std::make_shared<Quad<T>>(high, -x, -y)}),
              1000);
}

TEST(Equal, QuadAndItsTwoTriangles) {
  const Vec128 p{-1, T(-1.5), T(0.5)}, a{3, 1, -1}, b{-1, 3, T(1.5)};
  expectEqual(
      groupOf({std::make_shared<Quad<T>>(p, a, b)}),
      groupOf({std::make_shared<Triangle<T>>(p, p + a, p + b), std::make_shared<Triangle<T>>(p + a + b, p + b, p + a)}),
      500);
}

TEST(Equal, PlaneAndItsQuadricAndAHugeDisc) {
  const auto plane = std::make_shared<InfinitePlane<T>>(Vec128{1, T(-0.5), 2}, Vec128{1, 2, -3});
  // x + 2y - 3z + 6 = 0 goes through (1, -0.5, 2).
  expectEqual(groupOf({plane}),
              groupOf({std::make_shared<Quadric<T>>(QuadricCoefficients{0, 0, 0, 0, 0, 0, 1, 2, -3, 6})}), 5000);
  expectEqual(groupOf({plane}), groupOf({std::make_shared<Disc<T>>(Vec128{1, T(-0.5), 2}, Vec128{1, 2, -3}, T(1e9))}),
              5000);
}

}  // namespace
}  // namespace solidcast::reference
