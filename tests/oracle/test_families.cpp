// Properties of the oracle over all families of rays.
#include <gtest/gtest.h>
#include <quadmath.h>

#include <cmath>
#include <set>
#include <variant>

#include "host/oracle/families.h"
#include "host/oracle/oracle.h"
#include "reference_cpu/reference.h"
#include "tests/oracle/helpers.h"

namespace solidcast::oracle {
namespace {

using Parameter = std::pair<Kind, std::string>;

std::vector<Parameter> everyFamily() {
  std::vector<Parameter> list;
  for (const Kind kind : kKinds) {
    for (const std::string& family : familiesOf(kind)) list.emplace_back(kind, family);
  }
  return list;
}

std::string label(const testing::TestParamInfo<Parameter>& info) {
  return std::string(nameOf(info.param.first)) + "_" + info.param.second;
}

class Families : public testing::TestWithParam<Parameter> {
 protected:
  std::vector<Batch> batches(std::size_t rays, std::uint64_t seed, std::size_t raysPerShape = 1) const {
    return makeBatches(GetParam().first, GetParam().second, rays, seed, raysPerShape);
  }
};
INSTANTIATE_TEST_SUITE_P(, Families, testing::ValuesIn(everyFamily()), label);

// Without the inputs near the ends of fp32, which scaling would round.
std::vector<Parameter> scalableFamilies() {
  std::vector<Parameter> list = everyFamily();
  std::erase_if(list, [](const Parameter& p) { return p.second == "denormal" || p.second == "scaled"; });
  return list;
}
class ScalableFamilies : public Families {};
INSTANTIATE_TEST_SUITE_P(, ScalableFamilies, testing::ValuesIn(scalableFamilies()), label);

double distance(const Real3& a, const Real3& b) {
  Real worst = 0;
  for (int i = 0; i < 3; ++i) worst = fmaxq(worst, fabsq(a[i] - b[i]));
  return static_cast<double>(worst);
}

// --- the same on every run, and of the kind they claim to be ----------------------------------------------------

TEST_P(Families, AreDeterministicUsableAndNotTrivial) {
  const auto first = batches(400, 3), again = batches(400, 3), other = batches(400, 4);
  ASSERT_EQ(first.size(), 400u);
  int hits = 0, sameAsOther = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const QueryRay &ray = first[i].rays.at(0), &repeated = again[i].rays.at(0);
    ASSERT_EQ(ray.origin, repeated.origin);
    ASSERT_EQ(ray.direction, repeated.direction);
    sameAsOther += ray.direction == other[i].rays.at(0).direction && ray.origin == other[i].rays.at(0).origin;
    ASSERT_NE(ray.direction, (std::array<float, 3>{}));
    for (int k = 0; k < 3; ++k) ASSERT_TRUE(std::isfinite(ray.origin[k]) && std::isfinite(ray.direction[k])) << i;
    hits += intersect(first[i].shape, exactRay(ray)).hit;
  }
  EXPECT_LT(sameAsOther, 200);
  EXPECT_GT(hits, 5) << "a family that is never hit measures nothing";
  const auto shared = batches(25, 3, 10);
  ASSERT_EQ(shared.size(), 3u);
  EXPECT_EQ(shared[2].rays.size(), 5u);
}

// --- every level of arithmetic tells the same --------------------------------------------------------------------

TEST_P(Families, BoundedArithmeticAgreesWithExact) {
  for (const Batch& batch : batches(400, 11)) {
    const Ray128 ray = exactRay(batch.rays[0]);
    const Truth quick = intersect(batch.shape, ray), full = intersect(batch.shape, ray, Effort::full);
    ASSERT_EQ(quick.hit, full.hit);
    ASSERT_EQ(quick.exactlyOnEdge, full.exactlyOnEdge);
    if (!full.hit) continue;
    ASSERT_LE(relative(quick.t, full.t), 0x1p-48);
    ASSERT_LE(distance(quick.normal, full.normal), 0x1p-38);
    const Real largest = fmaxq(fmaxq(fabsq(full.local[0]), fabsq(full.local[1])), fabsq(full.local[2]));
    ASSERT_LE(distance(quick.local, full.local), 0x1p-38Q * largest);
    if (full.marginUlps > 0x1p-10) { ASSERT_NEAR(quick.marginUlps / full.marginUlps, 1, 0.05); }
  }
}

// --- properties that need no oracle ------------------------------------------------------------------------------

void scaleBy(double s, Shape& shape, QueryRay& ray) {
  const auto scale = [s](auto&... numbers) {
    const auto one = [s](auto& x) {
      if constexpr (std::is_same_v<std::decay_t<decltype(x)>, double>) {
        x *= s;
      } else {
        for (double& y : x) y *= s;
      }
    };
    (one(numbers), ...);
  };
  if (auto* plane = std::get_if<InfinitePlane>(&shape)) scale(plane->origin);
  if (auto* box = std::get_if<AABox>(&shape)) scale(box->corner1, box->corner2);
  if (auto* sphere = std::get_if<Sphere>(&shape)) scale(sphere->center, sphere->radius);
  if (auto* disc = std::get_if<Disc>(&shape)) scale(disc->center, disc->radius);
  if (auto* triangle = std::get_if<Triangle>(&shape)) scale(triangle->v1, triangle->v2, triangle->v3);
  if (auto* quad = std::get_if<Quad>(&shape)) scale(quad->vertex, quad->span1, quad->span2);
  if (auto* quadric = std::get_if<Quadric>(&shape)) {
    auto& q = quadric->coefficients;
    for (int i = 6; i < 9; ++i) q[i] *= s;
    q[9] *= s * s;
  }
  for (float& x : ray.origin) x = static_cast<float>(x * s);
}

TEST_P(ScalableFamilies, ScalingByPowersOfTwoScalesT) {
  for (Batch batch : batches(300, 12)) {
    QueryRay ray = batch.rays[0];
    const Truth before = intersect(batch.shape, exactRay(ray), Effort::full);
    scaleBy(0x1p7, batch.shape, ray);
    const Truth after = intersect(batch.shape, exactRay(ray), Effort::full);
    ASSERT_EQ(before.hit, after.hit);
    ASSERT_TRUE(before.t * 0x1p7 == after.t);
    ASSERT_LE(distance(before.normal, after.normal), 1e-32);
  }
}

void turn(Triple& v) { v = {v[1], v[2], -v[0]}; }  // new x = old y, new y = old z, new z = -old x
void turn(Shape& shape) {
  if (auto* plane = std::get_if<InfinitePlane>(&shape)) turn(plane->origin), turn(plane->normal);
  if (auto* box = std::get_if<AABox>(&shape)) turn(box->corner1), turn(box->corner2);
  if (auto* sphere = std::get_if<Sphere>(&shape)) turn(sphere->center);
  if (auto* disc = std::get_if<Disc>(&shape)) turn(disc->center), turn(disc->normal);
  if (auto* triangle = std::get_if<Triangle>(&shape)) {
    // A mirror image: the order of the vertices is exchanged so that the normal is mirrored too.
    turn(triangle->v1), turn(triangle->v2), turn(triangle->v3);
    std::swap(triangle->v2, triangle->v3);
  }
  if (auto* quad = std::get_if<Quad>(&shape)) {
    turn(quad->vertex), turn(quad->span1), turn(quad->span2);
    std::swap(quad->span1, quad->span2);
  }
  if (auto* quadric = std::get_if<Quadric>(&shape)) {
    const auto q = quadric->coefficients;  // x = -z', y = x', z = y'
    quadric->coefficients = {q[1], q[2], q[0], q[5], -q[3], -q[4], q[7], q[8], -q[6], q[9]};
  }
}

TEST_P(Families, TurningAndMirroringTheAxesChangesNothing) {
  for (Batch batch : batches(300, 13)) {
    QueryRay ray = batch.rays[0];
    const Truth before = intersect(batch.shape, exactRay(ray), Effort::full);
    turn(batch.shape);
    ray.origin = {ray.origin[1], ray.origin[2], -ray.origin[0]};
    ray.direction = {ray.direction[1], ray.direction[2], -ray.direction[0]};
    const Truth after = intersect(batch.shape, exactRay(ray), Effort::full);
    ASSERT_EQ(before.hit, after.hit);
    ASSERT_TRUE(before.t == after.t);
    if (!before.hit || before.faceMarginUlps == 0) continue;  // an edge's face is the lowest axis', which turned
    const Real3 turned{before.normal[1], before.normal[2], -before.normal[0]};
    ASSERT_LE(distance(turned, after.normal), 1e-32);
  }
}

TEST_P(Families, TheLimitCutsExactlyAtT) {
  for (const Batch& batch : batches(200, 14)) {
    QueryRay ray = batch.rays[0];
    const Truth truth = intersect(batch.shape, exactRay(ray), Effort::full);
    if (!truth.hit || beyondFloat(truth.t)) continue;
    ray.tMax = static_cast<float>(truth.t);
    if (ray.tMax == 0) continue;
    EXPECT_EQ(intersect(batch.shape, exactRay(ray)).hit, truth.t < ray.tMax);
    ray.tMax = std::nextafter(ray.tMax, INFINITY);
    EXPECT_EQ(intersect(batch.shape, exactRay(ray)).hit, truth.t < ray.tMax);
  }
}

Quadric negated(Quadric quadric) {
  for (double& x : quadric.coefficients) x = -x;
  return quadric;
}

TEST(Equivalents, NegatedQuadricKeepsTAndTurnsTheNormal) {
  for (const std::string& family : familiesOf(Kind::quadric)) {
    for (const Batch& batch : makeBatches(Kind::quadric, family, 200, 15)) {
      const Ray128 ray = exactRay(batch.rays[0]);
      const Truth a = intersect(batch.shape, ray, Effort::full),
                  b = intersect(negated(std::get<Quadric>(batch.shape)), ray, Effort::full);
      ASSERT_EQ(a.hit, b.hit) << family;
      ASSERT_TRUE(a.t == b.t) << family;
      const Real3 turned{-b.normal[0], -b.normal[1], -b.normal[2]};
      if (!a.hit) continue;
      // At an apex there is no gradient to turn.
      const double same = a.exactlyOnEdge ? distance(a.normal, b.normal) : 9;
      ASSERT_LE(std::fmin(distance(a.normal, turned), same), 1e-32) << family;
    }
  }
}

// Solids written in other solids, over families whose numbers are integers so that the translation is exact.
TEST(Equivalents, SphereIsItsQuadric) {
  int hits = 0;
  for (const Batch& batch : makeBatches(Kind::sphere, "lattice", 2000, 16)) {
    const auto& s = std::get<Sphere>(batch.shape);
    const auto& c = s.center;
    const Quadric q{{1, 1, 1, 0, 0, 0, -2 * c[0], -2 * c[1], -2 * c[2],
                     c[0] * c[0] + c[1] * c[1] + c[2] * c[2] - s.radius * s.radius}};
    const Ray128 ray = exactRay(batch.rays[0]);
    const Truth a = intersect(s, ray, Effort::full), b = intersect(q, ray, Effort::full);
    ASSERT_EQ(a.hit, b.hit);
    ASSERT_TRUE(a.t == b.t || relative(a.t, b.t) < 1e-33);
    if (a.hit) { ASSERT_LE(distance(a.normal, b.normal), 1e-30); }
    if (a.hit) { ASSERT_EQ(compareHits(s, q, ray), 0); }
    hits += a.hit;
  }
  EXPECT_GT(hits, 200);
}

TEST(Equivalents, BoxIsItsSixQuads) {
  int hits = 0;
  for (const char* family : {"lattice", "face"}) {
    for (const Batch& batch : makeBatches(Kind::box, family, 1500, 17)) {
      const auto& box = std::get<AABox>(batch.shape);
      std::vector<Shape> quads;
      bool exact = true;
      for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        Triple along{}, across{};
        along[u] = box.corner2[u] - box.corner1[u];
        across[v] = box.corner2[v] - box.corner1[v];
        exact = exact && box.corner1[u] + along[u] == box.corner2[u];
        Triple far = box.corner1;
        far[axis] = box.corner2[axis];
        quads.emplace_back(Quad{box.corner1, across, along});
        quads.emplace_back(Quad{far, along, across});
      }
      if (!exact) continue;  // a span that fp64 cannot hold
      const Ray128 ray = exactRay(batch.rays[0]);
      const Truth truth = intersect(box, ray);
      const WorldTruth faces = cast(worldOf(quads), ray);
      // A ray along a face or from it is the box's business only: it has an inside.
      if (truth.marginUlps == 0) continue;
      ASSERT_EQ(truth.hit, faces.index >= 0);
      if (!truth.hit) continue;
      ++hits;
      ASSERT_LE(relative(truth.t, faces.truth.t), 0x1p-47);
      if (truth.faceMarginUlps > 0) { ASSERT_LE(distance(truth.normal, faces.truth.normal), 1e-10); }
    }
  }
  EXPECT_GT(hits, 200);
}

TEST(Equivalents, QuadIsItsTwoTriangles) {
  int hits = 0;
  for (const Batch& batch : makeBatches(Kind::quad, "lattice", 2000, 18)) {
    const auto& q = std::get<Quad>(batch.shape);
    const auto add = [](const Triple& a, const Triple& b) { return Triple{a[0] + b[0], a[1] + b[1], a[2] + b[2]}; };
    const Triple b = add(q.vertex, q.span1), c = add(b, q.span2), d = add(q.vertex, q.span2);
    const Ray128 ray = exactRay(batch.rays[0]);
    const Truth truth = intersect(q, ray);
    const WorldTruth halves = cast(worldOf({Triangle{q.vertex, b, c}, Triangle{q.vertex, c, d}}), ray);
    ASSERT_EQ(truth.hit, halves.index >= 0);
    if (!truth.hit) continue;
    ++hits;
    ASSERT_LE(relative(truth.t, halves.truth.t), 0x1p-47);
    ASSERT_LE(distance(truth.normal, halves.truth.normal), 1e-10);
  }
  EXPECT_GT(hits, 200);
}

TEST(Equivalents, OrderOfSolidsMattersOnlyAtEqualT) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    std::vector<Shape> shapes;
    for (const Kind kind : kKinds) shapes.push_back(makeBatches(kind, "generic", 1, seed)[0].shape);
    std::vector<Shape> reversed(shapes.rbegin(), shapes.rend());
    const World forwards = worldOf(shapes), backwards = worldOf(reversed);
    for (const Batch& batch : makeBatches(Kind::sphere, "generic", 50, seed)) {
      const Ray128 ray = exactRay(batch.rays[0]);
      const WorldTruth a = cast(forwards, ray), b = cast(backwards, ray);
      ASSERT_FALSE(a.tie);
      ASSERT_EQ(a.index, b.index < 0 ? -1 : 6 - b.index);
      ASSERT_TRUE(a.truth.t == b.truth.t && a.secondT == b.secondT);
    }
  }
}

// --- meshes and images ---------------------------------------------------------------------------------------------

TEST(Meshes, AreClosedForRaysAtTheirSeams) {
  for (const bool vertices : {false, true}) {
    int ties = 0;
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      const CrackBatch batch = makeCracks(vertices, 100, seed);
      for (const QueryRay& ray : batch.rays) {
        const WorldTruth truth = cast(batch.world, exactRay(ray));
        ASSERT_GE(truth.index, 0) << seed;
        ties += truth.tie;
      }
    }
    if (vertices) { EXPECT_GT(ties, 10) << "some rays go exactly through a vertex"; }
  }
}

TEST(Images, AreScenesThatShowTheirSolid) {
  for (const Kind kind : kKinds) {
    for (const std::string& family : imageFamiliesOf(kind)) {
      int hits = 0;
      for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const Scene scene = makeImage(kind, family, 9, 7, seed);
        ASSERT_EQ(scene.world.solids.size(), 1u);
        for (int j = 0; j < 7; ++j) {
          for (int i = 0; i < 9; ++i) {
            const Ray128 ray = pixelRay(scene.camera, 9, 7, i + 0.5, j + 0.5);
            ASSERT_GT(ray.length, 0);
            hits += cast(scene.world, ray).index >= 0;
          }
        }
      }
      EXPECT_GT(hits, 5) << nameOf(kind) << ' ' << family;
    }
  }
}

// --- a cross-check against other formulas: not a source of truth ----------------------------------------------------

TEST_P(Families, ReferenceInBinary128AgreesAwayFromEdges) {
  int compared = 0;
  for (const Batch& batch : batches(150, 19)) {
    const WorldTruth truth = cast(worldOf({batch.shape}), exactRay(batch.rays[0]));
    QueryHit hit;
    reference::cast(worldOf({batch.shape}), batch.rays, {&hit, 1}, reference::Precision::f128, 1);
    if (truth.marginUlps < 1e-18 || (truth.index >= 0 && beyondFloat(truth.truth.t))) continue;
    ++compared;
    EXPECT_EQ(hit.index, truth.index) << "margin " << truth.marginUlps;
    if (!hit || truth.index < 0) continue;
    EXPECT_LE(ulpError(hit.t, truth.truth.t), 0.500001);
    if (truth.truth.faceMarginUlps > 1e-18) { EXPECT_LE(normalError(hit.normal, truth.truth.normal), 0.51); }
    EXPECT_LE(localError(hit.local, truth.truth.local), 0.51);
  }
  EXPECT_GT(compared, 20);
}

}  // namespace
}  // namespace solidcast::oracle
