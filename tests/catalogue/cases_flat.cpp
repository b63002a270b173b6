#include <cmath>
#include <limits>

#include "tests/catalogue/cases.h"

namespace solidcast::catalogue {
namespace {

Triple unitTriple(double x, double y, double z) {
  const double length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

}  // namespace

void addPlanes(Catalogue& to) {
  const InfinitePlane ground{{0, 0, 0}, {0, 1, 0}};
  addRay(to, "P1", "grazing at 1e-7: tests for small n.d miss", {ground}, {0, 1, 0}, unit(1, -1e-7, 0), Hard::naive);
  addRay(to, "P2", "parallel", {ground}, {0, 1, 0}, {1, 0, 0});
  addRay(to, "P3", "inside the plane", {ground}, {3, 0, 1}, {1, 0, 0});
  addRay(to, "P4", "origin on the plane: t = 0 is no hit", {ground}, {3, 0, 1}, {1, 1, 0});
  addRay(to, "P5", "oblique, 1e7 away: n.o + D cancels", {InfinitePlane{{1e7, 0, -1e7}, unitTriple(1, 1, 1)}},
         {1e7f, 1, -1e7f + 1}, unit(-1, -0.5, -0.4), Hard::naive);
  addRay(to, "P6", "oblique, 1e6 away: n.o + D is off by 1.2e6 ulp",
         {InfinitePlane{{1e6, -2e6, 3e6}, unitTriple(0.3, 0.8, -0.5)}}, {1e6f + 3, -2e6f + 4, 3e6f + 5},
         unit(-0.1, -1, 0.2), Hard::naive);
  addRay(to, "P7", "1e-6 off an oblique plane: n.d cancels", {InfinitePlane{{0, 0, 0}, unitTriple(0.3, 0.8, -0.5)}},
         {2, 4, -7}, unit(0.8 - 0.3e-6, -0.3 - 0.8e-6, 0.5e-6), Hard::fast);
  addRay(to, "P8", "1e-30 away: epsilons miss", {InfinitePlane{{0, 0, 1e-30}, {0, 0, 1}}}, {}, {0, 0, 1}, Hard::naive);
  addRay(to, "P9", "normal of length 1e10 at 1e30: products overflow fp32", {InfinitePlane{{0, 1e30, 0}, {0, 1e10, 0}}},
         {}, {0, 1, 0}, Hard::naive);
  addRay(to, "P10", "t = 3e38", {InfinitePlane{{0, 0, 3e38}, {0, 0, 1}}}, {}, {0, 0, 1}, Hard::naive);
  addRay(to, "P11", "t = 6.7e38 is beyond fp32", {InfinitePlane{{0, 0, 3.35e38}, {0, 0, 1}}}, {}, {0, 0, 0.5f},
         Hard::fast);
  addReject(to, "P12", "zero normal", "zero", InfinitePlane{{0, 0, 0}, {0, 0, 0}});
}

void addBoxes(Catalogue& to) {
  const AABox cube{{-1, -1, -1}, {1, 1, 1}};
  const float up1 = std::nextafter(1.f, 2.f);
  addRay(to, "B1", "along the +x face: 0 * inf is NaN in slab tests", {cube}, {1, 0, -5}, {0, 0, 1}, Hard::naive);
  addRay(to, "B2", "along the -x face", {cube}, {-1, 0, -5}, {0, 0, 1}, Hard::naive);
  addRay(to, "B3", "along an edge", {cube}, {1, 1, -5}, {0, 0, 1}, Hard::naive);
  addRay(to, "B4", "negative zeros", {cube}, {0, 0, -5}, {-0.f, -0.f, 1}, Hard::naive);
  addRay(to, "B5", "negative zero along the +x face", {cube}, {1, 0, -5}, {-0.f, 0, 1}, Hard::naive);
  addRay(to, "B6", "1 ulp beside the face", {cube}, {up1, 0, -5}, {0, 0, 1});
  addRay(to, "B7", "through two corners", {cube}, {-3, -3, -3}, unit(1, 1, 1));
  addRay(to, "B8", "touches an edge", {cube}, {3, 0, -1}, {-1, 0, 1});
  addRay(to, "B9", "no thickness, head-on", {AABox{{-1, -1, 0}, {1, 1, 0}}}, {0, 0, -5}, {0, 0, 1});
  addRay(to, "B10", "no thickness, oblique", {AABox{{-1, -1, 0}, {1, 1, 0}}}, {0, 0, -5}, unit(0.1, 0.07, 1));
  addRay(to, "B11", "a point", {AABox{{0, 0, 0}, {0, 0, 0}}}, {0, 0, -5}, {0, 0, 1}, Hard::naive);
  addRay(to, "B12", "from inside", {cube}, {0.1f, 0.2f, 0.3f}, unit(0.7, 0.5, -0.6));
  addRay(to, "B13", "on a face, leaving", {cube}, {1, 0.25f, 0}, {1, 0, 0});
  addRay(to, "B14", "on a face, entering", {cube}, {1, 0.25f, 0}, {-1, 0, 0}, Hard::naive);
  addRay(to, "B15", "d.x = 1e-9, outside the slab", {cube}, {-1.5f, 0, -5}, {1e-9f, 0, 1});
  addRay(to, "B16", "d.x = 1e-9, a long box: skipping small components misses", {AABox{{-1, -1, 5e8}, {1, 1, 6e8}}},
         {-1.5f, 0, -14}, {1e-9f, 0, 1}, Hard::naive);
  addRay(to, "B17", "d.x denormal", {cube}, {0, 0, -5}, {1e-39f, 0, 1}, Hard::naive);
  addRay(to, "B18", "d.x denormal, leaving along the +x face", {cube}, {1, 0, -5}, {1e-39f, 0, 1}, Hard::fast);
  addRay(to, "B19", "extents of 3e38, from inside", {AABox{{-3e38, -3e38, -3e38}, {3e38, 3e38, 3e38}}}, {0, 0, 0},
         {0, 0, 1}, Hard::naive);
  addRay(to, "B20", "extents of 3e38, t = 5e38 is beyond fp32", {AABox{{-3e38, -3e38, -3e38}, {3e38, 3e38, 3e38}}},
         {0, 0, -2e38f}, {0, 0, 1}, Hard::fast);
  addRay(to, "B21", "corners in falling order", {AABox{{1, 1, 1}, {-1, -1, -1}}}, {0, 0, -5}, {0, 0, 1});
}

void addDiscsAndQuads(Catalogue& to) {
  const Disc disc{{0, 0, 0}, {0, 0, 1}, 1};
  addRay(to, "D1", "head-on", {disc}, {0.25f, 0.5f, -5}, {0, 0, 1});
  addRay(to, "D2", "the rim exactly", {disc}, {1, 0, -5}, {0, 0, 1});
  addRay(to, "D3", "1 ulp beyond the rim", {disc}, {std::nextafter(1.f, 2.f), 0, -5}, {0, 0, 1}, Hard::naive);
  addRay(to, "D4", "in its plane", {disc}, {-5, 0, 0}, {1, 0, 0});
  addReject(to, "D5", "radius 0", "positive", Disc{{0, 0, 0}, {0, 0, 1}, 0});
  addRay(to, "D6", "oblique, 1e6 away", {Disc{{1e6, -1e6, 1e6}, unitTriple(0.3, 0.8, -0.5), 3}},
         {1e6f + 1, -1e6f + 5, 1e6f - 1}, unit(-0.1, -1, 0.1), Hard::naive);
  addRay(to, "D7", "radius 1e-3 at 1e4", {Disc{{0, 0, 1e4}, {0, 0, 1}, 1e-3}}, {}, unit(0.9e-7, 0, 1), Hard::naive);
  addRay(to, "D8", "radius 1e20: squares overflow", {Disc{{0, 0, 0}, {0, 0, 1}, 1e20}}, {5e19f, 5e19f, -1e20f},
         {0, 0, 1}, Hard::naive);
  addRay(to, "D9", "radius 1e-25: squares vanish, a false hit", {Disc{{0, 0, 0}, {0, 0, 1}, 1e-25}},
         {1.5e-25f, 0, -1e-24f}, {0, 0, 1}, Hard::fast);

  const Quad quad{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}};
  // Diagonals are spans of nearly the same direction; their middle is at (1, angle / 2).
  const auto narrow = [](double angle) { return Quad{{0, 0, 0}, {1, 0, 0}, {1, angle, 0}}; };
  const auto middle = [](double angle) { return static_cast<float>(angle / 2); };
  addRay(to, "Q1", "the centre", {quad}, {0, 0, -5}, {0, 0, 1});
  addRay(to, "Q2", "a corner exactly", {quad}, {1, 1, -5}, {0, 0, 1});
  addRay(to, "Q3", "an edge exactly", {quad}, {1, 0.25f, -5}, {0, 0, 1});
  addRay(to, "Q4", "spans 1e-3 apart", {narrow(1e-3)}, {1, middle(1e-3), -5}, {0, 0, 1}, Hard::naive);
  addRay(to, "Q5", "spans 1e-5 apart", {narrow(1e-5)}, {1, middle(1e-5), -5}, {0, 0, 1}, Hard::fast);
  addRay(to, "Q6", "spans 1e-6 apart: 99.8 % missed by the textbook", {narrow(1e-6)}, {1, middle(1e-6), -5},
         unit(0.01, 0, 1), Hard::fast);
  addReject(to, "Q7", "parallel spans", "parallel", Quad{{0, 0, 0}, {1, 2, 3}, {-2, -4, -6}});
  addRay(to, "Q8", "sides of 1e-5", {Quad{{0, 0, 0}, {1e-5, 0, 0}, {0, 1e-5, 0}}}, {5e-6f, 5e-6f, -1}, {0, 0, 1},
         Hard::naive);
  addRay(to, "Q9", "sides of 1e-12: |n|^2 underflows", {Quad{{0, 0, 0}, {1e-12, 0, 0}, {0, 1e-12, 0}}},
         {5e-13f, 5e-13f, -1}, {0, 0, 1}, Hard::naive);
  addRay(to, "Q10", "sides of 1e10: |n|^2 overflows", {Quad{{-5e9, -5e9, 0}, {1e10, 0, 0}, {0, 1e10, 0}}},
         {1e9f, -1e9f, -5}, {0, 0, 1}, Hard::naive);
  addRay(to, "Q11", "1e6 away", {Quad{{1e6, 1e6, 1e6}, {3, 0.5, 0.2}, {-0.4, 2, 0.1}}}, {1e6f + 1, 1e6f + 1, 1e6f - 5},
         unit(0.05, 0.03, 1), Hard::naive);
  addRay(to, "Q12", "aspect 1e6", {Quad{{0, 0, 0}, {1e3, 0, 0}, {0, 1e-3, 0}}}, {700, 6e-4f, -5}, {0, 0, 1},
         Hard::naive);
  addFamily(to, "Q6f", "spans 1e-7 to 1e-3 apart", "quad", "parallel", 100000);
}

}  // namespace solidcast::catalogue
