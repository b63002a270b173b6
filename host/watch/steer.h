// Moving a camera by hand: around what it looks at, sideways, nearer.
#pragma once
#include "host/scene/world.h"

namespace solidcast::watch {

/// Turned about `pivot`: by `right` degrees about the scene's upward direction, then by `up` degrees towards it, at most to
/// within a degree of it. Environment cameras see all around, so for them `pivot` should be their own centre.
Camera orbited(const Camera& camera, const Triple& pivot, double right, double up);

/// Moved sideways by parts of what the image shows at the distance of `pivot`: (1, 0) moves the picture by its width.
Camera panned(const Camera& camera, const Triple& pivot, double right, double up);

/// `factor` below 1 brings `pivot` nearer by that factor; orthographic cameras show a smaller part instead, environment
/// cameras stay.
Camera zoomed(const Camera& camera, const Triple& pivot, double factor);

}  // namespace solidcast::watch
