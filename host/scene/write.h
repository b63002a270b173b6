// Scenes back to files. What is written reads back as the same scene, bit for bit.
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "host/scene/world.h"

namespace solidcast {

/// Called with consecutive pieces of the file, so that a scene of millions of solids is never in memory as text.
using TextSink = std::function<void(std::string_view)>;

/// Writes JSON as in docs/scene-format.md, one solid a line. `comment` becomes the first lines, each after "// ".
void writeScene(const Scene& scene, std::string_view comment, const TextSink& sink);

/// The camera alone, as it stands in a scene file: {"type": "perspective", ...}.
std::string cameraText(const Camera& camera);

}  // namespace solidcast
