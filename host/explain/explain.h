// Why a pixel is as it is: the GPU's decision, the CPU reference's and the truth side by side, every solid that had a say,
// and the stages of the method's formula with the digits that each of them lost. Enough to see who is wrong where the
// GPU and the reference differ.
//
// The GPU's decision comes from the device (a picture of this one pixel). What the shader went through on the way is
// calculated again on the host, operation by operation, in its number type and in binary128 (traced.h, trial.h); that both
// end at the same bits is checked and told (`followed`).
#pragma once
#include <array>
#include <string>
#include <vector>

#include "host/explain/trial.h"
#include "host/oracle/oracle.h"
#include "host/scene/world.h"
#include "reference_cpu/reference.h"

namespace solidcast::explain {

/// What one side says of the pixel.
struct Verdict {
  std::string name;         // "GPU llvmpipe (...), exact in fp64"; "CPU reference, f64"; "truth"
  std::int32_t index = -1;  // of the solid; -1: none
  std::string solid;        // its name; "nothing"
  f128 t = 0;               // where something is hit
  std::array<double, 3> radiance{};
  std::array<int, 3> levels{};  // of the 8-bit image
  double ulps = 0;              // of t, fp32, from the truth; where the solid is right
  bool right = true;            // the true solid (or none), t within 1 ulp
  std::string fault;            // in words ("misses ..."); "" where right
};

struct Candidate {
  std::int32_t index = -1;
  std::string name, kind;  // "sphere 2" or the scene's name; "sphere"
  Trial trial;             // by the method
  oracle::Truth truth;
  bool matters = false;  // the GPU's choice, the true one, or wrong where the GPU is: its stages are worth reading
  std::string lost;      // of one that matters: where its digits went, in one line
  bool wrong() const { return trial.hit != truth.hit; }
};

struct Explanation {
  std::string scene;
  int x = 0, y = 0, width = 0, height = 0;
  std::string camera, method, arithmetic;  // "perspective"; "exact"; "fp64"
  V3 origin, direction;                    // the ideal ray, direction of unit length
  ShaderRay seen;                          // the same as the shader has it

  Verdict gpu, cpu, truth;
  std::string decidedBy;   // of the truth: "extended precision", "binary128", "exact arithmetic"
  double truthMargin = 0;  // relative change of the inputs that might turn the truth, in units of 2^-24
  bool tie = false;        // another solid has exactly the true t
  /// Some decision is nearer to an edge than 2^-100. Rays of pixels have irrational directions, and there the second
  /// pass takes it for the edge itself (docs/numerics.md, gap 3).
  bool onEdge = false;

  bool secondPass = false;          // exact: the device gave the ray to the host
  std::vector<std::string> doubts;  // and why: one line a solid, or the order
  bool followed = false;            // the stages end at the device's own solid and bits of t

  std::vector<Candidate> candidates;  // by t; at most 20
  std::size_t further = 0;            // candidates that were left out
  std::size_t clear = 0;              // solids that are no candidates: missed by far

  std::string conclusion;  // who is wrong
};

inline constexpr std::size_t kMostCandidates = 20;

/// Throws Error(Exit::usage) for a pixel outside the job's picture.
void checkPixel(const RenderJob& job, int x, int y);

/// Explains the centre of pixel (x, y) of the job's picture of the scene: its size and two-sidedness count, not its crop,
/// samples and channels. Throws as checkPixel() and renderGpu() do.
Explanation explainPixel(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options,
                         reference::Precision precision, int x, int y);

/// For people, lines ending in '\n'; and for programs.
std::string asText(const Explanation& explanation);
std::string asJson(const Explanation& explanation);

}  // namespace solidcast::explain
