#include "host/cast/custom_stage.h"

#include <algorithm>

#include "host/carried/carried.h"
#include "host/cast/pass.h"
#include "host/cast/planes.h"
#include "host/cast/stopwatch.h"
#include "host/error.h"

namespace solidcast {
namespace {

// shaders/custom/hits.glsl: Portion
struct CustomPush {
  std::uint32_t wholeWidth, wholeHeight, firstX, firstY, width, height, rows, stride, sampleX, sampleY, solid, flags,
      program;
  float low[3], high[3];
};
static_assert(sizeof(CustomPush) <= 128);
enum Flag : std::uint32_t { twoSidedFlag = 1, eightBitsFlag = 2, boundedFlag = 4 };
enum Plane : std::size_t { distancePlane, solidPlane, normalPlane, localPlane = 5, positionPlane = 8 };
constexpr std::uint32_t invocations = 64;
constexpr std::uint32_t nothing = 0xffffffffu;
constexpr std::uint32_t programShift = 22;  // user.glsl: endlessLoop
constexpr std::size_t mostPrograms = 1 << 10;

gpu::Buffer valuesBuffer(gpu::Device& device, const CustomCode& code) {
  return filledBuffer(device, std::as_bytes(std::span<const float>(customValues(code))), gpu::BufferUse::uniform);
}

}  // namespace

CustomStage::CustomStage(const Job& job, const Scene& scene) : job_(job), buffers_(10) {
  buffers_[9] = job.device.makeBuffer(16, gpu::BufferUse::readback);
  setScene(scene);
  job_.stats.plan.push_back("users' own GLSL after the search: surfaces in fp32 from the distances that were found");
  if (!solids_.empty())
    job_.stats.plan.push_back(std::to_string(solids_.size()) +
                              " custom solid(s), each as exact as its code: no second pass for them");
}

void CustomStage::setScene(const Scene& scene) {
  scene_ = &scene;
  Stopwatch flattening;
  gpu::Device& device = job_.device;
  const int camera = cameraNumber(scene.camera);
  const EyeFrame eye = eyeFrame(scene, RealType::f32);
  const Records world = worldRecords(scene.world, eye.origin, RealType::f32);
  const View view = viewRows(scene, eye, job_.job.width, job_.job.height, job_.samples, RealType::f32);
  job_.stats.flatten_ms += flattening.ms();

  Stopwatch making;
  buffers_[1] = filledBuffer(device, world.bytes, gpu::BufferUse::storage);
  buffers_[2] = filledBuffer(device, view.rows, gpu::BufferUse::uniform);
  buffers_[5] = filledBuffer(device, view.angles, gpu::BufferUse::storage);
  buffers_[7] = filledBuffer(device, std::as_bytes(std::span(world.places)), gpu::BufferUse::storage);

  Program program;
  program.storage = true;
  gpu::Specialisation constants = recordConstants(program, world, world);
  constants[viewRaws] = static_cast<std::uint32_t>(view.raws);
  constants[samples] = u(job_.samples);
  constants[twoSided] = job_.job.twoSided;
  static const char* const modules[] = {"surfaces_perspective", "surfaces_environment", "surfaces_orthographic"};
  const auto make = [&](std::optional<gpu::Pipeline>& pipeline, gpu::Specialisation& known, const std::string& module) {
    if (pipeline && constants == known) return;
    known = constants;
    const gpu::CompiledModule compiled = stageModule(module, camera, job_.options);
    addFiles(compiled.files);
    pipeline.emplace(device.makePipeline(compiled.spirv, constants, module));
    ++job_.stats.pipelines;
  };
  make(surfaces_, surfacesConstants_, modules[camera]);

  const std::vector<std::shared_ptr<Code>> old = std::exchange(codes_, {});
  solids_.clear();
  for (const CustomSolid& solid : scene.world.customSolids)
    solids_.push_back({codeFor(CustomKind::solid, solid.code, old), valuesBuffer(device, solid.code), &solid});
  radiance_.reset();
  if (const auto* own = std::get_if<CustomIntegrator>(&scene.integrator); own && job_.radiance) {
    radiance_ = codeFor(CustomKind::integrator, own->code, old);
    radianceValues_ = valuesBuffer(device, own->code);
  } else if (job_.radiance) {
    constants[integratorNumber] = static_cast<std::uint32_t>(scene.integrator.index());
    make(shade_, shadeConstants_, "shade");
  }
  job_.stats.shader_ms += making.ms();
}

void CustomStage::addFiles(const std::vector<std::filesystem::path>& files) {
  job_.stats.files.insert(job_.stats.files.end(), files.begin(), files.end());
}

/// The compiled file, be it of the scene before or of another solid of this one.
std::shared_ptr<CustomStage::Code> CustomStage::codeFor(CustomKind kind, const CustomCode& code,
                                                        const std::vector<std::shared_ptr<Code>>& old) {
  for (const auto* list : {&std::as_const(codes_), &old})
    for (const auto& known : *list)
      if (known->module.serves(kind, *scene_, code)) {
        if (list == &old) codes_.push_back(known);
        return known;
      }
  if (codes_.size() == mostPrograms)
    throw Error(Exit::usage,
                code.file + ": one file of custom GLSL too many, expected at most " + std::to_string(mostPrograms));
  CustomModule module(kind, *scene_, code, job_.options);
  addFiles(module.files());
  gpu::Pipeline pipeline = job_.device.makePipeline(module.spirv(), {}, module.files().front().string());
  ++job_.stats.pipelines;
  codes_.push_back(std::make_shared<Code>(Code{std::move(module), std::move(pipeline)}));
  return codes_.back();
}

void CustomStage::makeBuffers(std::size_t pixels) {
  buffers_[8] = job_.device.makeBuffer(std::max<std::size_t>(16, pixels * colourWords() * 4), gpu::BufferUse::readback);
}

double CustomStage::dispatch(const gpu::Buffer& hits, int stride, int rows, const Band& band, int sample) {
  auto report = buffers_[9].as<std::uint32_t>();
  report[0] = 0;
  report[1] = nothing;
  CustomPush common{};
  common.wholeWidth = u(job_.job.width), common.wholeHeight = u(job_.job.height);
  common.firstX = u(job_.crop.x), common.firstY = u(job_.crop.y + band.firstRow);
  common.width = u(band.width), common.height = u(band.rows);
  common.rows = u(rows), common.stride = u(stride);
  common.sampleX = u(sample % job_.samples), common.sampleY = u(sample / job_.samples);
  common.flags = (job_.job.twoSided ? twoSidedFlag : 0u) | (job_.eightBits ? eightBitsFlag : 0u);

  std::vector<const gpu::Buffer*> bound;
  for (const gpu::Buffer& b : buffers_) bound.push_back(b.bytes().empty() ? nullptr : &b);
  bound[3] = &hits;
  std::vector<CustomPush> pushes(1 + solids_.size() + (job_.radiance ? 1 : 0), common);
  std::vector<gpu::Dispatch> dispatches;
  const auto add = [&](const gpu::Pipeline& pipeline, const gpu::Buffer* values, const Code* code = nullptr) {
    bound[0] = values;
    CustomPush& push = pushes[dispatches.size()];
    while (code && codes_[push.program].get() != code) ++push.program;
    dispatches.push_back(
        {&pipeline, bound, std::as_bytes(std::span(&push, 1)), {u(stride) * u(rows) / invocations, 1, 1}});
  };
  add(*surfaces_, nullptr);
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    CustomPush& push = pushes[1 + i];
    push.solid = static_cast<std::uint32_t>(scene_->world.solids.size() + i);
    if (const auto& bounds = solids_[i].solid->bounds) {
      push.flags |= boundedFlag;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        push.low[axis] = static_cast<float>((*bounds)[0][axis]);
        push.high[axis] = static_cast<float>((*bounds)[1][axis]);
      }
    }
    add(solids_[i].code->pipeline, &solids_[i].values, solids_[i].code.get());
  }
  if (radiance_) add(radiance_->pipeline, &radianceValues_, radiance_.get());
  else if (job_.radiance) add(*shade_, nullptr);
  const double ms = job_.device.run(dispatches);
  checkReport();
  return ms;
}

void CustomStage::checkReport() {
  const auto report = buffers_[9].as<std::uint32_t>();
  job_.stats.nanColours += report[0];
  if (report[1] == nothing) return;
  const CustomModule& module = codes_.at(report[1] >> programShift)->module;
  throw Error(Exit::shader,
              module.guard().place(report[1]) +
                  ": error: a pixel's loops went on for more than 8191 rounds here, expected them to end");
}

void CustomStage::read(const gpu::Buffer& hits, int stride, int rows, Band& band) const {
  const std::size_t words = static_cast<std::size_t>(stride) * u(rows);
  const std::uint32_t* colours = buffers_[8].as<std::uint32_t>().data();
  if (job_.radiance && job_.eightBits) readLevels(colours, stride, band, band.rgb8);
  else if (job_.radiance) readPlanes(colours, words, stride, 3, band, band.radiance);
  const std::uint32_t* planes = hits.as<std::uint32_t>().data();
  if (!job_.others) return;
  const Channels& c = job_.job.channels;
  if (c.distance) readPlanes(planes + distancePlane * words, words, stride, 1, band, band.distance);
  if (c.solid) readPlanes(planes + solidPlane * words, words, stride, 1, band, band.solid);
  if (c.normal) readPlanes(planes + normalPlane * words, words, stride, 3, band, band.normal);
  if (c.local) readPlanes(planes + localPlane * words, words, stride, 3, band, band.local);
  if (c.position) readPlanes(planes + positionPlane * words, words, stride, 3, band, band.position);
}

}  // namespace solidcast
