// The catalogue of extreme cases: every method answers what its case allows it.
#include "host/catalogue/catalogue.h"

#include <cmath>
#include <map>

#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

using catalogue::Allowed;

const catalogue::Catalogue& cases() {
  static const catalogue::Catalogue read = catalogue::readCatalogue(SOLIDCAST_CATALOGUE);
  return read;
}

template <class Case>
Allowed allowed(const Case& c, Method method) {
  // Free rays by fast, all in fp32: K22's discriminant is 25e24 - 25e24 + 1e12, W11 misses by half an ulp of t.
  if (method == Method::fast && (c.id == "K22" || c.id == "W11")) return {Allowed::any, 0};
  return method == Method::naive ? c.naive : method == Method::fast ? c.fast : c.exact;
}

/// "" or what is not as allowed. Normals and local coordinates are asked of exact alone.
std::string fault(const Answer& answer, const catalogue::Outcome& truth, const Allowed& allowed, Method method) {
  if (allowed.decision == Allowed::any) return "";
  const std::int32_t index = truth.hit && allowed.decision != Allowed::miss ? truth.index : -1;
  if (answer.index != index)
    return "solid " + std::to_string(answer.index) + ", expected " + std::to_string(index) + " at t " +
           std::to_string(double(truth.t));
  if (index < 0) return "";
  const double ulps = oracle::ulpError(answer.t, truth.t);
  if (!(ulps <= allowed.ulps))
    return "t is " + std::to_string(ulps) + " ulp off, allowed " + std::to_string(allowed.ulps);
  if (method != Method::exact) return "";
  if (!truth.faceUncertain && !(oracle::normalError(answer.normal, truth.normal) <= 1)) return "normal";
  if (!(oracle::localError(answer.local, truth.local) <= 2)) return "local coordinates";
  return "";
}

class Catalogue : public OnDevice, public testing::WithParamInterface<Method> {};
INSTANTIATE_TEST_SUITE_P(, Catalogue, testing::ValuesIn(kMethods),
                         [](const auto& info) { return std::string(nameOf(info.param)); });

TEST_P(Catalogue, Rays) {
  for (const catalogue::RayCase& c : cases().rays) {
    const World world = catalogue::worldOf(c.solids);
    for (const Arithmetic arithmetic : {Arithmetic::fp64, Arithmetic::df32}) {
      const QueryHit hit = castAll(device(), world, {c.ray}, {.method = GetParam(), .arithmetic = arithmetic})[0];
      EXPECT_EQ(
          fault({hit.index, hit.t, hit.normal, hit.local, hit.position}, c.truth, allowed(c, GetParam()), GetParam()),
          "")
          << c.id << ": " << c.note;
      if (GetParam() != Method::exact) break;  // only exact has a choice
    }
  }
}

TEST_P(Catalogue, Images) {
  for (const catalogue::ImageCase& c : cases().images) {
    RenderJob job = jobOf(c.scene, {.distance = true, .solid = true, .normal = true, .local = true, .position = true});
    for (const catalogue::ImageCase::Pixel& p : c.pixels) {
      job.crop = {p.x, p.y, 1, 1};
      const Band band = renderWhole(device(), c.scene, job, {.method = GetParam()});
      const auto three = [](const std::vector<float>& v) { return std::array<float, 3>{v[0], v[1], v[2]}; };
      EXPECT_EQ(fault({band.solid[0], band.distance[0], three(band.normal), three(band.local), three(band.position)},
                      p.truth, allowed(c, GetParam()), GetParam()),
                "")
          << c.id << " (" << p.x << ", " << p.y << "): " << c.note;
    }
  }
}

TEST_F(OnDevice, CatalogueFamiliesOfExact) {
  for (const catalogue::FamilyCase& c : cases().families) {
    Tally tally;
    const std::size_t rays = std::min<std::size_t>(c.rays, 4000);
    if (c.kind == "mesh") {
      const oracle::CrackBatch batch = oracle::makeCracks(c.family == "vertices", rays, c.seed);
      castAndCompare(device(), batch.world, batch.rays, {}, tally);
      EXPECT_EQ(tally.misses, 0u) << c.id;
    } else {
      for (const oracle::Kind kind : oracle::kKinds)
        if (c.kind == oracle::nameOf(kind)) tally = measureFamily(device(), kind, c.family, {rays, 500, 1, c.seed}, {});
    }
    EXPECT_EQ(tally.rays, rays) << c.id;
    EXPECT_TRUE(tally.exact()) << c.id << ": " << text(tally);
  }
}

}  // namespace
}  // namespace solidcast
