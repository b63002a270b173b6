// What `bench` prints: a report in Markdown to paste elsewhere, or the same as JSON.
#pragma once
#include <string>
#include <vector>

#include "host/bench/race.h"
#include "host/gpu/device.h"

namespace solidcast::bench {

struct SceneResults {
  std::string scene;
  int width = 0, height = 0, rounds = 0;
  std::size_t solids = 0;
  std::vector<Result> results;
};

/// "AMD EPYC, 2 cores".
std::string machineName();

/// Head: machine, device, driver.
std::string headText(const gpu::DeviceInfo& device);
/// One scene: times, ratios to the peers, phases.
std::string text(const SceneResults& scene);

/// An array, one object a scene and method.
std::string json(const gpu::DeviceInfo& device, const std::vector<SceneResults>& scenes);

/// Rows of cells as a Markdown table, columns aligned; the first row is the head.
std::string markdown(const std::vector<std::vector<std::string>>& rows);

}  // namespace solidcast::bench
