#include <cmath>
#include <limits>

#include "tests/catalogue/cases.h"

namespace solidcast::catalogue {
namespace {

Quadric times(double factor, Quadric quadric) {
  for (double& x : quadric.coefficients) x *= factor;
  return quadric;
}

}  // namespace

void addQuadrics(Catalogue& to) {
  const Quadric sphere{{1, 1, 1, 0, 0, 0, 0, 0, 0, -1}}, point{{1, 1, 1, 0, 0, 0, 0, 0, 0, 0}},
      cone{{1, 1, -1, 0, 0, 0, 0, 0, 0, 0}}, cylinder{{1, 1, 0, 0, 0, 0, 0, 0, 0, -1}},
      planes{{1, 0, 0, 0, 0, 0, 0, 0, 0, -1}}, twice{{1, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
      paraboloid{{1, 1, 0, 0, 0, 0, 0, 0, -1, 0}}, saddle{{0, 0, 0, 1, 0, 0, 0, 0, -1, 0}},
      twoSheets{{1, 1, -1, 0, 0, 0, 0, 0, 0, 1}}, hyperbola{{0, 0, 0, 1, 0, 0, 0, 0, 0, -1}};
  addRay(to, "K1", "sphere", {sphere}, {0, 0, 5}, {0, 0, -1});
  addRay(to, "K2", "imaginary", {Quadric{{1, 1, 1, 0, 0, 0, 0, 0, 0, 1}}}, {0, 0, 5}, {0, 0, -1});
  addRay(to, "K3", "a point, exactly", {point}, {5, 0, 0}, {-1, 0, 0});
  addRay(to, "K4", "a point, obliquely past it", {point}, {5, 0, 0}, unit(-1, 0.3, 0.2));
  addRay(to, "K5", "pair of planes", {planes}, {5, 0, 0}, {-1, 0, 0});
  addRay(to, "K6", "pair of planes, parallel to both", {planes}, {5, 0, 0}, {0, 0, 1});
  addRay(to, "K7", "double plane: every hit is a double root", {twice}, {5, 0, 0}, {-1, 0, 0});
  addRay(to, "K8", "double plane, oblique", {twice}, {5, 0, 0}, unit(-1, 0.3, 0.2), Hard::fast);
  addRay(to, "K9", "linear: a plane", {Quadric{{0, 0, 0, 0, 0, 0, 1, 0, 0, 0}}}, {5, 0, 0}, {-1, 0, 0});
  addReject(to, "K10", "all zero", "zero", Quadric{{0, 0, 0, 0, 0, 0, 0, 0, 0, 0}});
  addReject(to, "K11", "constant only", "zero", Quadric{{0, 0, 0, 0, 0, 0, 0, 0, 0, 3}});
  addRay(to, "K12", "cone, its apex exactly: no gradient", {cone}, {5, 0, 0}, {-1, 0, 0});
  addRay(to, "K13", "cone, along a generator: A = B = C = 0", {cone}, {5, 0, 5}, {-1, 0, -1});
  addRay(to, "K14", "cone, parallel to a generator: A = 0", {cone}, {0.75f, 0.5f, -2}, {3, 4, 5});
  addRay(to, "K15", "paraboloid along its axis: A = 0", {paraboloid}, {0.5f, 0.25f, 9}, {0, 0, -1});
  addRay(to, "K16", "paraboloid, 1e-5 off its axis: (-B + sqrt D)/2A cancels", {paraboloid}, {0.5f, 0.25f, 9},
         {1e-5f, 0, -1}, Hard::naive);
  addRay(to, "K17", "z = xy, parallel to a ruling", {saddle}, {2, -1.5f, 4}, {0, 1, 0});
  addRay(to, "K18", "two sheets, parallel to the asymptotic cone", {twoSheets}, {1, 0, 0}, unit(-1, 0, 1), Hard::naive);
  addRay(to, "K19", "between the sheets", {twoSheets}, {5, 0, 0}, {-1, 0, 0});
  addRay(to, "K20", "cylinder, along the axis inside it", {cylinder}, {0.5f, 0, -5}, {0, 0, 1});
  addRay(to, "K21", "cylinder, along the axis in its surface", {cylinder}, {1, 0, -5}, {0, 0, 1});
  addRay(to, "K22", "1e12 x^2 + y^2 + z^2 = 1, head-on: the textbook misses",
         {Quadric{{1e12, 1, 1, 0, 0, 0, 0, 0, 0, -1}}}, {5, 0, 0}, {-1, 0, 0}, Hard::naive);
  addRay(to, "K23", "the same, oblique, a hit near its rim", {Quadric{{1e12, 1, 1, 0, 0, 0, 0, 0, 0, -1}}}, {5, 0, 0},
         unit(-1, 0.19, 0.05), Hard::fast);
  addRay(to, "K24", "the same, just past its rim", {Quadric{{1e12, 1, 1, 0, 0, 0, 0, 0, 0, -1}}}, {5, 0, 0},
         unit(-1, 0.2001, 0), Hard::fast);
  addRay(to, "K25", "sphere times 1e30", {times(1e30, sphere)}, {0, 0, 5}, {0, 0, -1}, Hard::naive);
  addRay(to, "K26", "sphere times 1e-30", {times(1e-30, sphere)}, {0, 0, 5}, {0, 0, -1}, Hard::naive);
  addRay(to, "K27", "sphere times 1e-40: denormal coefficients", {times(1e-40, sphere)}, {0, 0, 5}, {0, 0, -1},
         Hard::naive);
  addRay(to, "K28", "sphere negated: normal inwards", {times(-1, sphere)}, {0, 0, 5}, {0, 0, -1});
  addRay(to, "K29", "sphere at (1e4, 0, 0), expanded: fp32 cannot hold the constant",
         {Quadric{{1, 1, 1, 0, 0, 0, -2e4, 0, 0, 99999999}}}, {1e4f, 0, 5}, {0, 0, -1}, Hard::fast);
  addRay(to, "K30", "xy = 1", {hyperbola}, {3, 2, 0}, unit(-1, -0.8, 0.3));
  addReject(to, "K31", "coefficient NaN", "finite",
            Quadric{{1, 1, 1, 0, std::numeric_limits<double>::quiet_NaN(), 0, 0, 0, 0, -1}});
  addReject(to, "K32", "coefficient infinite", "finite",
            Quadric{{1, std::numeric_limits<double>::infinity(), 1, 0, 0, 0, 0, 0, 0, -1}});
  addRay(to, "K33", "|d| = 1e-10", {sphere}, {0, 0, 5}, {0, 0, -1e-10f}, Hard::naive);
}

}  // namespace solidcast::catalogue
