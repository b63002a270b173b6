// Options that several verbs share, so that they are spelled, checked and explained the same everywhere.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/cast/caster.h"
#include "host/gpu/device.h"
#include "host/image/band.h"
#include "host/scene/world.h"
#include "reference_cpu/reference.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace solidcast::cli {

enum class Backend { gpu, cpu };

/// What a picture of a scene can be asked for; every default leaves the scene as its file says.
struct ImageOptions {
  std::string integrator;     // "casting", "castingdist", "custom", a file *.glsl; "" = the scene's
  int width = 0, height = 0;  // 0 = the scene's
  int samples = 1;            // a samples x samples grid in the pixel
  bool twoSided = false;      // on where the scene or the option says so
  Crop crop;
};

/// How rays are cast: on which device and by which method, or in which number type by the CPU reference.
struct CastingOptions {
  std::string device;  // as gpu::Device::Options::select
  gpu::Validation validation = gpu::Validation::automatic;
  CastOptions cast;
  bool showPlan = false;  // --plan without a name
  reference::Precision precision = reference::Precision::f64;
};

/// --integrator, --size, --samples, --two-sided, --crop.
void addImageOptions(CLI::App& verb, ImageOptions& options);

/// --device, --validation, --method, --arithmetic, --shaders (all for the GPU), --precision (CPU reference).
void addCastingOptions(CLI::App& verb, CastingOptions& options);

/// --plan [NAME], for verbs that cast on the GPU.
void addPlan(CLI::App& verb, CastingOptions& options);

/// The decision with its reasons on standard error, where it was asked for.
void printPlan(const CastingOptions& options, const CastStats& stats);

/// The port of `watch --serve` alone.
inline constexpr const char* kUsualPort = "8088";

/// "--plan" and "--serve" may stand alone, with a plan's name or a port behind them, or as --plan=NAME: the first two become
/// the third, so that a scene's file is not taken for one.
std::vector<std::string> withLeftOutValues(std::vector<std::string> words);

/// --backend gpu|cpu.
void addBackend(CLI::App& verb, Backend& backend);

/// Refuses options that have no meaning for the chosen backend (a --precision that the GPU would not keep, ...).
/// Throws Error(Exit::usage). For verbs that have --backend.
void checkBackend(const CLI::App& verb, Backend backend);

/// loadScene() with its warnings printed on standard error, one line each.
Scene loadWithWarnings(const std::string& file);

/// The scene with integrator and size replaced as asked; opening angles stay.
void apply(const ImageOptions& options, Scene& scene);

/// For comparing with the reference, which runs no GLSL: a user's own integrator gives way to casting, with a note; custom
/// solids are refused. Throws Error(Exit::usage).
void keepToTheReference(Scene& scene);

/// The job for `scene`, after apply(). Throws Error(Exit::usage) for a crop outside the image.
RenderJob makeJob(const ImageOptions& options, const Scene& scene, const Channels& channels);

/// Opens the Vulkan device and names it in one line on standard error.
std::unique_ptr<gpu::Device> openDevice(const CastingOptions& options);

/// "CPU reference, f64, 2 threads": what is used when there is no device.
std::string cpuName(reference::Precision precision);

/// "f32", "f64", "f128".
const char* precisionName(reference::Precision precision);

/// One line "solidcast: ..." on standard error, written in one piece.
void note(const std::string& line);

/// WIDTHxHEIGHT, each from 1 to 100000. Throws Error(Exit::usage) that names `option`.
std::pair<int, int> parseSize(const std::string& option, const std::string& text);

/// X,Y,WIDTH,HEIGHT. Throws Error(Exit::usage) that names `option`.
Crop parseCrop(const std::string& option, const std::string& text);

/// X,Y from 0 up. Throws Error(Exit::usage) that names `option`.
std::pair<int, int> parsePixel(const std::string& option, const std::string& text);

}  // namespace solidcast::cli
