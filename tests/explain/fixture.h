// Explanations on the one device, and scenes for them.
#pragma once
#include "host/explain/explain.h"
#include "host/oracle/families.h"
#include "tests/cast/fixture.h"

namespace solidcast::explain {

class Explain : public OnDevice {
 protected:
  static Explanation at(const Scene& scene, int x, int y, Method method, Arithmetic arithmetic = Arithmetic::automatic,
                        reference::Precision precision = reference::Precision::f64) {
    const RenderJob job{scene.width, scene.height, {}, 1, scene.twoSided, {}};
    return explainPixel(device(), scene, job, {.method = method, .arithmetic = arithmetic}, precision, x, y);
  }
};

/// A picture of one pixel, whose ray is exactly this one: the middle of an image looks along `forward` itself.
inline Scene onePixel(const std::vector<Shape>& solids, const Triple& eye, const Triple& forward) {
  Scene scene;
  scene.file = "one pixel";
  scene.width = scene.height = 1;
  const bool steep = std::abs(forward[1]) > std::abs(forward[0]) && std::abs(forward[1]) > std::abs(forward[2]);
  scene.camera = PerspectiveCamera{eye, forward, steep ? Triple{1, 0, 0} : Triple{0, 1, 0}, 45, 45};
  for (const Shape& shape : solids) {
    scene.world.groups[0].members.push_back({false, static_cast<std::uint32_t>(scene.world.solids.size())});
    scene.world.solids.push_back({"", shape, 0});
  }
  return scene;
}

inline const Candidate* candidate(const Explanation& e, std::int32_t index) {
  for (const Candidate& c : e.candidates)
    if (c.index == index) return &c;
  return nullptr;
}

inline const Stage* stage(const Candidate& c, const std::string& name) {
  for (const Stage& s : c.trial.stages)
    if (s.name == name) return &s;
  return nullptr;
}

}  // namespace solidcast::explain
