#include "host/bench/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

namespace solidcast::bench {
namespace {

std::string fixed(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}
/// Three digits that count.
std::string brief(double value) { return fixed(value, value >= 100 ? 0 : value >= 10 ? 1 : 2); }

double mrays(const SceneResults& scene, double ms) {
  return ms > 0 ? double(scene.width) * scene.height / ms / 1e3 : 0;
}

/// "13.2 (12.9)": of the best rounds, and of the medians.
std::string ratio(const Times& theirs, const Times& ours) {
  return brief(theirs.min() / ours.min()) + " (" + brief(theirs.median() / ours.median()) + ")";
}

double rounded(double ms) { return std::round(ms * 1e4) / 1e4; }

}  // namespace

std::string machineName() {
  std::ifstream info("/proc/cpuinfo");
  std::string line, name = "unknown CPU";
  while (std::getline(info, line))
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) {
      name = line.substr(line.find(": ") + 2);
      break;
    }
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  return name + ", " + std::to_string(cores) + (cores == 1 ? " core" : " cores");
}

std::string markdown(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size());
  for (const auto& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  std::string out;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t i = 0; i < rows[r].size(); ++i) {
      const std::string space(widths[i] - rows[r][i].size(), ' ');
      out.append(i == 0 ? "| " : " ").append(i == 0 ? rows[r][i] : space);
      out.append(i == 0 ? space : rows[r][i]).append(" |");
    }
    out += "\n";
    if (r > 0) continue;
    for (std::size_t i = 0; i < widths.size(); ++i)
      out.append(i == 0 ? "|" : "").append(widths[i] + 1, '-').append(i == 0 ? "-|" : ":|");
    out += "\n";
  }
  return out;
}

std::string headText(const gpu::DeviceInfo& device) {
  std::ostringstream line;
  line << "Machine: " << machineName() << ". Device: " << device.name << ". Driver: " << device.driver << " "
       << device.driverInfo << ", Vulkan " << device.apiVersion << ".\n";
  return line.str();
}

std::string text(const SceneResults& scene) {
  std::ostringstream head;
  head << "\n**" << scene.scene << "**: " << scene.solids << (scene.solids == 1 ? " solid, " : " solids, ")
       << scene.width << "x" << scene.height << ", " << scene.rounds
       << (scene.rounds == 1 ? " round\n\n" : " rounds\n\n");
  std::string out = head.str();
  std::vector<std::vector<std::string>> rows{{"method", "plan", "Mray/s: median (best)",
                                              "dispatch ms: min / median / max", "CPU ns/ray", "build ms",
                                              "image ms: min / median", "pixels off"}};
  for (const Result& r : scene.results)
    if (!r.wholeProcess)
      rows.push_back(
          {r.method, r.ours ? r.plan : "",
           brief(mrays(scene, r.dispatch.median())) + " (" + brief(mrays(scene, r.dispatch.min())) + ")",
           fixed(r.dispatch.min(), 2) + " / " + fixed(r.dispatch.median(), 2) + " / " + fixed(r.dispatch.max(), 2),
           fixed(r.dispatchCpu.min() * 1e6 / (double(scene.width) * scene.height), 2), fixed(r.build.median(), 2),
           fixed(r.image.min(), 2) + " / " + fixed(r.image.median(), 2), std::to_string(r.differing)});
  out += markdown(rows);

  rows = {{"faster than", "dispatch: best (median)", "its CPU time", "image: best (median)"}};
  for (const Result& ours : scene.results)
    for (const Result& theirs : scene.results)
      if (ours.ours && !theirs.ours && !theirs.wholeProcess)
        rows.push_back({ours.method + " : " + theirs.method, ratio(theirs.dispatch, ours.dispatch),
                        ratio(theirs.dispatchCpu, ours.dispatchCpu), ratio(theirs.image, ours.image)});
  if (rows.size() > 1) out.append("\n").append(markdown(rows));

  // The last of the programs is the one that the others are held against.
  rows = {{"whole process", "ms: min / median / max", "faster than the last: best (median)", "pixels off"}};
  const Result& last = scene.results.back();
  for (const Result& r : scene.results)
    if (r.wholeProcess)
      rows.push_back({r.method,
                      fixed(r.image.min(), 1) + " / " + fixed(r.image.median(), 1) + " / " + fixed(r.image.max(), 1),
                      ratio(last.image, r.image), std::to_string(r.differing)});
  if (rows.size() > 1) out.append("\n").append(markdown(rows));

  rows = {{"first image, ms", "whole", "flatten", "shader", "first dispatch", "all dispatches", "read back",
           "second pass"}};
  for (const Result& r : scene.results) {
    if (!r.ours) continue;
    std::vector<std::string> row{r.method, fixed(r.firstImage.median(), 2)};
    for (const auto& [name, ms] : r.phases) row.push_back(fixed(ms, 2));
    rows.push_back(row);
  }
  return out.append("\n").append(markdown(rows));
}

std::string json(const gpu::DeviceInfo& device, const std::vector<SceneResults>& scenes) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const SceneResults& scene : scenes)
    for (const Result& r : scene.results) {
      nlohmann::ordered_json row;
      row["scene"] = scene.scene;
      row["width"] = scene.width;
      row["height"] = scene.height;
      row["solids"] = scene.solids;
      row["method"] = r.method;
      row["plan"] = r.plan;
      row["machine"] = machineName();
      if (r.ours) {
        row["device"] = device.name;
        row["driver"] = device.driver + " " + device.driverInfo;
      }
      row["rounds"] = scene.rounds;
      const auto times = [&](const std::string& name, const Times& t) {
        row[name + "_ms_min"] = rounded(t.min());
        row[name + "_ms_median"] = rounded(t.median());
        row[name + "_ms_max"] = rounded(t.max());
      };
      times("dispatch", r.dispatch);
      row["mrays_per_s"] = rounded(mrays(scene, r.dispatch.median()));
      row["mrays_per_s_best"] = rounded(mrays(scene, r.dispatch.min()));
      times("dispatch_cpu", r.dispatchCpu);
      times("build", r.build);
      times("image", r.image);
      if (r.ours) {
        times("first_image", r.firstImage);
        for (const auto& [name, ms] : r.phases) row["first_image_phases"][name] = rounded(ms);
      }
      row["pixels_off"] = r.differing;
      list.push_back(row);
    }
  return list.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace solidcast::bench
