#include <cmath>
#include <limits>

#include "tests/catalogue/cases.h"

namespace solidcast::catalogue {

void addSpheres(Catalogue& to) {
  const Sphere unitSphere{{0, 0, 0}, 1}, planet{{0, -1e8, 0}, 1e8};
  const float up1 = std::nextafter(1.f, 2.f), down1 = std::nextafter(1.f, 0.f);
  addRay(to, "S1", "far, head-on", {Sphere{{0, 0, 1e6}, 1}}, {}, {0, 0, 1});
  addRay(to, "S2", "far, near the rim", {Sphere{{0, 0, 1e4}, 1}}, {}, unit(0.9e-4, 0, 1), Hard::naive);
  addRay(to, "S3", "far, just past the rim: textbook fp32 hits", {Sphere{{0, 0, 1e4}, 1}}, {}, unit(1.01e-4, 0, 1),
         Hard::naive);
  addRay(to, "S4", "tiny", {Sphere{{0, 0, 1}, 1e-6}}, {}, unit(0.5e-6, 0, 1), Hard::naive);
  addRay(to, "S5", "planet, straight down from 1 above", {planet}, {0, 1, 0}, {0, -1, 0}, Hard::fast);
  addRay(to, "S6", "planet, level: every published fp32 form hits", {planet}, {0, 1, 0}, {1, 0, 0}, Hard::fast);
  addRay(to, "S7", "planet, just below the horizon", {planet}, {0, 1, 0}, unit(1, -2e-4, 0), Hard::fast);
  addRay(to, "S8", "tangent exactly: discriminant 0 is a hit", {unitSphere}, {1, 0, -5}, {0, 0, 1});
  addRay(to, "S9", "tangent, 1 ulp outside", {unitSphere}, {up1, 0, -5}, {0, 0, 1}, Hard::fast);
  addRay(to, "S10", "tangent, 1 ulp inside", {unitSphere}, {down1, 0, -5}, {0, 0, 1}, Hard::fast);
  addRay(to, "S11", "on the surface, leaving: t = 0 is no hit", {unitSphere}, {0, 0, 1}, {0, 0, 1});
  addRay(to, "S12", "on the surface, entering: the far side", {unitSphere}, {0, 0, 1}, {0, 0, -1});
  addRay(to, "S13", "4e-8 outside: the near hit is easily skipped", {unitSphere}, {0.6f, 0.8f, 0}, {-1, 0, 0},
         Hard::fast);
  addRay(to, "S14", "from the centre", {Sphere{{1, 2, 3}, 2.5}}, {1, 2, 3}, unit(1, -2, 0.5));
  addRay(to, "S15", "behind", {Sphere{{0, 0, 5}, 1}}, {}, {0, 0, -1});
  addRay(to, "S16", "huge: radius 1e15", {Sphere{{0, 0, 3e15}, 1e15}}, {}, {0, 0, 1});
  addRay(to, "S17", "squares overflow fp32: radius 1e20", {Sphere{{0, 0, 3e20}, 1e20}}, {}, {0, 0, 1}, Hard::naive);
  addRay(to, "S18", "squares are denormal: radius 1e-20", {Sphere{{0, 0, 3e-20}, 1e-20}}, {}, {0, 0, 1}, Hard::naive);
  addRay(to, "S19", "|d| = 1e-20", {Sphere{{0, 0, 5}, 1}}, {}, {0, 0, 1e-20f}, Hard::naive);
  addRay(to, "S20", "|d| = 1e15", {Sphere{{0, 0, 5}, 1}}, {}, {0, 0, 1e15f});
  addRayReject(to, "S21", "zero direction", "direction", {{0, 0, 0}, {0, 0, 0}});
  addReject(to, "S22", "radius 0", "positive", Sphere{{0, 0, 5}, 0});
  addReject(to, "S23", "radius NaN", "finite", Sphere{{0, 0, 5}, std::numeric_limits<double>::quiet_NaN()});
  addReject(to, "S24", "radius infinite", "finite", Sphere{{0, 0, 5}, std::numeric_limits<double>::infinity()});
  addRay(to, "S25", "concentric, 1 and the next fp32: the larger is nearer, though fp32 rounds both t to 4",
         {unitSphere, Sphere{{0, 0, 0}, up1}}, {0, 0, -5}, {0, 0, 1}, Hard::fast);
  addRay(to, "S25b", "the same the other way round", {Sphere{{0, 0, 0}, up1}, unitSphere}, {0, 0, -5}, {0, 0, 1},
         Hard::fast);
  addRay(to, "S26", "sphere and eye near (1e7, 1e7, 1e7)", {Sphere{{1e7, 1e7, 1e7}, 1}}, {1e7f, 1e7f, 1e7f - 10},
         {0, 0, 1});
  addRay(to, "S27", "normal at distance 1e6: from o + t d it is 0.08 degrees off", {Sphere{{0, 0, 1e6}, 1}}, {},
         unit(0.5e-6, 0.3e-6, 1), Hard::naive);
  addFamily(to, "S6f", "planet: downward misses and hits", "sphere", "planet", 100000);
}

}  // namespace solidcast::catalogue
