// Rays aimed at the seams of closed meshes.
#include <cmath>

#include "host/oracle/aims.h"

namespace solidcast::oracle {

// A double pyramid with a ring of 4 to 9 vertices at random distances: fans of that many triangles at its tips, fans of
// four on the ring. All distances exceed 0.7, so the origins within 0.1 of its middle are inside.
CrackBatch makeCracks(bool vertices, std::size_t rays, std::uint64_t seed) {
  Random random(seed * 1000003 + 7919 + (vertices ? 1 : 0));
  const int ring = random.integer(4, 9);
  const bool rounded = random.chance(0.5);
  std::vector<Triple> corners;
  for (int i = 0; i < ring + 2; ++i) {
    const double angle = 6.283185307179586 * (i + random.uniform(-0.1, 0.1)) / ring, radius = random.uniform(0.7, 2);
    Triple corner{radius * std::cos(angle), radius * random.uniform(-0.1, 0.1), radius * std::sin(angle)};
    if (i >= ring) corner = {0, i == ring ? radius : -radius, 0};
    if (rounded) {
      for (double& x : corner) x = static_cast<float>(x);
    }
    corners.push_back(corner);
  }
  CrackBatch batch;
  for (int tip = ring; tip < ring + 2; ++tip) {
    for (int i = 0; i < ring; ++i) {
      const int next = (i + 1) % ring;
      const Triangle triangle = tip == ring ? Triangle{corners[tip], corners[next], corners[i]}
                                            : Triangle{corners[tip], corners[i], corners[next]};
      batch.world.solids.push_back({"", triangle, 0});
      batch.world.groups[0].members.push_back({false, static_cast<std::uint32_t>(batch.world.solids.size() - 1)});
    }
  }
  batch.rays.reserve(rays);
  for (std::size_t k = 0; k < rays; ++k) {
    const int i = random.integer(0, ring - 1), next = (i + 1) % ring, tip = random.integer(ring, ring + 1);
    Triple target = corners[random.integer(0, ring + 1)];
    if (!vertices) {
      const Triple &from = corners[random.chance(0.3) ? next : tip], &to = corners[i];
      target = sum(from, scaled(random.uniform(0, 1), difference(to, from)));
    }
    QueryRay ray = aimed(random.chance(0.2) ? Triple{} : random.inCube(0.05), target);
    for (float& x : ray.direction) {
      if (random.chance(0.3)) x = nudged(x, random.integer(-3, 3));
    }
    batch.rays.push_back(ray);
  }
  return batch;
}

}  // namespace solidcast::oracle
