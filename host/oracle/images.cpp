// Scenes of one solid each, for errors counted against ideal pixel rays.
#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <variant>

#include "host/oracle/aims.h"

namespace solidcast::oracle {
namespace {

struct View {
  Triple eye{}, target{};
  double angle = 45;  // vertical, degrees
};

Triple acrossOf(const Triple& forward, Random& random) {
  Triple up;
  do { up = random.direction(); } while (norm(outer(unitOf(forward), up)) < 0.1);
  return up;
}

PerspectiveCamera camera(const View& view, Random& random) {
  const Triple forward = difference(view.target, view.eye);
  return {view.eye, forward, acrossOf(forward, random), view.angle,
          std::fmin(view.angle * random.uniform(0.8, 1.4), 179.9999)};
}

View generic(const Subject& subject, Random& random) {
  const Triple eye = sum(subject.center, scaled(subject.size * random.uniform(1.2, 3), random.direction()));
  return {eye, sum(subject.center, scaled(0.3 * subject.size, random.inCube(1)))};
}

View narrow(const Subject& subject, Random& random) {
  View view = generic(subject, random);
  Triple across;
  outline(subject, random, view.eye, view.target, across);
  view.angle = 1e-6;
  return view;
}

// All but the middle pixels look along the horizon, so the eye is close above the ground or below it.
View wide(const Subject& subject, Random& random) {
  Triple point, normal;
  if (!pointOn(subject.shape, random, subject.center, subject.size, point, normal)) return generic(subject, random);
  const double height = random.sign() * subject.size * random.decade(-7, -5);
  return {sum(point, scaled(height, normal)), point, 179.9999};
}

View near(const Subject& subject, Random& random) {
  return {sum(subject.center, scaled(subject.size * random.uniform(0.6, 1.5), random.direction())), subject.center};
}

View far(const Subject& subject, Random& random) {
  const double away = random.decade(3, 6);
  return {sum(subject.center, scaled(subject.size * away, random.direction())), subject.center, 180 / away};
}

View surface(const Subject& subject, Random& random) {
  Triple point, normal;
  if (!pointOn(subject.shape, random, subject.center, subject.size, point, normal)) return generic(subject, random);
  const double height = random.chance(0.3) ? 0 : random.sign() * subject.size * random.decade(-9, -3);
  const Triple eye = sum(point, scaled(height, normal));
  return {eye, sum(eye, random.direction()), 90};
}

View inside(const Subject& subject, Random& random) {
  Triple point, normal;
  if (!pointOn(subject.shape, random, subject.center, subject.size, point, normal)) return generic(subject, random);
  const Triple eye = sum(subject.center, scaled(1 - random.decade(-9, 0), difference(point, subject.center)));
  return {eye, sum(eye, random.direction()), 90};
}

View planet(const Subject&, Random& random) {
  const Triple eye{random.uniform(-1, 1), random.uniform(1, 2), random.uniform(-1, 1)};
  Triple forward = random.direction();
  forward[1] = -random.decade(-5, 0);
  return {eye, sum(eye, forward), 60};
}

struct ImageFamily {
  const char* name;
  std::vector<Kind> kinds;
  Subject (*subject)(Kind, Random&);
  View (*view)(const Subject&, Random&);
};

const std::vector<ImageFamily>& imageFamilies() {
  static const std::vector<Kind> all(std::begin(kKinds), std::end(kKinds));
  static const std::vector<ImageFamily> list{
      {"perspective", all, genericSubject, generic},
      {"narrow", all, genericSubject, narrow},
      {"wide", all, genericSubject, wide},
      {"far", all, genericSubject, far},
      {"surface", all, genericSubject, surface},
      {"inside", {Kind::sphere, Kind::box, Kind::quadric}, closedSubject, inside},
      {"planet", {Kind::sphere, Kind::quadric}, planetSubject, planet},
      {"orthographic", all, genericSubject, generic},
      {"environment", all, genericSubject, near},
  };
  return list;
}

}  // namespace

const std::vector<std::string>& imageFamiliesOf(Kind kind) {
  static const auto lists = [] {
    std::map<Kind, std::vector<std::string>> result;
    for (const ImageFamily& family : imageFamilies()) {
      for (const Kind k : family.kinds) result[k].emplace_back(family.name);
    }
    return result;
  }();
  return lists.at(kind);
}

Scene makeImage(Kind kind, const std::string& family, int width, int height, std::uint64_t seed) {
  const auto& list = imageFamilies();
  const auto found = std::find_if(list.begin(), list.end(), [&](const ImageFamily& f) { return family == f.name; });
  if (found == list.end() || std::count(found->kinds.begin(), found->kinds.end(), kind) == 0) {
    throw std::invalid_argument(std::string(nameOf(kind)) + " has no image family '" + family + "'");
  }
  Random random(seed * 1000003 + static_cast<std::uint64_t>(found - list.begin()) * 101 +
                static_cast<std::uint64_t>(kind) + 31337);
  random = Random(random.bits());
  const Subject subject = found->subject(kind, random);
  const PerspectiveCamera view = camera(found->view(subject, random), random);
  Scene scene;
  scene.width = width;
  scene.height = height;
  scene.camera = view;
  if (family == "orthographic") {
    scene.camera = OrthographicCamera{view.center, view.forward, view.up, random.uniform(1, 4) * subject.size,
                                      random.uniform(1, 4) * subject.size};
  } else if (family == "environment") {
    scene.camera = EnvironmentCamera{view.center, view.forward, view.up, 180, 360};
  }
  scene.world.solids.push_back({nameOf(kind), subject.shape, 0});
  scene.world.groups[0].members.push_back({false, 0});
  return scene;
}

}  // namespace solidcast::oracle
