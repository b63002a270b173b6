// Several pictures in one run: `--frames N`, along `--path FILE` or once around the scene.
#pragma once
#include <string>
#include <vector>

#include "host/scene/world.h"

namespace CLI {
class App;
}

namespace solidcast::cli {

struct Sequence {
  int frames = 1;
  std::string path;  // file of key cameras; "" = a turntable
};

/// --frames, --path.
void addSequence(CLI::App& verb, Sequence& sequence);

/// The camera of each frame: the scene's own; along the path, from its first key to its last; or around the point that
/// the scene's camera looks at, a whole turn being `frames` steps. Throws Error(Exit::usage), also for several frames
/// that would go to one `output`.
std::vector<Camera> camerasOf(const Sequence& sequence, const Scene& scene, const std::string& output);

/// "a.png" -> "a.07.png" for frame 6 of up to 99; the file itself where there is one frame.
std::string frameFile(const std::string& file, const Sequence& sequence, int frame);

/// "36 frames in 512 ms: 70.3 frames per second".
std::string frameRate(int frames, double ms);

}  // namespace solidcast::cli
