#include "tests/catalogue/cases.h"

#include <cmath>

#include "host/oracle/oracle.h"

namespace solidcast::catalogue {
namespace {

void allow(Hard hard, Allowed& naive, Allowed& fast) {
  naive = {hard == Hard::none ? Allowed::truth : Allowed::any, 4096};
  fast = {hard == Hard::fast ? Allowed::any : Allowed::truth, 256};
}

Outcome outcomeOf(const World& world, const oracle::Ray128& ray) {
  const oracle::WorldTruth truth = oracle::cast(world, ray, oracle::Effort::full);
  Outcome outcome;
  outcome.hit = truth.index >= 0;
  outcome.index = truth.index;
  outcome.marginUlps = truth.marginUlps;
  if (!outcome.hit) return outcome;
  outcome.t = truth.truth.t;
  outcome.normal = truth.truth.normal;
  outcome.local = truth.truth.local;
  outcome.onEdge = truth.truth.exactlyOnEdge;
  outcome.tie = truth.tie;
  outcome.faceUncertain = truth.truth.faceMarginUlps == 0;
  return outcome;
}

void allowBeyondFloat(const Outcome& truth, Allowed& naive, Allowed& fast, Allowed& exact) {
  if (!truth.hit || !oracle::beyondFloat(truth.t)) return;
  naive = fast = {Allowed::any, 0};
  exact = {Allowed::miss, 0};
}

}  // namespace

Float3 unit(double x, double y, double z) {
  const double length = std::sqrt(x * x + y * y + z * z);
  return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

void addLimitedRay(Catalogue& to, const char* id, const char* note, std::vector<Shape> solids, const QueryRay& ray,
                   Hard hard) {
  RayCase& added = to.rays.emplace_back();
  added.id = id;
  added.note = note;
  added.solids = std::move(solids);
  added.ray = ray;
  allow(hard, added.naive, added.fast);
}

void addRay(Catalogue& to, const char* id, const char* note, std::vector<Shape> solids, const Float3& origin,
            const Float3& direction, Hard hard) {
  addLimitedRay(to, id, note, std::move(solids), {origin, direction}, hard);
}

void addReject(Catalogue& to, const char* id, const char* note, const char* about, const Shape& solid) {
  RejectCase& added = to.rejects.emplace_back();
  added.id = id;
  added.note = note;
  added.about = about;
  added.scene.world = worldOf({solid});
}

void addCameraReject(Catalogue& to, const char* id, const char* note, const char* about, const Camera& camera,
                     int width, int height) {
  RejectCase& added = to.rejects.emplace_back();
  added.id = id;
  added.note = note;
  added.about = about;
  added.scene.camera = camera;
  added.scene.width = width;
  added.scene.height = height;
}

void addRayReject(Catalogue& to, const char* id, const char* note, const char* about, const QueryRay& ray) {
  RejectCase& added = to.rejects.emplace_back();
  added.id = id;
  added.note = note;
  added.about = about;
  added.isRay = true;
  added.ray = ray;
}

void addImage(Catalogue& to, const char* id, const char* note, std::vector<Shape> solids, const Camera& camera,
              int width, int height, const std::vector<std::array<int, 2>>& pixels, Hard hard) {
  ImageCase& added = to.images.emplace_back();
  added.id = id;
  added.note = note;
  added.scene.world = worldOf(solids);
  added.scene.camera = camera;
  added.scene.width = width;
  added.scene.height = height;
  for (const auto& [x, y] : pixels) added.pixels.push_back({x, y, {}});
  allow(hard, added.naive, added.fast);
}

void addFamily(Catalogue& to, const char* id, const char* note, const char* kind, const char* family,
               std::size_t rays) {
  to.families.push_back({id, note, kind, family, rays, 1});
}

Catalogue allCases() {
  Catalogue all;
  addSpheres(all);
  addPlanes(all);
  addBoxes(all);
  addDiscsAndQuads(all);
  addTriangles(all);
  addQuadrics(all);
  addRaysAndCameras(all);
  addWorse(all);
  return all;
}

void fillTruth(Catalogue& catalogue) {
  for (RayCase& c : catalogue.rays) {
    c.truth = outcomeOf(worldOf(c.solids), oracle::exactRay(c.ray));
    allowBeyondFloat(c.truth, c.naive, c.fast, c.exact);
  }
  for (ImageCase& c : catalogue.images) {
    const Scene& s = c.scene;
    for (ImageCase::Pixel& pixel : c.pixels) {
      pixel.truth = outcomeOf(s.world, oracle::pixelRay(s.camera, s.width, s.height, pixel.x + 0.5, pixel.y + 0.5));
    }
  }
}

}  // namespace solidcast::catalogue
