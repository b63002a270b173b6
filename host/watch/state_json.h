// What viewers get to read, as JSON.
#pragma once
#include <optional>
#include <string>

#include "host/watch/board.h"

namespace solidcast::watch {

std::string stateJson(const News& news);

/// The camera of a frame as it stands in a scene file.
std::string cameraJson(const Frame& frame);

/// Why this pixel of the frame is as it is.
std::string pixelJson(Session& session, const Frame& frame, int x, int y);

const char* methodName(Method method);
std::optional<Method> methodByName(const std::string& name);

}  // namespace solidcast::watch
