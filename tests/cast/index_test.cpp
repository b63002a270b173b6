// The index: boxes that hold their solids, trees that hold their boxes, and the same answers with it as without, where
// boxes are hard: coincident, nested, flat, on a line, one giant among many; rays along faces and in planes.
#include "host/cast/index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "host/cast/bounds.h"
#include "host/scene/random.h"
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

std::vector<QueryRay> raysAround(std::size_t n, float size, std::uint32_t seed) {
  std::mt19937 bits(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<QueryRay> rays(n);
  for (QueryRay& ray : rays) {
    for (std::size_t k = 0; k < 3; ++k) {
      ray.origin[k] = 2 * size * uniform(bits);
      ray.direction[k] = size * uniform(bits) - ray.origin[k];
    }
    if (bits() % 4 == 0) ray.direction[bits() % 3] = bits() % 2 ? 0.f : -0.f;
    if (bits() % 8 == 0) ray.direction[bits() % 3] = 0;
    if (ray.direction == std::array<float, 3>{0, 0, 0}) ray.direction[0] = 1;
    if (bits() % 8 == 0) ray.tMax = 1 + uniform(bits);
    if (bits() % 4 == 0)  // to and along integers: faces, edges, slabs
      for (float& x : ray.origin) x = std::round(x);
  }
  return rays;
}

bool sameBytes(const QueryHit& a, const QueryHit& b) {
  return a.index == b.index && (a.index < 0 || std::memcmp(&a, &b, sizeof a) == 0);
}

struct Difference {
  std::size_t differ = 0, hits = 0;
};
Difference differences(gpu::Device& device, const World& world, const std::vector<QueryRay>& rays, Method method,
                       Arithmetic arithmetic = Arithmetic::automatic) {
  const auto with = castAll(device, world, rays, {.method = method, .arithmetic = arithmetic, .plan = Plan::index});
  const auto without =
      castAll(device, world, rays, {.method = method, .arithmetic = arithmetic, .plan = Plan::storage});
  Difference all;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    all.differ += !sameBytes(with[i], without[i]);
    all.hits += without[i].index >= 0;
  }
  return all;
}

/// The same of a solid that stands elsewhere.
Shape ballAt(double x, double y, double z, double r) { return Sphere{{x, y, z}, r}; }

/// Worlds whose boxes are hard.
std::vector<std::pair<std::string, World>> hardWorlds() {
  std::vector<std::pair<std::string, World>> all;
  std::vector<Shape> shapes;
  const auto make = [&](const char* name) {
    all.emplace_back(name, worldOf(shapes));
    shapes.clear();
  };
  for (int i = 0; i < 100; ++i)
    shapes.push_back(i % 2 ? Shape(Sphere{{1, 1, 1}, 2}) : Shape(AABox{{0, 0, 0}, {2, 2, 2}}));
  make("coincident");
  for (int i = 0; i < 200; ++i) shapes.push_back(ballAt(0.0625 * i - 6, 0, 0, 0.4));
  make("line");
  shapes.push_back(ballAt(0, 0, 0, 1e9));
  shapes.push_back(ballAt(0, -1e6, 0, 1e6 - 3));
  for (int i = 0; i < 200; ++i) shapes.push_back(ballAt(i % 6 - 3, i / 6 % 6 - 3, i / 36 - 3, 0.25));
  make("giants");
  for (int i = 1; i <= 100; ++i) shapes.push_back(ballAt(0, 0, 0, 0.05 * i));
  for (int i = 1; i <= 100; ++i)
    shapes.push_back(AABox{{-0.05 * i, -0.05 * i, -0.05 * i}, {0.05 * i, 0.05 * i, 0.05 * i}});
  make("nested");
  for (int i = -4; i <= 4; ++i)
    for (int k = -4; k <= 4; ++k) {
      shapes.push_back(AABox{{double(i), double(k), -1}, {i + 1.0, k + 1.0, -1}});  // no thickness
      shapes.push_back(Quad{{double(i), 1, double(k)}, {1, 0, 0}, {0, 0, 1}});      // flat along y
      shapes.push_back(Disc{{2, double(i), double(k)}, {1, 0, 0}, 0.5});
      shapes.push_back(Triangle{{double(i), -2, double(k)}, {i + 1.0, -2, double(k)}, {double(i), -2, k + 1.0}});
    }
  make("flat");
  for (int i = 0; i < 64; ++i) {
    shapes.push_back(InfinitePlane{{0, -5 - 0.1 * i, 0}, {0.01 * i, 1, 0}});
    shapes.push_back(Quadric{{1, 1, -0.5, 0, 0, 0, 0, 0, 0, -0.1 * (i + 1)}});  // hyperboloids: no end
    shapes.push_back(Quadric{{1, 2, 3, 0.5, 0, 0, 0.1 * i, 0, 0, -1}});         // ellipsoids
    shapes.push_back(Quadric{{1, 1, 1, 0, 0, 0, 0, 0, 0, 0}});                  // a point
    shapes.push_back(Quadric{{1, 1, 1, 0, 0, 0, 0, 0, 0, 1}});                  // nothing
  }
  make("endless");
  return all;
}

TEST(Bounds, HoldEverySurfacePoint) {
  // Along axes the extremes of a turned ellipsoid are touched by no corner: its own equation says where they are.
  const Scene scene = randomScene("quadric", 300, 5);
  for (const SolidEntry& solid : scene.world.solids) {
    const auto b = boundsOf(solid.shape);
    ASSERT_TRUE(b);
    const auto& c = std::get<Quadric>(solid.shape).coefficients;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const double at : {b->lo[axis] - 1e-9, b->hi[axis] + 1e-9, b->lo[axis] + 1e-4, b->hi[axis] - 1e-4}) {
        // On the plane x_axis = at the quadric is a conic p'Np + 2 m.p + k: real where m'N^-1 m - k >= 0.
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto mixed = [&](std::size_t i, std::size_t k) { return __float128(c[2 + i + k]) / 2; };  // xy xz yz
        const __float128 nuu = c[u], nvv = c[v], nuv = mixed(u, v), x = at;
        const __float128 mu = mixed(axis, u) * x + __float128(c[6 + u]) / 2,
                         mv = mixed(axis, v) * x + __float128(c[6 + v]) / 2;
        const __float128 k = (c[axis] * x + c[6 + axis]) * x + c[9], det = nuu * nvv - nuv * nuv;
        const bool real = (nvv * mu * mu - 2 * nuv * mu * mv + nuu * mv * mv) / det - k >= 0;
        const bool inside = at > b->lo[axis] && at < b->hi[axis];
        EXPECT_EQ(real, inside) << "axis " << axis << " at " << at << " in " << b->lo[axis] << ", " << b->hi[axis];
      }
  }
}

TEST(Bounds, AreNoneOfWhatHasNoEnd) {
  EXPECT_FALSE(boundsOf(InfinitePlane{{0, 0, 0}, {0, 1, 0}}));
  EXPECT_FALSE(boundsOf(Quadric{{1, 1, 0, 0, 0, 0, 0, 0, 0, -1}}));   // cylinder
  EXPECT_FALSE(boundsOf(Quadric{{1, 1, -1, 0, 0, 0, 0, 0, 0, 0}}));   // cone
  EXPECT_FALSE(boundsOf(Quadric{{0, 0, 0, 0, 0, 0, 1, 0, 0, -1}}));   // plane
  EXPECT_FALSE(boundsOf(Sphere{{0, 0, 0}, 1e31}));                    // beyond what fp32 multiplies
  EXPECT_TRUE(boundsOf(Quadric{{-1, -1, -1, 0, 0, 0, 0, 0, 0, 1}}));  // a sphere from the other side
}

TEST(Index, EverySolidIsInOneLeafBelowBoxesThatHoldIt) {
  auto worlds = hardWorlds();
  worlds.emplace_back("mixed", randomScene("mixed", 5000, 3).world);
  for (const auto& [name, world] : worlds) {
    SCOPED_TRACE(name);
    const Index index = buildIndex(world);
    std::set<std::uint32_t> seen;
    std::vector<std::uint32_t> above;  // nodes whose walk below them is not over
    for (std::uint32_t at = 0; at < index.nodes.size(); ++at) {
      const IndexNode& node = index.nodes[at];
      const std::uint32_t skip = index.skips[8 * at];  // of the octant that takes lower children first
      while (!above.empty() && index.skips[8 * above.back()] <= at) above.pop_back();
      ASSERT_GT(skip, at);
      above.push_back(at);
      if (node.leaf == 0) continue;
      ASSERT_EQ(skip, at + 1);
      ASSERT_LE(node.leaf % 16, mostInLeaf);
      ASSERT_GE(node.leaf % 16, 1u);
      for (std::uint32_t i = 0; i < node.leaf % 16; ++i) {
        const std::uint32_t solid = index.order[node.leaf / 16 + i];
        EXPECT_TRUE(seen.insert(solid).second);
        const auto b = boundsOf(world.solids[solid].shape);
        for (const std::uint32_t parent : above)
          for (std::size_t k = 0; k < 3; ++k) {
            const double lo = b ? b->lo[k] : -0x1p125, hi = b ? b->hi[k] : 0x1p125;
            EXPECT_LE(index.nodes[parent].lo[k], lo - 0x1p-100);
            EXPECT_GE(index.nodes[parent].hi[k], hi + 0x1p-100);
          }
      }
    }
    EXPECT_EQ(seen.size(), world.solids.size());
    // Every octant's walk visits every node once.
    for (std::size_t octant = 0; octant < 8; ++octant) {
      std::set<std::size_t> visited;
      for (std::size_t at = 0; at < index.nodes.size();) {
        ASSERT_TRUE(visited.insert(at).second);
        const IndexNode& node = index.nodes[at];
        const bool upperFirst = octant >> node.link % 4 & 1;
        at = node.leaf != 0 ? index.skips[8 * at + octant] : upperFirst ? node.link / 4 : at + 1;
      }
      EXPECT_EQ(visited.size(), index.nodes.size());
    }
  }
}

double costOf(const Index& index) {  // area of each node times what it holds, over the first node's
  const auto area = [](const IndexNode& n) {
    const double x = n.hi[0] - n.lo[0], y = n.hi[1] - n.lo[1], z = n.hi[2] - n.lo[2];
    return x * y + y * z + z * x;
  };
  double sum = 0;
  for (const IndexNode& node : index.nodes) sum += area(node) * (1 + node.leaf % 16);
  return sum / area(index.nodes[0]);
}

// Sizes from 1 to 1000 crowded into a corner: halving by number mixes large and small.
TEST(Index, CostsLessThanHalvingByNumber) {
  std::mt19937 bits(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Shape> shapes;
  for (int i = 0; i < 20000; ++i) {
    const double far = std::pow(uniform(bits), 3) * 1000;
    shapes.push_back(ballAt(far * uniform(bits), far * uniform(bits), far * uniform(bits), 0.002 * far + 0.01));
  }
  const World world = worldOf(shapes);
  const Index index = buildIndex(world);
  // The same solids, halved by their middles along the longest axis until 4 are left.
  struct Half {
    std::size_t first, last;
  };
  std::vector<std::uint32_t> order(shapes.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  double halving = 0, whole = 0;
  std::vector<Half> open{{0, order.size()}};
  while (!open.empty()) {
    const Half now = open.back();
    open.pop_back();
    double lo[3] = {1e30, 1e30, 1e30}, hi[3] = {-1e30, -1e30, -1e30};
    for (std::size_t i = now.first; i < now.last; ++i) {
      const Sphere& s = std::get<Sphere>(shapes[order[i]]);
      for (std::size_t k = 0; k < 3; ++k)
        lo[k] = std::min(lo[k], s.center[k] - s.radius), hi[k] = std::max(hi[k], s.center[k] + s.radius);
    }
    const double x = hi[0] - lo[0], y = hi[1] - lo[1], z = hi[2] - lo[2], area = x * y + y * z + z * x;
    if (whole == 0) whole = area;
    const std::size_t n = now.last - now.first;
    halving += area * (n <= 4 ? 1 + double(n) : 1);
    if (n <= 4) continue;
    const std::size_t axis = x >= y && x >= z ? 0 : y >= z ? 1 : 2, middle = now.first + n / 2;
    const auto at = [&](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(now.first), at(middle), at(now.last), [&](std::uint32_t a, std::uint32_t b) {
      return std::get<Sphere>(shapes[a]).center[axis] < std::get<Sphere>(shapes[b]).center[axis];
    });
    open.push_back({now.first, middle});
    open.push_back({middle, now.last});
  }
  EXPECT_LT(costOf(index), 0.9 * halving / whole);
}

TEST(Index, IsTheSameForAnyNumberOfThreads) {
  const World world = randomScene("mixed", 60000, 2).world;
  const Index one = buildIndex(world, 0, 1);
  for (const unsigned threads : {2u, 3u, 7u}) {
    const Index many = buildIndex(world, 0, threads);
    EXPECT_EQ(many.order, one.order);
    ASSERT_EQ(many.nodes.size(), one.nodes.size());
    EXPECT_EQ(std::memcmp(many.nodes.data(), one.nodes.data(), one.nodes.size() * sizeof(IndexNode)), 0);
  }
}

class Indexed : public OnDevice, public testing::WithParamInterface<Method> {};
INSTANTIATE_TEST_SUITE_P(, Indexed, testing::ValuesIn(kMethods), [](const auto& i) { return nameOf(i.param); });

TEST_P(Indexed, BundledScenes) {
  for (const std::string& name : bundledScenes()) {
    World world = loaded(name).world;
    world.customSolids.clear();  // which free rays are not cast at
    const Difference d = differences(device(), world, raysAround(1000, 3, 1), GetParam());
    EXPECT_EQ(d.differ, 0u) << name;
  }
}

TEST_P(Indexed, RandomScenesOfEveryKind) {
  for (const std::string& kind : randomKinds()) {
    const World world = randomScene(kind, kind == "infinite_plane" ? 200 : 1500, 7).world;
    const Difference d = differences(device(), world, raysAround(3000, 10, 2), GetParam());
    EXPECT_EQ(d.differ, 0u) << kind;
    EXPECT_GT(d.hits, 300u) << kind;
  }
}

TEST_P(Indexed, HardBoxes) {
  for (const auto& [name, world] : hardWorlds()) {
    const Difference d = differences(device(), world, raysAround(1500, 3, 3), GetParam());
    EXPECT_EQ(d.differ, 0u) << name;
    EXPECT_GT(d.hits, 80u) << name;
  }
}

// Spheres of many sizes, so that the rays of a vector leave the walk's inner loop at different times while what it leaves
// behind is used after it: values first set inside it would be overwritten (see rays.comp).
TEST_P(Indexed, RaysThatLeaveTheInnerLoopAtDifferentTimes) {
  std::vector<Shape> shapes;
  for (int i = 0; i < 700; ++i)
    shapes.push_back(ballAt(i % 2 ? 0.01 * i : -9 + 0.02 * i, i % 7, i % 11, 0.3 + 0.01 * (i % 13)));
  const Difference d = differences(device(), worldOf(shapes), raysAround(20000, 8, 4), GetParam());
  EXPECT_EQ(d.differ, 0u);
  EXPECT_GT(d.hits, 2000u);
}

// A ray from the middle of 70,000 shells has to try each of them: more rounds than llvmpipe allows an invocation, so that
// the ray must go on in further dispatches. The nearest is first in one world and last in the other.
TEST_P(Indexed, MoreSolidsOnARayThanLlvmpipeHasRounds) {
  const int n = 70000;
  for (const bool lastIsNearest : {true, false}) {
    std::vector<Shape> shapes;
    for (int i = 0; i < n; ++i) shapes.push_back(ballAt(0, 0, 0, 2 + 1e-5 * (lastIsNearest ? n - i : i + 1)));
    const World world = worldOf(shapes);
    const std::vector<QueryRay> rays{{{0, 0, 0}, {0, 0, -1}}, {{0.5, 0, 0}, {1, 2, 3}}, {{0, 0, 9}, {0, 0, -1}}};
    std::vector<QueryHit> hits(rays.size());
    QueryCaster caster(device(), world, {.method = GetParam(), .plan = Plan::index});
    caster.cast(rays, hits);
    const int nearest = lastIsNearest ? n - 1 : 0;
    EXPECT_EQ(hits[0].index, nearest);
    EXPECT_EQ(hits[1].index, nearest);
    EXPECT_EQ(hits[2].index, n - 1 - nearest);
    EXPECT_GT(caster.stats().dispatches, 65535u / 1600) << "one dispatch cannot have had the rounds";
  }
}

TEST_F(OnDevice, TheIndexOfExactWithoutFp64) {
  for (const auto& [name, world] : hardWorlds()) {
    const Difference d = differences(device(), world, raysAround(500, 3, 5), Method::exact, Arithmetic::df32);
    EXPECT_EQ(d.differ, 0u) << name;
  }
}

// Against the truth, from families of rays aimed at trouble: denormal and huge numbers, faces, edges, surfaces.
TEST_F(OnDevice, TheIndexOfExactKeepsTheBars) {
  for (const oracle::Kind kind : oracle::kKinds)
    for (const std::string& family : oracle::familiesOf(kind)) {
      const Tally tally = measureFamily(device(), kind, family, {360, 20, 6, 9}, {.plan = Plan::index});
      EXPECT_TRUE(tally.exact()) << oracle::nameOf(kind) << " " << family << ": " << text(tally);
    }
}

TEST_F(OnDevice, AnIndexOfTwoHundredThousandSolids) {
  const World world = randomScene("mixed", 200000, 1).world;
  const auto rays = raysAround(32, 10, 6);
  for (const Method method : {Method::fast, Method::exact}) {
    const Difference d = differences(device(), world, rays, method);
    EXPECT_EQ(d.differ, 0u) << nameOf(method);
    EXPECT_GT(d.hits, 10u);
  }
}

}  // namespace
}  // namespace solidcast
