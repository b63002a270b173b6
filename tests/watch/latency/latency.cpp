// What `watch` takes from a save to the written image: a hundred saves at the course's scene in its full size, among them
// twenty broken ones and twenty of an included file. Prints one JSON object; ends with 1 when an image was wrong.
#include <algorithm>
#include <cstdio>

#include "tests/watch/saves.h"

namespace {

void print(const char* name, std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  const auto at = [&ms](double part) { return ms[static_cast<std::size_t>(part * double(ms.size() - 1))]; };
  std::printf("\"%s_min_ms\":%.1f,\"%s_median_ms\":%.1f,\"%s_p90_ms\":%.1f,\"%s_max_ms\":%.1f,", name, at(0), name,
              at(0.5), name, at(0.9), name, at(1));
}

}  // namespace

int main() {
  using namespace solidcast;
  gpu::Device device({.select = "llvmpipe"});
  watch_test::Saves saves(device, 640, 480);
  const watch_test::SaveReport report = saves.run(100);
  for (const std::string& failure : report.failures) std::fprintf(stderr, "%s\n", failure.c_str());
  if (report.scene_ms.empty() || report.shader_ms.empty()) return 1;
  std::vector<double> all = report.scene_ms;
  all.insert(all.end(), report.shader_ms.begin(), report.shader_ms.end());
  std::printf("{\"saves_good\":%d,\"saves_broken\":%d,\"images_wrong\":%zu,", report.good, report.broken,
              report.failures.size());
  print("all", all);
  print("scene", report.scene_ms);
  print("shader", report.shader_ms);
  std::printf("\"memory_early_kib\":%ld,\"memory_late_kib\":%ld}\n", report.kilobytesEarly, report.kilobytesLate);
  return report.failures.empty() ? 0 : 1;
}
