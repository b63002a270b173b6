// Rows of an image on their way from a renderer (GPU or CPU reference) to a file: images larger than memory
// are made and written band by band, top row first.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

namespace solidcast {

/// What a render job is asked for, apart from the scene. A channel that is not asked for costs nothing.
struct Channels {
  bool rgb8 = false;      // 8-bit radiance: clamp to [0,1], truncate 255 v, no gamma
  bool radiance = false;  // float radiance
  bool distance = false;  // t; +inf for a miss
  bool solid = false;     // index of the solid; -1 for a miss
  bool normal = false;    // unit geometric normal; 0 for a miss
  bool local = false;     // local coordinates; 0 for a miss
  bool position = false;  // hit point in the world; 0 for a miss
  bool operator==(const Channels&) const = default;
};

struct Crop {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const Crop&) const = default;
};  // width 0: the whole image

struct RenderJob {
  int width = 0, height = 0;  // of the whole image
  Crop crop;                  // part that is rendered; its pixels are the very pixels of the whole image
  int samples = 1;            // radiance is the mean over a regular samples x samples grid in the pixel;
                              // all other channels are of the pixel's centre
  bool twoSided = false;
  Channels channels;
  bool operator==(const RenderJob&) const = default;
};

/// `rows` rows of the crop, `width` pixels each. A vector is empty unless its channel was asked for.
struct Band {
  int firstRow = 0, rows = 0, width = 0;       // firstRow counts from the top of the crop
  std::vector<std::uint8_t> rgb8;              // 3 a pixel
  std::vector<float> radiance;                 // 3 a pixel
  std::vector<float> distance;                 // 1 a pixel
  std::vector<std::int32_t> solid;             // 1 a pixel
  std::vector<float> normal, local, position;  // 3 a pixel
};

/// Called with consecutive bands from the top down. The band may be moved from.
using BandSink = std::function<void(Band&)>;

}  // namespace solidcast
