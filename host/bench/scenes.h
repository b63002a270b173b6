// Scenes by name: files, those carried in the program, and random ones that need no file.
#pragma once
#include <string>
#include <vector>

#include "host/scene/world.h"

namespace solidcast::bench {

/// Names of the scenes that the program carries: the bundled ones.
std::vector<std::string> carriedScenes();

/// `random:KIND:COUNT[:SEED]` (host/scene/random.h; seed 1), a file, or, where there is no such file, the name of a
/// carried scene. Scene::file is the name. Throws Error(Exit::usage).
Scene sceneNamed(const std::string& name, std::vector<std::string>& warnings);

}  // namespace solidcast::bench
