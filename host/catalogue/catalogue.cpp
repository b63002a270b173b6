#include "host/catalogue/catalogue.h"

#include <quadmath.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace solidcast::catalogue {
namespace {

using Json = nlohmann::json;

double number(const Json& json) { return std::strtod(json.get_ref<const std::string&>().c_str(), nullptr); }
Real real(const Json& json) { return strtoflt128(json.get_ref<const std::string&>().c_str(), nullptr); }

template <class Numbers>
Numbers numbers(const Json& json) {
  Numbers result{};
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = static_cast<typename Numbers::value_type>(number(json.at(i)));
  }
  return result;
}

Triple triple(const Json& json) { return numbers<Triple>(json); }

Shape shape(const Json& json) {
  const std::string type = json.at("type");
  if (type == "infinite_plane") return InfinitePlane{triple(json.at("origin")), triple(json.at("normal"))};
  if (type == "box") return AABox{triple(json.at("corner1")), triple(json.at("corner2"))};
  if (type == "sphere") return Sphere{triple(json.at("center")), number(json.at("radius"))};
  if (type == "disc") return Disc{triple(json.at("center")), triple(json.at("normal")), number(json.at("radius"))};
  if (type == "triangle") return Triangle{triple(json.at("v1")), triple(json.at("v2")), triple(json.at("v3"))};
  if (type == "quad") return Quad{triple(json.at("vertex")), triple(json.at("span1")), triple(json.at("span2"))};
  if (type == "quadric") return Quadric{numbers<std::array<double, 10>>(json.at("coefficients"))};
  throw std::runtime_error("catalogue: unknown solid '" + type + "'");
}

std::vector<Shape> shapes(const Json& json) {
  std::vector<Shape> result;
  for (const Json& solid : json) result.push_back(shape(solid));
  return result;
}

Camera camera(const Json& json) {
  const std::string type = json.at("type");
  const Triple center = triple(json.at("center")), forward = triple(json.at("forward")), up = triple(json.at("up"));
  if (type == "orthographic") {
    return OrthographicCamera{center, forward, up, number(json.at("scale_x")), number(json.at("scale_y"))};
  }
  const double vertical = number(json.at("vertical_angle")), horizontal = number(json.at("horizontal_angle"));
  if (type == "environment") return EnvironmentCamera{center, forward, up, vertical, horizontal};
  if (type == "perspective") return PerspectiveCamera{center, forward, up, vertical, horizontal};
  throw std::runtime_error("catalogue: unknown camera '" + type + "'");
}

QueryRay ray(const Json& json) {
  using Float3 = std::array<float, 3>;
  return {numbers<Float3>(json.at("origin")), numbers<Float3>(json.at("direction")),
          static_cast<float>(number(json.at("tmax")))};
}

Outcome outcome(const Json& json) {
  Outcome result;
  result.hit = json.at("hit");
  result.marginUlps = number(json.at("margin_ulps"));
  if (!result.hit) return result;
  result.index = json.at("index");
  result.t = real(json.at("t"));
  for (std::size_t i = 0; i < 3; ++i) {
    result.normal[i] = real(json.at("normal").at(i));
    result.local[i] = real(json.at("local").at(i));
  }
  result.onEdge = json.value("on_edge", false);
  result.tie = json.value("tie", false);
  result.faceUncertain = json.value("face_uncertain", false);
  return result;
}

Allowed allowed(const Json& json) {
  if (json == "any") return {Allowed::any, 0};
  if (json == "miss") return {Allowed::miss, 0};
  return {Allowed::truth, json.at("ulps")};
}

template <class Case>
void readAllowed(const Json& json, Case& c) {
  const Json& methods = json.at("allowed");
  c.naive = allowed(methods.at("naive"));
  c.fast = allowed(methods.at("fast"));
  c.exact = allowed(methods.at("exact"));
}

Scene scene(const Json& json) {
  Scene result;
  result.width = json.at("size").at(0);
  result.height = json.at("size").at(1);
  result.camera = camera(json.at("camera"));
  result.world = worldOf(shapes(json.at("solids")));
  return result;
}

Catalogue fromJson(const Json& json) {
  Catalogue catalogue;
  for (const Json& j : json.at("rays")) {
    RayCase& c = catalogue.rays.emplace_back();
    c.id = j.at("id"), c.note = j.at("note");
    c.solids = shapes(j.at("solids"));
    c.ray = ray(j.at("ray"));
    c.truth = outcome(j.at("truth"));
    readAllowed(j, c);
  }
  for (const Json& j : json.at("images")) {
    ImageCase& c = catalogue.images.emplace_back();
    c.id = j.at("id"), c.note = j.at("note");
    c.scene = scene(j);
    for (const Json& p : j.at("pixels")) c.pixels.push_back({p.at("x"), p.at("y"), outcome(p.at("truth"))});
    readAllowed(j, c);
  }
  for (const Json& j : json.at("rejects")) {
    RejectCase& c = catalogue.rejects.emplace_back();
    c.id = j.at("id"), c.note = j.at("note"), c.about = j.at("about");
    c.isRay = j.contains("ray");
    if (c.isRay) {
      c.ray = ray(j.at("ray"));
    } else {
      c.scene = scene(j);
    }
  }
  for (const Json& j : json.at("families")) {
    catalogue.families.push_back({j.at("id"), j.at("note"), j.at("kind"), j.at("family"), j.at("rays"), j.at("seed")});
  }
  return catalogue;
}

}  // namespace

World worldOf(const std::vector<Shape>& solids) {
  World world;
  for (const Shape& solid : solids) {
    world.groups[0].members.push_back({false, static_cast<std::uint32_t>(world.solids.size())});
    world.solids.push_back({"", solid, 0});
  }
  return world;
}

Catalogue readCatalogue(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("catalogue: cannot open " + file);
  return fromJson(Json::parse(in));
}

Catalogue carriedCatalogue() { return fromJson(Json::parse(carriedText())); }

}  // namespace solidcast::catalogue
