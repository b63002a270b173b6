// The primary rays of a picture as every peer gets them: directions are linear in two numbers a column, so that a ray
// costs a few operations and the sines of an environment camera are taken once a column and row.
#pragma once
#include <cstdint>
#include <vector>

#include "host/scene/world.h"

namespace solidcast::bench {

enum class CameraKind { perspective, orthographic, environment };

/// Ray of column i: origin + p_i across, direction a + p_i b + q_i c, to be made unit for a perspective camera.
struct RayRow {
  float origin[3], across[3], a[3], b[3], c[3];
};

/// What the kernels see: no class of the standard library, because they are compiled for other instruction sets.
struct RayView {
  const float *p, *q;  // `stride` numbers
  const RayRow* rows;
  CameraKind camera;
  int width, height, stride;  // stride: the width, rounded up to a whole number of packets
};

/// Widths are padded to this many pixels, rows to kPacketRows: packets need no care at the edges.
constexpr int kPacketWidth = 16, kPacketRows = 4;

class Rays {
 public:
  Rays(const Scene& scene, int width, int height);
  RayView view() const;
  /// Pixels of a buffer with room for whole packets.
  std::size_t pixels() const;

 private:
  CameraKind camera_;
  int width_, height_;
  std::vector<float> p_, q_;
  std::vector<RayRow> rows_;
};

/// How a hit becomes a colour: both integrators of the scene description.
struct Light {
  bool dist, twoSided;
  float nearColor[3], step[3];  // colour = near + part step, part = clamp((t - nearDist) scale, 0, 1)
  float nearDist, scale;
};
Light lightOf(const Scene& scene);

}  // namespace solidcast::bench
