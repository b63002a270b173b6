// study.csv and study.json: the same table twice.
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <variant>

#include "host/study/study.h"

namespace solidcast::study {
namespace {

using Json = nlohmann::ordered_json;
using Cell = std::variant<std::string, double, std::uint64_t>;

std::vector<std::pair<const char*, Cell>> cells(const Row& row) {
  const Errors& e = row.errors;
  const Timing& t = row.timing;
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto timed = [&](double value) { return t.runs > 0 ? value : none; };
  return {{"section", std::string(nameOf(row.section))},
          {"kind", row.kind},
          {"family", row.family},
          {"difficulty", row.difficulty.value_or(none)},
          {"method", std::string(kWays[row.way].id)},
          {"rays", e.rays},
          {"agreed_hits", e.agreedHits},
          {"t_ulp_p50", e.p50},
          {"t_ulp_p99", e.p99},
          {"t_ulp_p99_9", e.p999},
          {"t_ulp_max", e.max},
          {"misses", e.misses},
          {"false_hits", e.falseHits},
          {"other_solid", e.otherSolid},
          {"not_finite", e.notFinite},
          {"wrong_near_edge", e.wrongNear},
          {"wrong_beyond_edge", e.wrongBeyond},
          {"wrong_margin_max_ulp", e.worstMargin},
          {"ns_median", timed(t.median)},
          {"ns_p25", timed(t.quarter)},
          {"ns_p75", timed(t.threeQuarters)},
          {"ns_min", timed(t.least)},
          {"runs", static_cast<std::uint64_t>(t.runs)},
          {"rays_per_run", t.raysPerRun},
          {"host_ns", timed(t.host)},
          {"second_pass_rays", t.doubtful}};
}

std::string text(const Cell& cell) {
  if (const auto* s = std::get_if<std::string>(&cell)) {
    if (s->find_first_of(",\"\n") == std::string::npos) return *s;
    std::string quoted = "\"";
    for (const char c : *s) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
  }
  if (const auto* n = std::get_if<std::uint64_t>(&cell)) return std::to_string(*n);
  const double v = std::get<double>(cell);
  if (std::isnan(v)) return "";
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, v).ptr;
  return {buffer, end};
}

Json json(const Cell& cell) {
  if (const auto* s = std::get_if<std::string>(&cell)) return *s;
  if (const auto* n = std::get_if<std::uint64_t>(&cell)) return *n;
  const double v = std::get<double>(cell);
  return std::isnan(v) ? Json(nullptr) : std::isinf(v) ? Json("inf") : Json(v);
}

}  // namespace

std::string toCsv(const Study& study) {
  std::string all;
  const auto endLine = [&] { all.back() = '\n'; };  // instead of the last comma
  for (const auto& [name, cell] : cells(Row{})) (all += name) += ',';
  endLine();
  for (const Row& row : study.rows) {
    for (const auto& [name, cell] : cells(row)) (all += text(cell)) += ',';
    endLine();
  }
  return all;
}

std::string toJson(const Study& study) {
  Json j;
  j["solidcast"] = study.version;
  j["command"] = study.command;
  j["device"] = {{"name", study.device.name},
                 {"type", study.device.type},
                 {"driver", study.device.driver},
                 {"driver_info", study.device.driverInfo},
                 {"api_version", study.device.apiVersion},
                 {"float64", study.device.float64}};
  j["arithmetic"] = {study.arithmetic32, study.arithmetic64};
  j["rays_per_family"] = study.request.rays;
  j["seed"] = study.request.seed;
  j["near_edge_ulp"] = kNearUlps;
  j["seconds"] = study.seconds;
  j["complete"] = study.complete;
  j["methods"] = Json::array();
  for (const std::size_t way : study.ways) j["methods"].push_back(kWays[way].id);
  j["sweeps"] = Json::array();
  for (const Sweep& s : study.sweeps)
    j["sweeps"].push_back({{"id", s.id}, {"kind", s.kind}, {"title", s.title}, {"difficulty", s.axis}});
  j["cases"] = Json::array();
  for (const CaseNote& c : study.cases) {
    Json allowed;
    for (const std::size_t way : study.ways) allowed[kWays[way].id] = c.allowed[way];
    j["cases"].push_back({{"id", c.id}, {"kind", c.kind}, {"note", c.note}, {"truth", c.truth}, {"allowed", allowed}});
  }
  j["omissions"] = study.omissions;
  j["rows"] = Json::array();
  for (const Row& row : study.rows) {
    Json one;
    for (const auto& [name, cell] : cells(row)) one[name] = json(cell);
    j["rows"].push_back(std::move(one));
  }
  return j.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace solidcast::study
