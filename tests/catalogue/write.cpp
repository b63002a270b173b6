// catalogue.json, one case a line: inputs as hex floats, truths as decimals of 30 digits.
#include <quadmath.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <variant>

#include "tests/catalogue/cases.h"

namespace solidcast::catalogue {
namespace {

using Json = nlohmann::ordered_json;

std::string hex(double x) {
  char text[64];
  std::snprintf(text, sizeof text, "%a", x);
  return text;
}

template <class Numbers>
Json hexList(const Numbers& numbers) {
  Json list = Json::array();
  for (const auto x : numbers) list.push_back(hex(x));
  return list;
}

std::string decimal(Real x) {
  char text[64];
  quadmath_snprintf(text, sizeof text, "%.29Qe", x);
  return text;
}

Json decimals(const std::array<Real, 3>& v) { return {decimal(v[0]), decimal(v[1]), decimal(v[2])}; }

struct ShapeJson {
  Json operator()(const InfinitePlane& s) const {
    return {{"type", "infinite_plane"}, {"origin", hexList(s.origin)}, {"normal", hexList(s.normal)}};
  }
  Json operator()(const AABox& s) const {
    return {{"type", "box"}, {"corner1", hexList(s.corner1)}, {"corner2", hexList(s.corner2)}};
  }
  Json operator()(const Sphere& s) const {
    return {{"type", "sphere"}, {"center", hexList(s.center)}, {"radius", hex(s.radius)}};
  }
  Json operator()(const Disc& s) const {
    return {{"type", "disc"}, {"center", hexList(s.center)}, {"normal", hexList(s.normal)}, {"radius", hex(s.radius)}};
  }
  Json operator()(const Triangle& s) const {
    return {{"type", "triangle"}, {"v1", hexList(s.v1)}, {"v2", hexList(s.v2)}, {"v3", hexList(s.v3)}};
  }
  Json operator()(const Quad& s) const {
    return {{"type", "quad"}, {"vertex", hexList(s.vertex)}, {"span1", hexList(s.span1)}, {"span2", hexList(s.span2)}};
  }
  Json operator()(const Quadric& s) const { return {{"type", "quadric"}, {"coefficients", hexList(s.coefficients)}}; }
};

Json solidsOf(const World& world) {
  Json list = Json::array();
  for (const SolidEntry& solid : world.solids) list.push_back(std::visit(ShapeJson{}, solid.shape));
  return list;
}

Json rayJson(const QueryRay& ray) {
  return {{"origin", hexList(ray.origin)}, {"direction", hexList(ray.direction)}, {"tmax", hex(ray.tMax)}};
}

struct CameraJson {
  template <class C>
  Json frame(const char* type, const C& c) const {
    return {{"type", type}, {"center", hexList(c.center)}, {"forward", hexList(c.forward)}, {"up", hexList(c.up)}};
  }
  Json operator()(const PerspectiveCamera& c) const {
    Json json = frame("perspective", c);
    json["vertical_angle"] = hex(c.verticalAngle);
    json["horizontal_angle"] = hex(c.horizontalAngle);
    return json;
  }
  Json operator()(const OrthographicCamera& c) const {
    Json json = frame("orthographic", c);
    json["scale_x"] = hex(c.scaleX);
    json["scale_y"] = hex(c.scaleY);
    return json;
  }
  Json operator()(const EnvironmentCamera& c) const {
    Json json = frame("environment", c);
    json["vertical_angle"] = hex(c.verticalAngle);
    json["horizontal_angle"] = hex(c.horizontalAngle);
    return json;
  }
};

Json outcomeJson(const Outcome& outcome) {
  Json json{{"hit", outcome.hit}};
  char margin[32];
  std::snprintf(margin, sizeof margin, "%.3g", outcome.marginUlps);
  if (outcome.hit) {
    json["index"] = outcome.index;
    json["t"] = decimal(outcome.t);
    json["normal"] = decimals(outcome.normal);
    json["local"] = decimals(outcome.local);
    if (outcome.onEdge) json["on_edge"] = true;
    if (outcome.tie) json["tie"] = true;
    if (outcome.faceUncertain) json["face_uncertain"] = true;
  }
  json["margin_ulps"] = margin;
  return json;
}

Json allowedJson(const Allowed& allowed) {
  if (allowed.decision == Allowed::any) return "any";
  if (allowed.decision == Allowed::miss) return "miss";
  return {{"ulps", allowed.ulps}};
}

template <class Case>
void addAllowed(Json& json, const Case& c) {
  json["allowed"] = {{"naive", allowedJson(c.naive)}, {"fast", allowedJson(c.fast)}, {"exact", allowedJson(c.exact)}};
}

std::string section(const char* name, const std::vector<Json>& cases, bool last) {
  std::string text = std::string("\"") + name + "\": [\n";
  for (const Json& c : cases) text += c.dump() + (&c == &cases.back() ? "\n" : ",\n");
  return text + (last ? "]\n" : "],\n");
}

}  // namespace

std::string writeCatalogue(const Catalogue& catalogue) {
  std::vector<Json> rays, images, rejects, families;
  for (const RayCase& c : catalogue.rays) {
    Json& json = rays.emplace_back(Json{{"id", c.id}, {"note", c.note}});
    json["solids"] = solidsOf(worldOf(c.solids));
    json["ray"] = rayJson(c.ray);
    json["truth"] = outcomeJson(c.truth);
    addAllowed(json, c);
  }
  for (const ImageCase& c : catalogue.images) {
    Json& json = images.emplace_back(Json{{"id", c.id}, {"note", c.note}});
    json["size"] = {c.scene.width, c.scene.height};
    json["camera"] = std::visit(CameraJson{}, c.scene.camera);
    json["solids"] = solidsOf(c.scene.world);
    json["pixels"] = Json::array();
    for (const ImageCase::Pixel& pixel : c.pixels) {
      json["pixels"].push_back({{"x", pixel.x}, {"y", pixel.y}, {"truth", outcomeJson(pixel.truth)}});
    }
    addAllowed(json, c);
  }
  for (const RejectCase& c : catalogue.rejects) {
    Json& json = rejects.emplace_back(Json{{"id", c.id}, {"note", c.note}, {"about", c.about}});
    if (c.isRay) {
      json["ray"] = rayJson(c.ray);
      continue;
    }
    json["size"] = {c.scene.width, c.scene.height};
    json["camera"] = std::visit(CameraJson{}, c.scene.camera);
    json["solids"] = solidsOf(c.scene.world);
  }
  for (const FamilyCase& c : catalogue.families) {
    families.emplace_back(Json{
        {"id", c.id}, {"note", c.note}, {"kind", c.kind}, {"family", c.family}, {"rays", c.rays}, {"seed", c.seed}});
  }
  return "{\n" + section("rays", rays, false) + section("images", images, false) + section("rejects", rejects, false) +
         section("families", families, true) + "}\n";
}

}  // namespace solidcast::catalogue
