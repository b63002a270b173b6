// Which shader a job needs, and nothing else: module, macros and specialisation constants, with the reasons in words.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "host/cast/caster.h"
#include "host/cast/records.h"
#include "host/gpu/device.h"
#include "host/gpu/shaders.h"

namespace solidcast {

enum class Job { pixels, rays, lists };

/// A variant of shaders/pixels.comp, rays.comp or lists.comp.
struct Program {
  Job job = Job::pixels;
  Method method = Method::exact;
  RealType real = RealType::f64;
  int camera = 0;        // index of the Camera variant as pixels.comp numbers it
  bool storage = false;  // records in storage buffers, searched in portions
  bool index = false;    // searched by an index (index.h); storage too
  bool address = false;  // records and view by their addresses, not from uniform buffers
  int turn = 0;          // so many of an invocation's rays at a time (1 or 4), the others in a loop; 0: all at once
  bool hits = false;     // normals, local coordinates and points from the shader
  bool eye() const { return job != Job::rays && method != Method::naive && camera != 2; }

  std::string moduleName() const;  // "pixels_exact64_perspective"
  gpu::Defines defines() const;
};

/// pixels.comp's numbers: perspective 0, environment 1, orthographic 2.
int cameraNumber(const Camera& camera);

/// Numbers of the specialisation constants that are not counts of solids (search.glsl, records.glsl, *.comp).
enum Constant : std::uint32_t {
  kindInWorld = 10,  // and the six after it: finish.glsl
  recordRaws = 20,
  worldRaws,
  viewRaws,
  boxFacePlane,
  integratorNumber,
  twoSided,
  samples,
  wanted,
  doubt,
  hitsInDoubt,
  someGraze,
  rays,
  someTie,
  portioned = 34,
  someFarSphere,
  greyLevels
};
std::uint32_t bits(float value);

/// Counts of solids and sizes of the uniform arrays. A storage program has a count of 1 for every kind that is there.
/// `search` is what the program's loops go over (eye records, or world itself).
gpu::Specialisation recordConstants(const Program& program, const Records& search, const Records& world);

/// The number type of `method` on this device, with a line that says why.
RealType chooseReal(const gpu::DeviceInfo& device, const CastOptions& options, Job job, int camera, std::string& why);

/// DOUBT of pixels.comp, the bound that exact's decisions in pictures are counted against: 32 u for prepared forms; for
/// forms made on the way, what s needs to 2^-27 (fp64) or decisions alone (fp32).
float doubtOf(const Program& program);

/// The program: carried in the binary (no files), or compiled now from options.shaderFolder.
gpu::CompiledModule programModule(const Program& program, const CastOptions& options);

/// The same for a module of shaders/custom.
gpu::CompiledModule stageModule(const std::string& name, int camera, const CastOptions& options);

/// Kinds of solids, buffers and outputs that this scene does without, for --stats.
std::vector<std::string> leftOutLines(const Program& program, const World& world, const Channels& channels);

/// What one dispatch searches: counts and first rows by kind. More than one portion only for storage programs.
struct SearchPortion {
  std::array<std::uint32_t, kindCount> count{}, firstRow{};
};
/// Portions of at most `limit` solids: llvmpipe stops a loop after 65535 rounds without a word.
std::vector<SearchPortion> portions(const Records& records, std::uint32_t limit = 32768);

/// Makes a buffer of at least 16 bytes and copies `bytes` into it.
gpu::Buffer filledBuffer(gpu::Device& device, std::span<const std::byte> bytes, gpu::BufferUse use);

}  // namespace solidcast
