#include <cmath>
#include <limits>

#include "tests/catalogue/cases.h"

namespace solidcast::catalogue {

void addRaysAndCameras(Catalogue& to) {
  const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const InfinitePlane wall{{0, 0, 5}, {0, 0, 1}};
  const Sphere sphere{{0, 0, 5}, 2};
  addRay(to, "R1", "two equal spheres: at equal t the earlier wins", {sphere, sphere}, {}, unit(0.1, 0.2, 1));
  const Triple n{0.3f, 0.8f, -0.5f};
  addRay(to, "R2", "one plane as n and as -3n: equal t, the earlier wins",
         {InfinitePlane{{1, 2, 3}, n}, InfinitePlane{{1, 2, 3}, {-3 * n[0], -3 * n[1], -3 * n[2]}}}, {5, 7, -1},
         unit(-0.4, -0.7, 0.9), Hard::naive);
  addLimitedRay(to, "R3", "tMax exactly at the hit: no hit", {wall}, {{0, 0, 0}, {0, 0, 1}, 5});
  addLimitedRay(to, "R3b", "tMax just behind the hit", {wall}, {{0, 0, 0}, {0, 0, 1}, std::nextafter(5.f, 6.f)});
  addLimitedRay(to, "R3c", "tMax infinite", {sphere}, {{0, 0, 0}, {0, 0, 1}, infinity});
  addLimitedRay(to, "R3d", "tMax 0: nothing can be hit", {wall}, {{0, 0, 0}, {0, 0, 1}, 0});
  addRayReject(to, "R4", "tMax NaN", "tmax", {{0, 0, 0}, {0, 0, 1}, nan});
  addRayReject(to, "R4b", "origin NaN", "finite", {{0, nan, 0}, {0, 0, 1}});
  addRayReject(to, "R4c", "direction infinite", "finite", {{0, 0, 0}, {0, infinity, 1}});

  const auto turned = [](double vertical, double horizontal) {
    return PerspectiveCamera{{1, 2, 3}, {0.3, -0.5, -0.8}, {0.2, 1, -0.1}, vertical, horizontal};
  };
  std::vector<std::array<int, 2>> row;
  for (int x = 0; x < 1024; x += 93) row.push_back({x, 0});
  const InfinitePlane tilted{{0, 0, -1e6}, {1, 0.5, 0.2}};
  addImage(to, "C1", "field of view 1e-6 degrees, turned: fp32 has one direction for 1024 pixels",
           {tilted, Sphere{{3e5, -5e5, -8e5}, 3e5}}, turned(1e-6 / 1024, 1e-6), 1024, 1, row, Hard::fast);
  addImage(to, "C1b", "field of view 1e-3 degrees", {tilted, Sphere{{3e5, -5e5, -8e5}, 3e5}}, turned(1e-3 / 1024, 1e-3),
           1024, 1, row, Hard::fast);
  const std::vector<std::array<int, 2>> corners{{0, 0}, {31, 0}, {0, 23}, {31, 23}, {15, 11}, {16, 12}, {3, 17}};
  const InfinitePlane floor{{0, -1, 0}, {0, 1, 0}};
  addImage(to, "C2", "field of view 179.9999 degrees: tan in fp32 is 4 % off", {floor, Sphere{{40, 3, -5}, 20}},
           PerspectiveCamera{{0, 1, 0}, {0, 0, -1}, {0, 1, 0}, 179.9999, 179.9999}, 32, 24, corners, Hard::fast);
  addImage(to, "C2b", "field of view 179.99999 degrees", {floor, Sphere{{40, 3, -5}, 20}},
           PerspectiveCamera{{0, 1, 0}, {0, 0, -1}, {0, 1, 0}, 179.99999, 179.99999}, 32, 24, corners, Hard::fast);
  const PerspectiveCamera plain{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 45, 60};
  addImage(to, "C3", "one pixel looks straight ahead", {sphere}, plain, 1, 1, {{0, 0}}, Hard::none);
  addCameraReject(to, "C4", "field of view 180 degrees", "angle",
                  PerspectiveCamera{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 45, 180});
  addImage(to, "C5", "1 x 7", {sphere, wall}, plain, 1, 7, {{0, 0}, {0, 3}, {0, 6}}, Hard::none);
  addImage(to, "C5b", "7 x 1", {sphere, wall}, plain, 7, 1, {{0, 0}, {3, 0}, {6, 0}}, Hard::none);
  addImage(to, "C5c", "sides that no workgroup divides: 131 x 67", {sphere, wall}, plain, 131, 67,
           {{0, 0}, {130, 66}, {65, 33}, {90, 20}}, Hard::none);
  addImage(to, "C5d", "no solid", {}, plain, 5, 4, {{0, 0}, {4, 3}}, Hard::none);
  addCameraReject(to, "C5e", "up parallel to forward", "parallel",
                  PerspectiveCamera{{0, 0, 0}, {0, 2, 0}, {0, -1, 0}, 45, 60});
  addCameraReject(to, "C5f", "looking at the eye: zero forward", "zero",
                  PerspectiveCamera{{1, 2, 3}, {0, 0, 0}, {0, 1, 0}, 45, 60});
  addImage(to, "C6", "8192 x 8192: pixel index times stride is beyond 2^31", {sphere, wall}, plain, 8192, 8192,
           {{0, 0}, {8191, 8191}, {4096, 4096}, {6000, 7000}}, Hard::none);
}

// Found here: places where a method that passes the ones above may still go wrong.
void addWorse(Catalogue& to) {
  const float up1 = std::nextafter(1.f, 2.f), down1 = std::nextafter(1.f, 0.f);
  const Sphere unitSphere{{0, 0, 0}, 1};
  const AABox cube{{-1, -1, -1}, {1, 1, 1}};
  const Quadric cone{{1, 1, -1, 0, 0, 0, 0, 0, 0, 0}};
  addRay(to, "W1", "on the surface, tangent: no hit", {unitSphere}, {1, 0, 0}, {0, 0, 1});
  addRay(to, "W2", "on the surface, entering at 1e-7: the far side at 2e-7", {unitSphere}, {1, 0, 0}, {-1e-7f, 0, 1},
         Hard::fast);
  addRay(to, "W3", "tangent by a 3-4-5 triangle, obliquely", {Sphere{{1, -2, 3}, 5}}, {8, -1, 2}, {-4, 3, 1});
  addRay(to, "W4", "inside by half an ulp of 1: a hit behind is near", {unitSphere}, {down1, 0, 0}, {1, 0, 0},
         Hard::fast);
  addRay(to, "W5", "inside by half an ulp, leaving almost tangentially", {unitSphere}, {down1, 0, 0}, {1e-4f, 0, 1},
         Hard::fast);
  addRay(to, "W6", "radius and distance differ by 1e-16: fp64 itself is at its end",
         {Sphere{{0, 0, 1}, std::nextafter(1.0, 0.0)}}, {}, {0, 0, 1}, Hard::fast);
  addRay(to, "W7", "tangent, decided in the last place of fp64", {Sphere{{0, 0, 0}, std::nextafter(1.0, 0.0)}},
         {1, 0, -5}, {0, 0, 1}, Hard::fast);
  addRay(to, "W8", "the box's corner as origin, into it", {cube}, {1, 1, 1}, {-1, -1, -1}, Hard::naive);
  addRay(to, "W9", "the box's corner as origin, along an edge", {cube}, {1, 1, 1}, {0, 0, -1}, Hard::naive);
  addRay(to, "W10", "the box's corner as origin, along a face", {cube}, {1, 1, 1}, {-1, 0, -2}, Hard::naive);
  addRay(to, "W11", "past the box's edge by one ulp of the origin", {cube}, {3, 0, std::nextafter(-1.f, 0.f)},
         {-1, 0, 1}, Hard::naive);
  addRay(to, "W12", "before the box's edge by one ulp of the origin", {cube}, {3, 0, std::nextafter(-1.f, -2.f)},
         {-1, 0, 1}, Hard::naive);
  addRay(to, "W13", "past a triangle's edge by the smallest denormal", {Triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
         {-0x1p-149f, 1, -1}, {0, 0, 1}, Hard::fast);
  addRay(to, "W14", "a triangle's hypotenuse exactly, obliquely", {Triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}},
         {5, -1, 3}, {-2, 2, -3});
  addRay(to, "W15", "rim by a 3-4-5 triangle, obliquely", {Disc{{0, 0, 0}, {0, 0, 7}, 5}}, {-4, 11, 6}, {7, -7, -6});
  addRay(to, "W16", "the same, one ulp of the direction beyond", {Disc{{0, 0, 0}, {0, 0, 7}, 5}}, {-4, 11, 6},
         {std::nextafter(7.f, 8.f), -7, -6}, Hard::fast);
  addRay(to, "W17", "a disc seen at 1e-6 from its plane, at the rim", {Disc{{0, 0, 0}, {0, 0, 1}, 1}}, {-3, 0, 4e-6f},
         {1, 0, -1e-6f}, Hard::fast);
  addRay(to, "W18", "quad and triangle in one plane share an edge: equal t, the earlier wins",
         {Triangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, Quad{{0, 0, 0}, {4, 0, 0}, {0, -4, 0}}}, {1, -1, 3}, {0, 1, -3});
  addRay(to, "W19", "sphere and plane touch where the ray meets both: equal t",
         {InfinitePlane{{0, 0, -1}, {0, 0, 1}}, unitSphere}, {0, 0, -5}, {0, 0, 1});
  addRay(to, "W20", "two spheres with the same irrational t", {Sphere{{1, 0, 0}, 2}, Sphere{{0, -1, 0}, 2}}, {0, 0, -5},
         {0, 0, 1}, Hard::naive);
  addRay(to, "W21", "sphere and its quadric: the same irrational t",
         {Quadric{{1, 1, 1, 0, 0, 0, -2, 0, 0, -3}}, Sphere{{1, 0, 0}, 2}}, {0, 0.5f, -5}, {0, 0, 1}, Hard::naive);
  addRay(to, "W22", "cone, 1e-7 off a generator: A cancels to 1e-14", {cone}, {0.25f, 0.5f, -2}, {1, 1e-7f, 1.0000001f},
         Hard::fast);
  addRay(to, "W23", "cone, its apex as origin", {cone}, {0, 0, 0}, {1, 0, 0.5f});
  addRay(to, "W24", "cone, past its apex by 1e-7", {cone}, {5, 1e-7f, 0}, {-1, 0, 0}, Hard::fast);
  addRay(to, "W25", "cylinder of radius 1 at 1e4, tangent 1 ulp inside", {Quadric{{1, 1, 0, 0, 0, 0, 0, 0, 0, -1}}},
         {down1, -1e4f, 0}, {0, 1, 0.5f}, Hard::fast);
  addRay(to, "W26", "the same, 1 ulp outside", {Quadric{{1, 1, 0, 0, 0, 0, 0, 0, 0, -1}}}, {up1, -1e4f, 0},
         {0, 1, 0.5f}, Hard::fast);
  addRay(to, "W27", "quadric with its origin on the surface, entering", {Quadric{{1, 1, 1, 0, 0, 0, 0, 0, 0, -1}}},
         {0, 0, 1}, unit(0.3, 0.1, -1), Hard::naive);
  addRay(to, "W28", "coefficients over 12 orders of magnitude",
         {Quadric{{1e6, 1e-6, 1, 3e2, 0, -2e-3, 1e-4, 5e3, 0, -7}}}, {2, 3, 4}, unit(-0.4, -0.9, -0.7), Hard::naive);
  addRay(to, "W29", "a denormal origin before a plane", {InfinitePlane{{0, 0, 0}, {0, 0, 1}}}, {0, 0, 0x1p-149f},
         {0, 0, -1}, Hard::fast);
  addRay(to, "W30", "every component of the direction denormal", {Sphere{{0, 0, 5}, 1}}, {}, {1e-41f, 0, 1e-40f},
         Hard::fast);
}

}  // namespace solidcast::catalogue
