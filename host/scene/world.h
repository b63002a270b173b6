// The plain scene description: the only thing that the GPU side and reference_cpu have in common.
// Every number is fp64 exactly as it was parsed; that is the truth against which errors are counted.
// No mathematics, no GLM, no Vulkan in this file.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "host/scene/solids.h"

namespace solidcast {

// --- users' own GLSL ------------------------------------------------------------------------------
/// A number or three numbers that a scene gives to users' own GLSL.
struct GlslParameter {
  std::string name;  // as GLSL takes it
  std::variant<double, Triple> value;
  bool operator==(const GlslParameter&) const = default;
};
/// A user's GLSL file (docs/custom-glsl.md).
struct CustomCode {
  std::string file;                       // from the scene file's folder
  std::vector<GlslParameter> parameters;  // by name
  bool operator==(const CustomCode&) const = default;
};
/// A solid in a user's own GLSL. No Shape: nothing here knows what it is, neither the proofs nor the reference.
struct CustomSolid {
  std::string name;  // unique in the scene; may be empty
  CustomCode code;
  std::optional<std::array<Triple, 2>> bounds;  // least and greatest corner; only what lies inside is seen
  bool operator==(const CustomSolid&) const = default;
};

// --- groups ---------------------------------------------------------------------------------------
struct GroupMember {
  bool isGroup = false;
  std::uint32_t index = 0;  // into World::groups or World::solids
  bool operator==(const GroupMember&) const = default;
};

struct GroupEntry {
  std::string name;                  // unique in the scene; may be empty
  std::uint32_t parent = 0;          // index into World::groups; the root is its own parent
  std::vector<GroupMember> members;  // in the order of the scene file
  bool operator==(const GroupEntry&) const = default;
};

/// A tree of groups, stored flat so that depth costs no recursion.
/// `solids` are in depth-first order: a solid's place there is its `index` everywhere (query, AOV, ties).
struct World {
  Solids solids;
  std::vector<GroupEntry> groups{GroupEntry{}};  // groups[0] is the root
  std::vector<CustomSolid> customSolids;         // in no group; their indices go on after those of `solids`
  bool operator==(const World&) const = default;
};

// --- cameras --------------------------------------------------------------------------------------
// right = normalize(forward x up), upward = right x forward. Pixel (i, j), j down:
// x = 2(i+0.5)/W - 1, y = 1 - 2(j+0.5)/H.
/// Direction normalize(forward + x tan(h/2) right + y tan(v/2) upward); angles in degrees, in (0, 180).
struct PerspectiveCamera {
  Triple center, forward, up;
  double verticalAngle, horizontalAngle;
  bool operator==(const PerspectiveCamera&) const = default;
};
/// Origin center + x scaleX/2 right + y scaleY/2 upward, direction forward (normalised); scales are full extents.
struct OrthographicCamera {
  Triple center, forward, up;
  double scaleX, scaleY;
  bool operator==(const OrthographicCamera&) const = default;
};
/// theta = x h/2, phi = y v/2; direction cos(phi) (cos(theta) forward + sin(theta) right) + sin(phi) upward.
/// Angles in degrees: horizontal in (0, 360], vertical in (0, 180].
struct EnvironmentCamera {
  Triple center, forward, up;
  double verticalAngle, horizontalAngle;
  bool operator==(const EnvironmentCamera&) const = default;
};

using Camera = std::variant<PerspectiveCamera, OrthographicCamera, EnvironmentCamera>;

// --- integrators ----------------------------------------------------------------------------------
/// Radiance max(0, -d.n), grey; |d.n| when two-sided.
struct RayCastingIntegrator {
  bool operator==(const RayCastingIntegrator&) const = default;
};
/// The same cosine times a colour: nearColor + clamp((t-nearDist)/(farDist-nearDist), 0, 1) (farColor-nearColor).
/// nearDist may lie beyond farDist; they must differ.
struct RayCastingDistIntegrator {
  Triple nearColor{1, 1, 1};
  double nearDist = 0;
  Triple farColor{0, 0, 0};
  double farDist = 1;
  bool operator==(const RayCastingDistIntegrator&) const = default;
};

/// A user's own: see CustomCode.
struct CustomIntegrator {
  CustomCode code;
  bool operator==(const CustomIntegrator&) const = default;
};

using Integrator = std::variant<RayCastingIntegrator, RayCastingDistIntegrator, CustomIntegrator>;

struct Scene {
  std::string file;  // where it came from, for messages
  int width = 640, height = 480;
  Camera camera = PerspectiveCamera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 45, 60};
  Integrator integrator = RayCastingIntegrator{};
  /// What `--integrator castingdist` takes, whichever integrator the scene chooses; nothing: the scene has no such numbers.
  std::optional<RayCastingDistIntegrator> distParameters;
  std::optional<CustomIntegrator> customIntegrator;  // the same for `--integrator custom`, with parameters for any file
  bool twoSided = false;                             // |d.n| instead of max(0, -d.n)
  World world;
  bool operator==(const Scene&) const = default;
};

}  // namespace solidcast
