// Cameras of a sequence of pictures: a turntable, or a way through key cameras that somebody wrote down.
#pragma once
#include <string>
#include <vector>

#include "host/scene/world.h"

namespace solidcast {

/// Key cameras, all of one kind.
using CameraPath = std::vector<Camera>;

/// A JSON list of camera objects as in scene files (docs/scene-format.md). Throws Error(Exit::usage) with file and place.
CameraPath loadCameraPath(const std::string& file, std::vector<std::string>& warnings);

/// The camera at `position` in [0, 1], keys evenly spread: numbers between two keys are mixed linearly, forward and up as unit
/// vectors. Throws Error(Exit::usage) where the mixture has no direction (keys that look opposite ways).
Camera cameraAt(const CameraPath& path, double position);

/// The point on the camera's line of sight nearest to the middle of the scene's solids, planes and quadrics aside;
/// one unit ahead where there is none or it lies behind.
Triple pointLookedAt(const Scene& scene);

/// Turned about the axis through `pivot` along the camera's own upward direction; angle in degrees, anticlockwise seen
/// from above.
Camera orbited(const Camera& camera, const Triple& pivot, double angle);

}  // namespace solidcast
