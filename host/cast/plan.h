// The cost model: how a scene and a job are best cast. Every plan gives the same picture (exact: the same bytes); they differ
// in what they prepare and in what a ray costs. docs/performance-notes.md has the measurements behind the numbers.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host/cast/program.h"

namespace solidcast {

/// What a decision hangs on.
struct PlanFacts {
  Program program;  // job, method, number type, camera, hits
  std::array<std::uint32_t, kindCount> count{};
  double pixels = 0;    // of one picture, with all samples; free rays: of one block
  int pictures = 1;     // that the caster is made for
  bool moving = false;  // the camera or the scene changes from picture to picture
  bool llvmpipe = false;
  bool addresses = false;                          // shaders can read buffers by their addresses, and that pays
  std::size_t uniformRange = 0, storageRange = 0;  // bytes that one buffer may have
};

/// What one plan is expected to take, in ms: before the first ray, and for all rays.
struct PlanCost {
  Plan plan;
  double prepare_ms = 0, rays_ms = 0;
  std::string impossible{};  // why, where it is
};

struct PlanChoice {
  Plan plan;
  bool wide = false;       // so many rays that more of them in one invocation, slower to compile, pay (baked, uniform)
  bool address = false;    // `uniform`: records by their addresses
  int turn = 0;            // the same: Program::turn
  bool bakeLater = false;  // change over to `baked` once dispatches have taken bakingMs
  double bakingMs = 0;
  std::vector<PlanCost> costs;  // of all plans, the chosen one first
};

/// Scenes of more solids take too long to compile with loops unrolled or with more rays an invocation.
constexpr std::uint32_t mostWide = 16;

/// What compiling a pipeline with the records as constants costs, in ms, at most about (docs/performance-notes.md).
double bakingMs(RealType real, std::uint32_t solids);

PlanFacts planFacts(const gpu::DeviceInfo& device, const World& world, const Program& program, double pixels,
                    const CastOptions& options);

/// The cheapest plan that is possible, or the one that was asked for. Throws Exit::usage where that is impossible.
PlanChoice choosePlan(const PlanFacts& facts, Plan asked);

/// Lines for --plan: the choice with its reason, and what each other plan was expected to take.
std::vector<std::string> planLines(const PlanFacts& facts, const PlanChoice& choice, Plan asked);

/// "auto", "baked", ...; as --plan spells them.
const char* planName(Plan plan);
Plan planByName(const std::string& name);  // throws Exit::usage
std::vector<std::string> planNames();

}  // namespace solidcast
