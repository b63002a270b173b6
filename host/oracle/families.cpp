#include "host/oracle/families.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "host/oracle/aims.h"

namespace solidcast::oracle {
namespace {

struct Family {
  const char* name;
  std::vector<Kind> kinds;
  Subject (*subject)(Kind, Random&);
  QueryRay (*ray)(const Subject&, Random&);
};

const std::vector<Kind> kAll(std::begin(kKinds), std::end(kKinds));
const std::vector<Kind> kFinite{Kind::box, Kind::sphere, Kind::disc, Kind::triangle, Kind::quad, Kind::quadric};
const std::vector<Kind> kFlat{Kind::plane, Kind::box, Kind::disc, Kind::triangle, Kind::quad};

const std::vector<Family>& families() {
  static const std::vector<Family> list{
      {"generic", kAll, genericSubject, genericRay},
      {"far", kAll, genericSubject, farRay},
      {"tiny", kAll, tinySubject, tinyRay},
      {"offset", kAll, offsetSubject, genericRay},
      {"length", kAll, genericSubject, longRay},
      {"scaled", kAll, scaledSubject, genericRay},
      {"denormal", kAll, denormalSubject, denormalRay},
      {"axis", kAll, genericSubject, axisRay},
      {"boundary", kAll, genericSubject, boundaryRay},
      {"lattice", kAll, latticeSubject, latticeRay},
      {"rim", kFinite, genericSubject, rimRay},
      {"surface", kAll, genericSubject, surfaceRay},
      {"inside", {Kind::sphere, Kind::box, Kind::quadric}, closedSubject, insideRay},
      {"grazing", kFlat, genericSubject, grazingRay},
      {"face", {Kind::box}, floatBoxSubject, faceRay},
      {"planet", {Kind::sphere, Kind::quadric}, planetSubject, planetRay},
      {"sliver", {Kind::triangle, Kind::quad}, sliverSubject, spannedRay},
      {"parallel", {Kind::triangle, Kind::quad}, parallelSubject, spannedRay},
      {"spread", {Kind::quadric}, spreadSubject, genericRay},
      {"paraboloid", {Kind::quadric}, paraboloidSubject, nearAxisRay},
      {"generator", {Kind::quadric}, coneSubject, generatorRay},
      {"apex", {Kind::quadric}, coneSubject, apexRay},
      {"cylinder", {Kind::quadric}, cylinderSubject, boundaryRay},
  };
  return list;
}

}  // namespace

const char* nameOf(Kind kind) {
  switch (kind) {
    case Kind::plane:
      return "infinite_plane";
    case Kind::box:
      return "box";
    case Kind::sphere:
      return "sphere";
    case Kind::disc:
      return "disc";
    case Kind::triangle:
      return "triangle";
    case Kind::quad:
      return "quad";
    default:
      return "quadric";
  }
}

const std::vector<std::string>& familiesOf(Kind kind) {
  static const auto lists = [] {
    std::map<Kind, std::vector<std::string>> result;
    for (const Family& family : families()) {
      for (const Kind k : family.kinds) result[k].emplace_back(family.name);
    }
    return result;
  }();
  return lists.at(kind);
}

std::vector<Batch> makeBatches(Kind kind, const std::string& family, std::size_t rays, std::uint64_t seed,
                               std::size_t raysPerShape) {
  const auto& list = families();
  const auto found = std::find_if(list.begin(), list.end(), [&](const Family& f) { return family == f.name; });
  if (found == list.end() || std::count(found->kinds.begin(), found->kinds.end(), kind) == 0) {
    throw std::invalid_argument(std::string(nameOf(kind)) + " has no family '" + family + "'");
  }
  // Streams of different kinds, families and seeds have nothing to do with each other.
  Random random(seed * 1000003 + static_cast<std::uint64_t>(found - list.begin()) * 101 +
                static_cast<std::uint64_t>(kind));
  random = Random(random.bits());
  std::vector<Batch> batches;
  batches.reserve((rays + raysPerShape - 1) / raysPerShape);
  for (std::size_t done = 0; done < rays; done += raysPerShape) {
    const Subject subject = found->subject(kind, random);
    Batch& batch = batches.emplace_back(Batch{subject.shape, {}});
    const std::size_t count = std::min(raysPerShape, rays - done);
    batch.rays.reserve(count);
    for (std::size_t i = 0; i < count; ++i) batch.rays.push_back(found->ray(subject, random));
  }
  return batches;
}

}  // namespace solidcast::oracle
