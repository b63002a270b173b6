// Channels of a Band as 8-bit colours that people can read; the table in writer.h says how.
#pragma once
#include <cstdint>
#include <vector>

#include "host/image/band.h"
#include "host/image/writer.h"

namespace solidcast {

/// 3 bytes a pixel. For ImageKind::radiance: Band::rgb8 itself.
std::vector<std::uint8_t> picture(const Band& band, ImageKind kind);

/// clamp to [0,1], truncate 255 v, as in Channels::rgb8; NaN gives 0.
std::uint8_t level(float value);

}  // namespace solidcast
