#include <cmath>

#include "tests/catalogue/cases.h"

namespace solidcast::catalogue {
namespace {

Triangle legs(double length) { return {{0, 0, 0}, {length, 0, 0}, {0, length, 0}}; }

}  // namespace

void addTriangles(Catalogue& to) {
  const Triangle triangle{{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  addRay(to, "T1", "inside", {triangle}, {0.125f, -0.25f, -5}, {0, 0, 1});
  addRay(to, "T2", "a vertex exactly", {triangle}, {0, 1, -5}, {0, 0, 1});
  addRay(to, "T3", "an edge exactly", {triangle}, {0.25f, -1, -5}, {0, 0, 1});
  addRay(to, "T4", "from behind", {triangle}, {0, 0, 5}, {0, 0, -1});
  addRay(to, "T5", "in its plane", {triangle}, {-5, 0, 0}, {1, 0, 0});
  addReject(to, "T6", "two equal vertices", "collinear", Triangle{{0, 0, 0}, {0, 0, 0}, {1, 1, 0}});
  addReject(to, "T7", "collinear vertices", "collinear", Triangle{{0, 0, 0}, {1, 2, 3}, {2, 4, 6}});
  addReject(to, "T8", "a point", "collinear", Triangle{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}});
  addRay(to, "T9", "legs of 1e-4: epsilons on the determinant miss", {legs(1e-4)}, {2e-5f, 3e-5f, -1}, {0, 0, 1},
         Hard::naive);
  addRay(to, "T10", "legs of 1e-20: the determinant is denormal", {legs(1e-20)}, {2e-21f, 3e-21f, -1}, {0, 0, 1},
         Hard::naive);
  addRay(to, "T11", "legs of 1e-23: the determinant underflows", {legs(1e-23)}, {2e-24f, 3e-24f, -1}, {0, 0, 1},
         Hard::fast);
  addRay(to, "T12", "legs of 1e20: the determinant overflows", {legs(1e20)}, {2e19f, 3e19f, -5}, {0, 0, 1}, Hard::fast);
  addRay(to, "T13", "sliver, 1 : 1e7", {Triangle{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-7, 0}}}, {0.50000001f, 0.5e-7f, -1},
         unit(0, 1e-8, 1), Hard::fast);
  addRay(to, "T14", "three nearly collinear vertices at x = -1113.45459: a sheared test hits",
         {Triangle{{-1113.45459, -79.049614, -56.2431908},
                   {-1113.45459, -87.0922699, -56.2431908},
                   {-1113.45459, -79.2090149, -56.2431907}}},
         {-1081.47925f, 99.9999542f, 87.7701111f}, {-32.1072998f, -183.355865f, -144.607635f}, Hard::fast);
  addRay(to, "T15", "1e7 away", {Triangle{{1e7, 1e7, 1e7}, {1e7 + 4, 1e7, 1e7 + 1}, {1e7, 1e7 + 4, 1e7}}},
         {1e7f + 1, 1e7f + 1, 1e7f - 5}, {0, 0, 1}, Hard::naive);
  addRay(to, "T16", "origin on it: t = 0 is no hit", {triangle}, {0, 0, 0}, {0, 0, 1});
  addRay(to, "T17", "|d| = 1e-12", {triangle}, {0, 0, -5}, {0, 0, 1e-12f}, Hard::naive);
  addRay(to, "T18", "|d| = 1e12", {triangle}, {0, 0, -5}, {0, 0, 1e12f});
  addRay(to, "T19", "grazing at 1e-7", {triangle}, {-5, 0, 5e-7f}, {1, 0, -1e-7f}, Hard::naive);
  addFamily(to, "T20", "rays at the shared edges of closed meshes: every one must hit", "mesh", "edges", 1000000);
  addFamily(to, "T21", "rays at vertices where 4 to 9 triangles meet: every one must hit", "mesh", "vertices", 300000);
  addFamily(to, "T22", "slivers, 1e3:1 to 1e7:1", "triangle", "sliver", 100000);
}

}  // namespace solidcast::catalogue
