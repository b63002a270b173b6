// Small scene files for tests, and what the loader says to them.
#pragma once
#include <string>
#include <vector>

#include "host/error.h"
#include "host/scene/load.h"

namespace solidcast {

inline const std::string kImage = R"("image": {"width": 64, "height": 48})";
inline const std::string kCamera =
    R"("camera": {"type": "perspective", "center": [0, 0, 10], "forward": [0, 0, -1], "up": [0, 1, 0],)"
    R"( "vertical_angle": 45, "horizontal_angle": 60})";

/// A whole scene around a list of solids.
inline std::string withSolids(const std::string& solids) {
  return "{" + kImage + ", " + kCamera + ", \"solids\": [" + solids + "]}";
}

/// A whole scene around one more member at the top.
inline std::string withMember(const std::string& member) {
  return "{" + kImage + ", " + kCamera + ", " + member + ", \"solids\": []}";
}

inline Scene parse(const std::string& text, std::vector<std::string>* warnings = nullptr) {
  std::vector<std::string> own;
  return parseScene(text, "s.json", warnings ? *warnings : own);
}

/// The loader's message, or "accepted". A message of another exit code than usage is marked.
inline std::string refusal(const std::string& text) {
  try {
    parse(text);
  } catch (const Error& error) {
    return (error.code() == Exit::usage ? "" : "wrong exit code: ") + std::string(error.what());
  }
  return "accepted";
}

inline std::string firstWarning(const std::string& solids) {
  std::vector<std::string> warnings;
  parse(withSolids(solids), &warnings);
  return warnings.empty() ? "no warning" : warnings[0];
}

}  // namespace solidcast
