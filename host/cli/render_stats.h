// What `render --stats` tells, for people and as JSON.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "host/cast/caster.h"

namespace solidcast::cli {

/// Times in ms, sizes in bytes. Phases that a backend does not have are 0; the CPU reference's casting stands as
/// `dispatch_ms`.
struct RenderStats {
  std::string scene, deviceName, driver;
  std::vector<std::string> outputs;
  int width = 0, height = 0;  // of what was rendered
  int frames = 1;
  std::size_t solids = 0;
  double scene_ms = 0, instance_ms = 0, device_ms = 0, encode_ms = 0, write_ms = 0, whole_ms = 0;
  double frames_ms = 0;  // all frames, from the first cast to the last write
  std::uint64_t deviceBytesPeak = 0;
  CastStats cast;
};

/// A table on standard error.
void printTable(const RenderStats& stats);

/// One JSON object on standard output.
void printJson(const RenderStats& stats);

}  // namespace solidcast::cli
