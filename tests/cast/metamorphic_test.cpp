// Properties of exact that need no oracle: what a change of the world that keeps the answer keeps, to the bit.
#include <cmath>
#include <numeric>

#include "host/oracle/random.h"
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

using oracle::Kind;

using Parameter = std::pair<Kind, std::string>;

/// Families whose numbers no scaling or sum rounds.
std::vector<Parameter> plainFamilies() {
  std::vector<Parameter> list;
  for (const Kind kind : oracle::kKinds)
    for (const std::string& family : oracle::familiesOf(kind))
      if (family != "denormal" && family != "scaled" && family != "length") list.emplace_back(kind, family);
  return list;
}

/// What `change` makes of world and rays.
template <class Change, class Expect>
void forBatches(gpu::Device& device, const Change& change, const Expect& expect) {
  for (const auto& [kind, family] : plainFamilies()) {
    const auto batches = oracle::makeBatches(kind, family, 600, 11, 20);
    const World any = worldOf({batches[0].shape});
    QueryCaster caster(device, any, {});
    for (const oracle::Batch& batch : batches) {
      Shape shape = batch.shape;
      std::vector<QueryRay> rays = batch.rays;
      if (!change(shape, rays)) break;
      const World first = worldOf({batch.shape}), second = worldOf({shape});
      std::vector<QueryHit> before(rays.size()), after(rays.size());
      caster.setWorld(first);
      caster.cast(batch.rays, before);
      caster.setWorld(second);
      caster.cast(rays, after);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(before[i].index, after[i].index)
            << family << ": " << text(worldOf({batch.shape})) << " | " << text(batch.rays[i]);
        expect(before[i], after[i], family);
      }
    }
  }
}

void scale(double factor, Shape& shape) {
  const auto each = [factor](auto&... vectors) {
    const auto one = [factor](Triple& v) {
      for (double& x : v) x *= factor;
    };
    (one(vectors), ...);
  };
  struct Visit {
    double k;
    decltype(each)& all;
    void operator()(InfinitePlane& s) const { all(s.origin); }
    void operator()(AABox& s) const { all(s.corner1, s.corner2); }
    void operator()(Sphere& s) const { all(s.center), s.radius *= k; }
    void operator()(Disc& s) const { all(s.center), s.radius *= k; }
    void operator()(Triangle& s) const { all(s.v1, s.v2, s.v3); }
    void operator()(Quad& s) const { all(s.vertex, s.span1, s.span2); }
    void operator()(Quadric& s) const {
      for (std::size_t i = 6; i < 9; ++i) s.coefficients[i] *= k;
      s.coefficients[9] *= k * k;
    }
  };
  std::visit(Visit{factor, each}, shape);
}

TEST_F(OnDevice, ScalingByPowersOfTwoScalesTBitForBit) {
  for (const double factor : {0x1p9, 0x1p-7}) {
    forBatches(
        device(),
        [&](Shape& shape, std::vector<QueryRay>& rays) {
          scale(factor, shape);
          for (QueryRay& ray : rays)
            for (float& x : ray.origin) x *= static_cast<float>(factor);
          return true;
        },
        [&](const QueryHit& before, const QueryHit& after, const std::string& family) {
          if (std::abs(before.t) < 1e-30f) return;  // denormal after scaling
          EXPECT_EQ(before.t * static_cast<float>(factor), after.t) << family;
          EXPECT_EQ(before.normal, after.normal) << family;
        });
  }
}

/// New x = old y, new y = old z, new z = -old x: a permutation and a mirror.
template <class Three>
Three turned(const Three& v) {
  return {v[1], v[2], -v[0]};
}

struct Turned {
  Shape operator()(const InfinitePlane& s) const { return InfinitePlane{turned(s.origin), turned(s.normal)}; }
  Shape operator()(const AABox& s) const { return AABox{turned(s.corner1), turned(s.corner2)}; }
  Shape operator()(const Sphere& s) const { return Sphere{turned(s.center), s.radius}; }
  Shape operator()(const Disc& s) const { return Disc{turned(s.center), turned(s.normal), s.radius}; }
  // Mirrored: the other way round, so that the normal is mirrored too.
  Shape operator()(const Triangle& s) const { return Triangle{turned(s.v1), turned(s.v3), turned(s.v2)}; }
  Shape operator()(const Quad& s) const { return Quad{turned(s.vertex), turned(s.span2), turned(s.span1)}; }
  Shape operator()(const Quadric& s) const {  // x = -z', y = x', z = y'
    const auto& q = s.coefficients;
    return Quadric{{q[1], q[2], q[0], q[5], -q[3], -q[4], q[7], q[8], -q[6], q[9]}};
  }
};

TEST_F(OnDevice, PermutedAndMirroredAxesKeepTheBits) {
  forBatches(
      device(),
      [](Shape& shape, std::vector<QueryRay>& rays) {
        shape = std::visit(Turned{}, shape);
        for (QueryRay& ray : rays) ray.origin = turned(ray.origin), ray.direction = turned(ray.direction);
        return true;
      },
      [](const QueryHit& before, const QueryHit& after, const std::string& family) {
        EXPECT_EQ(before.t, after.t) << family;
        // A box's normal at an edge is that of the lowest axis, which turning changes.
        if (family != "lattice" && family != "face") { EXPECT_EQ(turned(before.normal), after.normal) << family; }
      });
}

TEST_F(OnDevice, NegatedCoefficientsKeepTAndTurnTheNormal) {
  int hits = 0;
  forBatches(
      device(),
      [](Shape& shape, std::vector<QueryRay>&) {
        auto* quadric = std::get_if<Quadric>(&shape);
        if (!quadric) return false;
        for (double& c : quadric->coefficients) c = -c;
        return true;
      },
      [&](const QueryHit& before, const QueryHit& after, const std::string& family) {
        EXPECT_EQ(before.t, after.t) << family;
        if (!before) return;
        ++hits;
        if (family == "apex" || family == "lattice") return;  // an apex has no gradient to turn
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(before.normal[k], -after.normal[k]) << family;
      });
  EXPECT_GT(hits, 2000);
}

// --- worlds of many ------------------------------------------------------------------------------------------------

World mixedWorld(std::uint64_t seed, int solids) {
  oracle::Random random(seed);
  std::vector<Shape> shapes;
  for (int i = 0; i < solids; ++i)
    shapes.push_back(oracle::makeShape(oracle::kKinds[random.integer(1, 6)], random, random.inCube(4), 1));
  return worldOf(shapes);
}

std::vector<QueryRay> raysAround(std::uint64_t seed, int count) {
  oracle::Random random(seed);
  std::vector<QueryRay> rays(static_cast<std::size_t>(count));
  for (QueryRay& ray : rays)
    for (std::size_t k = 0; k < 3; ++k) {
      ray.origin[k] = static_cast<float>(random.uniform(-8, 8));
      ray.direction[k] = static_cast<float>(random.uniform(-3, 3)) - 0.3f * ray.origin[k];
    }
  return rays;
}

TEST_F(OnDevice, TheOrderOfSolidsDoesNotMatter) {
  World world = mixedWorld(3, 40);
  const auto rays = raysAround(4, 5000);
  std::vector<std::size_t> order(world.solids.size());
  std::iota(order.begin(), order.end(), 0);
  oracle::Random random(5);
  for (std::size_t i = order.size(); i > 1; --i)
    std::swap(order[i - 1], order[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
  World shuffled = world;
  shuffled.solids = {};
  for (const std::size_t i : order) shuffled.solids.push_back(world.solids[i]);
  for (const Method method : kMethods) {
    const auto a = castAll(device(), world, rays, {.method = method});
    const auto b = castAll(device(), shuffled, rays, {.method = method});
    int hits = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_EQ(a[i].index, b[i] ? static_cast<int>(order[static_cast<std::size_t>(b[i].index)]) : -1)
          << nameOf(method) << " " << text(rays[i]);
      ASSERT_EQ(a[i].t, b[i].t);
      ASSERT_EQ(a[i].normal, b[i].normal);
      hits += a[i].index >= 0;
    }
    EXPECT_GT(hits, 2000) << nameOf(method);
  }
}

TEST_F(OnDevice, AtEqualTTheEarlierWins) {
  const Sphere one{{0.25, -0.5, 1}, 1.5};
  const Quadric same{{1, 1, 1, 0, 0, 0, -0.5, 1, -2, 0.0625 + 0.25 + 1 - 2.25}};
  const auto rays = raysAround(6, 3000);
  for (const auto& shapes : {std::vector<Shape>{one, same}, std::vector<Shape>{same, one}, {one, one, same}}) {
    const World world = worldOf(shapes);
    QueryCaster caster(device(), world, {});
    std::vector<QueryHit> hits(rays.size());
    caster.cast(rays, hits);
    int found = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      ASSERT_TRUE(hits[i].index == -1 || hits[i].index == 0) << text(rays[i]);
      found += hits[i].index == 0;
    }
    EXPECT_GT(found, 100);
    EXPECT_GE(caster.stats().fallbackRays, static_cast<std::uint64_t>(found)) << "equal t is never clear";
  }
}

// --- one solid as others -------------------------------------------------------------------------------------------

std::vector<QueryRay> withLattice(std::vector<QueryRay> rays, Kind kind) {
  for (const char* family : {"lattice", "surface", "axis"})
    for (const oracle::Batch& batch : oracle::makeBatches(kind, family, 1500, 8, 1500))
      rays.insert(rays.end(), batch.rays.begin(), batch.rays.end());
  return rays;
}

TEST_F(OnDevice, ASphereIsItsQuadric) {
  const Sphere sphere{{1, -0.5, 0.25}, 2};
  const Quadric quadric{{1, 1, 1, 0, 0, 0, -2, 1, -0.5, 1 + 0.25 + 0.0625 - 4}};
  const auto rays = withLattice(raysAround(21, 5000), Kind::sphere);
  const auto a = castAll(device(), worldOf({sphere}), rays), b = castAll(device(), worldOf({quadric}), rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(a[i].index, b[i].index) << text(rays[i]);
    ASSERT_EQ(a[i].t, b[i].t) << text(rays[i]);
    // Each is the nearest fp32 number; halfway between two, the last place of binary128 tells.
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(a[i].normal[k], b[i].normal[k], 0x1p-24) << text(rays[i]);
  }
}

TEST_F(OnDevice, ABoxIsItsSixQuads) {
  const Triple lo{-2, -1, -1}, hi{2, 2, 2.5};
  std::vector<Shape> quads;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
      Triple corner = lo, a{}, b{};
      corner[axis] = upper ? hi[axis] : lo[axis];
      a[u] = hi[u] - lo[u], b[v] = hi[v] - lo[v];
      quads.push_back(upper ? Quad{corner, a, b} : Quad{corner, b, a});  // outward normals
    }
  // Rays that run within a face hit the box, but no quad: they are the box's own (family face).
  const auto rays = withLattice(raysAround(22, 5000), Kind::box);
  const auto a = castAll(device(), worldOf({AABox{lo, hi}}), rays), b = castAll(device(), worldOf(quads), rays);
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    bool within = false;
    for (std::size_t k = 0; k < 3; ++k)
      within = within || (rays[i].direction[k] == 0 && (rays[i].origin[k] == lo[k] || rays[i].origin[k] == hi[k]));
    if (within) continue;
    ASSERT_EQ(a[i].index >= 0, b[i].index >= 0) << text(rays[i]);
    ASSERT_EQ(a[i].t, b[i].t) << text(rays[i]);
    hits += a[i].index >= 0;
  }
  EXPECT_GT(hits, 2000);
}

TEST_F(OnDevice, AQuadIsItsTwoTriangles) {
  const Triple v{-1.5, -1, 0.5}, a{3, 0.5, 0}, b{0.25, 2, 1};
  const auto plus = [](const Triple& x, const Triple& y) { return Triple{x[0] + y[0], x[1] + y[1], x[2] + y[2]}; };
  const World quad = worldOf({Quad{v, a, b}});
  const World triangles =
      worldOf({Triangle{v, plus(v, a), plus(v, b)}, Triangle{plus(plus(v, a), b), plus(v, b), plus(v, a)}});
  const auto rays = withLattice(raysAround(23, 8000), Kind::quad);
  const auto x = castAll(device(), quad, rays), y = castAll(device(), triangles, rays);
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(x[i].index >= 0, y[i].index >= 0) << text(rays[i]);
    ASSERT_EQ(x[i].t, y[i].t) << text(rays[i]);
    ASSERT_EQ(x[i].normal, y[i].normal) << text(rays[i]);
    hits += x[i].index >= 0;
  }
  EXPECT_GT(hits, 300);
}

}  // namespace
}  // namespace solidcast
