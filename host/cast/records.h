// Flattening: World and camera to the rows that shaders/records.glsl reads.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "host/cast/solids/forms.h"
#include "host/scene/world.h"

namespace solidcast {

inline constexpr int kindCount = 7;

/// Names by number of shaders/solids.def.
const char* kindLabel(int kind);
int kindNumber(ShapeRef shape);
/// How many there are, by kind.
std::array<std::uint32_t, kindCount> solidsOfKinds(const World& world);

/// Rows of all kinds, one kind after the other.
struct Records {
  std::array<std::uint32_t, kindCount> count{}, firstRow{}, rowsPer{};
  std::vector<std::byte> bytes;
  std::size_t raws = 0;                              // vec4 or dvec4 that the rows take
  bool grazing = false;                              // GRAZING of hit.glsl
  bool farSphere = false;                            // FAR_SPHERES of sphere.glsl
  bool boxOnFace = false;                            // BOX_FACE of box.glsl
  bool ties = true;                                  // TIES of hit.glsl
  std::vector<std::array<std::uint32_t, 2>> places;  // kind and row by index of the solid;
                                                     // a kind of kindCount: dropped, no ray from this eye can hit it
  std::uint32_t solids() const;
};

/// Forms for one shared origin (perspective and environment cameras).
Records eyeRecords(const World& world, const EyeFrame& eye, RealType type);

/// The solids themselves, moved so that `origin` is 0.
Records worldRecords(const World& world, V3 origin, RealType type);

/// Camera axes and, for fp32 types, a unit of length near the scene's own.
EyeFrame eyeFrame(const Scene& scene, RealType type);

/// Rows of the camera and the integrator (pixels.comp: View), and the angles of an environment camera.
struct View {
  std::vector<std::byte> rows;
  std::size_t raws = 0;
  std::vector<std::byte> angles;
};
View viewRows(const Scene& scene, const EyeFrame& eye, int width, int height, int samples, RealType type);

/// From one sample to the next, across and down, on a grid of columns x rows: on the plane at distance 1 (perspective), in
/// the world (orthographic), or in radians (environment).
std::pair<f128, f128> pixelSteps(const Camera& camera, std::int64_t columns, std::int64_t rows);

/// The ideal ray of a sample, in binary128: unit direction. (column, row) count in the grid of samples.
class PixelRays {
 public:
  PixelRays(const Scene& scene, int width, int height, int samples);
  RayQ ray(std::int64_t column, std::int64_t row) const;

 private:
  EyeFrame axes_;
  int camera_;
  f128 stepX_, stepY_;
  std::int64_t columns_, rows_;
};

}  // namespace solidcast
