#include "host/cli/render_stats.h"

#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

namespace solidcast::cli {
namespace {

/// Largest resident size of this process so far.
std::uint64_t hostBytesPeak() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::uint64_t(usage.ru_maxrss) * 1024;
}

using Phases = std::vector<std::pair<const char*, double>>;

Phases phases(const RenderStats& s) {
  return {{"scene_ms", s.scene_ms},
          {"instance_ms", s.instance_ms},
          {"device_ms", s.device_ms},
          {"flatten_ms", s.cast.flatten_ms},
          {"shader_ms", s.cast.shader_ms},
          {"first_dispatch_ms", s.cast.first_dispatch_ms},
          {"dispatch_ms", s.cast.dispatch_ms},
          {"fallback_ms", s.cast.fallback_ms},
          {"readback_ms", s.cast.readback_ms},
          {"encode_ms", s.encode_ms},
          {"write_ms", s.write_ms},
          {"whole_ms", s.whole_ms}};
}

std::vector<std::pair<const char*, std::uint64_t>> counts(const RenderStats& s) {
  return {{"solids", s.solids},
          {"rays", s.cast.rays},
          {"fallback_rays", s.cast.fallbackRays},
          {"nan_colours", s.cast.nanColours},
          {"device_bytes", s.cast.deviceBytes},
          {"device_bytes_peak", s.deviceBytesPeak},
          {"host_bytes_peak", hostBytesPeak()},
          {"spirv_bytes", s.cast.spirvBytes},
          {"specialised_spirv_bytes", s.cast.specialisedSpirvBytes}};
}

void printLines(const char* title, const std::vector<std::string>& lines) {
  if (lines.empty()) return;
  std::fprintf(stderr, "%s:\n", title);
  for (const std::string& line : lines) std::fprintf(stderr, "  %s\n", line.c_str());
}

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

}  // namespace

void printTable(const RenderStats& s) {
  std::fprintf(stderr, "%-24s %s\n", "scene", s.scene.c_str());
  std::fprintf(stderr, "%-24s %s\n", "device", (s.deviceName + (s.driver.empty() ? "" : ", " + s.driver)).c_str());
  std::fprintf(stderr, "%-24s %dx%d\n", "pixels", s.width, s.height);
  if (!s.cast.modules.empty()) std::fprintf(stderr, "%-24s %s\n", "shader", joined(s.cast.modules).c_str());
  for (const auto& [name, ms] : phases(s)) std::fprintf(stderr, "%-24s %14.3f\n", name, ms);
  for (const auto& [name, count] : counts(s))
    std::fprintf(stderr, "%-24s %14llu\n", name, static_cast<unsigned long long>(count));
  printLines("plan", s.cast.plan);
  printLines("left out", s.cast.leftOut);
}

void printJson(const RenderStats& s) {
  nlohmann::ordered_json json;
  json["scene"] = s.scene;
  json["outputs"] = s.outputs;
  json["device"] = s.deviceName;
  json["driver"] = s.driver;
  json["width"] = s.width;
  json["height"] = s.height;
  json["module"] = joined(s.cast.modules);
  json["frames"] = s.frames;
  if (s.frames_ms > 0) json["frames_per_second"] = std::round(s.frames * 1e7 / s.frames_ms) / 1e4;
  json["plan_name"] = s.cast.planName;
  for (const auto& [name, ms] : phases(s)) json[name] = std::round(ms * 1e4) / 1e4;
  for (const auto& [name, count] : counts(s)) json[name] = count;
  json["plan"] = s.cast.plan;
  json["left_out"] = s.cast.leftOut;
  std::cout << json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << '\n';
}

}  // namespace solidcast::cli
