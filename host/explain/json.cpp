// An explanation for programs: the same as the text, every number in full.
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/explain/explain.h"
#include "host/explain/words.h"

namespace solidcast::explain {
namespace {

using Json = nlohmann::ordered_json;

/// JSON knows no NaN and no infinity.
Json finite(double x) { return std::isfinite(x) ? Json(x) : Json(); }
Json number(f128 x) { return finite(static_cast<double>(x)); }
Json numbers(V3 v) { return {number(v.x), number(v.y), number(v.z)}; }
Json hexes(V3 v) { return {hex(v.x), hex(v.y), hex(v.z)}; }
Json numbers(const std::vector<f128>& v) {
  if (v.size() == 1) return number(v[0]);
  Json list = Json::array();
  for (const f128 x : v) list.push_back(number(x));
  return list;
}

Json asJson(const Verdict& v) {
  Json json{{"name", v.name}, {"index", v.index}, {"solid", v.index < 0 ? Json() : Json(v.solid)}};
  json["t"] = v.index < 0 ? Json() : number(v.t);
  json["t_decimal"] = v.index < 0 ? Json() : Json(decimal(v.t));
  json["radiance"] = {finite(v.radiance[0]), finite(v.radiance[1]), finite(v.radiance[2])};
  json["rgb_levels"] = v.levels;
  json["t_error_ulp"] = finite(v.ulps);
  json["right"] = v.right;
  json["fault"] = v.fault;
  return json;
}

Json asJson(const Stage& s) {
  return {{"name", s.name},
          {"shader", numbers(s.shader)},
          {"true", numbers(s.truth)},
          {"right_bits", s.digits},
          {"lost_here_bits", s.lost},
          {"relative_error_by_ray", finite(s.byRay)},
          {"relative_error_by_records", finite(s.byRecords)},
          {"relative_error_by_arithmetic", finite(s.byArithmetic)},
          {"most_by", s.source()}};
}

Json asJson(const Decision& d) {
  return {{"name", d.name},           {"shader", number(d.shader)}, {"true", number(d.truth)},
          {"bound", finite(d.bound)}, {"margin", finite(d.margin)}, {"wrong_sign", d.wrong()}};
}

Json asJson(const Candidate& c) {
  Json json{{"index", c.index},
            {"solid", c.name},
            {"kind", c.kind},
            {"form", c.trial.form},
            {"dropped", c.trial.dropped},
            {"hit", c.trial.hit},
            {"hit_true", c.truth.hit},
            {"t", c.trial.hit ? finite(static_cast<double>(c.trial.t)) : Json()},
            {"t_bound", c.trial.hit ? finite(c.trial.tBound) : Json()},
            {"t_true", c.truth.hit ? number(c.truth.t) : Json()},
            {"margin_true_in_2^-24", finite(c.truth.marginUlps)}};
  const Decision* decisive = c.trial.decisive();
  json["decisive"] = decisive == nullptr ? Json() : asJson(*decisive);
  json["decisions"] = Json::array();
  for (const Decision& d : c.trial.decisions) json["decisions"].push_back(asJson(d));
  if (!c.matters) return json;
  json["lost"] = c.lost;
  const Stage* worst = c.trial.worst();
  json["worst_stage"] = worst == nullptr ? Json() : Json(worst->name);
  json["stages"] = Json::array();
  for (const Stage& s : c.trial.stages) json["stages"].push_back(asJson(s));
  return json;
}

}  // namespace

std::string asJson(const Explanation& e) {
  Json json{{"scene", e.scene},          {"x_px", e.x},        {"y_px", e.y},        {"width_px", e.width},
            {"height_px", e.height},     {"camera", e.camera}, {"method", e.method}, {"arithmetic", e.arithmetic},
            {"conclusion", e.conclusion}};
  json["ray"] = {{"origin_hex", hexes(e.origin)},
                 {"direction_hex", hexes(e.direction)},
                 {"origin", numbers(e.origin)},
                 {"direction", numbers(e.direction)},
                 {"shader_origin_hex", hexes(e.seen.origin)},
                 {"shader_direction_hex", hexes(e.seen.direction)},
                 {"shader_axes", e.seen.cameraAxes ? "camera" : "world"},
                 {"shader_direction_relative_error", finite(e.seen.directionError)}};
  json["gpu"] = asJson(e.gpu);
  json["cpu"] = asJson(e.cpu);
  json["truth"] = asJson(e.truth);
  json["truth"]["decided_by"] = e.decidedBy;
  json["truth"]["margin_in_2^-24"] = finite(e.truthMargin);
  json["truth"]["tie"] = e.tie;
  json["truth"]["on_edge"] = e.onEdge;
  json["second_pass"] = e.secondPass;
  json["doubts"] = e.doubts;
  json["stages_follow_device"] = e.followed;
  json["candidates"] = Json::array();
  for (const Candidate& c : e.candidates) json["candidates"].push_back(asJson(c));
  json["candidates_left_out"] = e.further;
  json["solids_missed_by_far"] = e.clear;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace solidcast::explain
