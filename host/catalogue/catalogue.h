// The catalogue of stiff and extreme cases as data: inputs in hex, the truth by the oracle, and what each method is
// allowed to answer. catalogue.json is made from the cases in tests/catalogue; tests and `study` read it through this.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/ray.h"
#include "host/scene/world.h"

namespace solidcast::catalogue {

using Real = __float128;

/// What a method may answer. `exact` of every case demands the truth; `naive` is the yardstick and may fail where it
/// is known to.
struct Allowed {
  enum Decision {
    truth,  // the true hit or miss and solid, t within `ulps`
    any,    // whatever; the failure is worth showing
    miss,   // t lies beyond fp32, so no fp32 number is a hit
  } decision = truth;
  double ulps = 1;  // fp32 ulps of t
};

struct Outcome {
  bool hit = false;
  int index = -1;  // of the solid
  Real t = 0;
  std::array<Real, 3> normal{}, local{};
  double marginUlps = 0;  // see oracle.h
  bool onEdge = false, tie = false;
  bool faceUncertain = false;  // a box's edge is hit: any of its faces' normals is right
};

/// A free ray at one or more solids.
struct RayCase {
  std::string id, note;
  std::vector<Shape> solids;
  QueryRay ray;
  Outcome truth;
  Allowed naive, fast, exact;
};

/// A picture of which some pixels are given.
struct ImageCase {
  std::string id, note;
  Scene scene;
  struct Pixel {
    int x = 0, y = 0;
    Outcome truth;  // t is the distance along the ideal ray
  };
  std::vector<Pixel> pixels;
  Allowed naive, fast, exact;
};

/// Must be refused with the exit code for bad input and one line that contains `about`. Either the scene is refused or,
/// where `isRay`, the ray.
struct RejectCase {
  std::string id, note, about;
  Scene scene;
  bool isRay = false;
  QueryRay ray;
};

/// Too many rays to list: families.h makes them. `kind` is a solid's name, or "mesh" for makeCracks with the families
/// "edges" and "vertices", whose every ray must hit.
struct FamilyCase {
  std::string id, note, kind, family;
  std::size_t rays = 0;
  std::uint64_t seed = 0;
};

struct Catalogue {
  std::vector<RayCase> rays;
  std::vector<ImageCase> images;
  std::vector<RejectCase> rejects;
  std::vector<FamilyCase> families;
  std::size_t size() const { return rays.size() + images.size() + rejects.size() + families.size(); }
};

/// Reads catalogue.json; throws std::runtime_error where it cannot.
Catalogue readCatalogue(const std::string& file);
/// The catalogue that the program carries, and its text.
Catalogue carriedCatalogue();
std::string_view carriedText();

/// The solids of a case as a World with one group.
World worldOf(const std::vector<Shape>& solids);

}  // namespace solidcast::catalogue
