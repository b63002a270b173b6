// Pictures for the page, as PNG files in memory.
#pragma once
#include "host/study/bench.h"

namespace solidcast::study {

/// Bytes of a PNG of `rgb` (3 a pixel).
std::string pngOf(int width, int height, std::vector<std::uint8_t> rgb);

/// Where a way errs: grey where nothing is hit, white within 1 ulp, darker to violet by the error's size up to 1e6 ulp,
/// red where the decision is wrong or t is no number.
ScenePicture errorPicture(const Scene& scene, const std::vector<Verdict>& truth, const Pixels& answers,
                          std::size_t way);
/// The colour for an error, as "#rrggbb", for the legend.
std::string errorColour(double ulps);

}  // namespace solidcast::study
