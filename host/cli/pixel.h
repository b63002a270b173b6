// --pixel X,Y of render and compare: an explanation of one pixel in the place of a picture (host/explain).
#pragma once
#include <optional>
#include <utility>

#include "host/cli/options.h"

namespace solidcast::cli {

using PixelOption = std::optional<std::pair<int, int>>;

void addPixel(CLI::App& verb, PixelOption& pixel);

/// Explains the pixel of `file`'s picture on standard output. `useless`: options of the verb that have no meaning beside
/// --pixel; they are refused.
void explain(const CLI::App& verb, const std::vector<const char*>& useless, const std::string& file,
             std::pair<int, int> pixel, const ImageOptions& image, const CastingOptions& casting, bool json);

}  // namespace solidcast::cli
