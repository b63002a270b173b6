// Whole programs as contestants: what a user waits for, from starting the program to the PNG file.
#pragma once
#include <memory>
#include <string>

#include "host/bench/peer.h"

namespace solidcast::bench {

/// This program's own `render`, with these further arguments. Scene and image lie in a temporary folder.
std::unique_ptr<Peer> renderProcess(const Scene& scene, int width, int height, const std::string& method);

/// POV-Ray 3.7 with an equivalent scene, no anti-aliasing, on all cores: grey cosines by a light in the camera, or with +Q1
/// (no light) where the integrator is another. Throws Error(Exit::usage) where it is not installed.
std::unique_ptr<Peer> povrayProcess(const Scene& scene, int width, int height);

/// The scene in POV-Ray's language.
std::string povrayScene(const Scene& scene);

}  // namespace solidcast::bench
