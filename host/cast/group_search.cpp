#include "host/cast/group_search.h"

#include <algorithm>
#include <cmath>

#include "host/cast/stopwatch.h"
#include "host/error.h"

namespace solidcast {
namespace {

constexpr int tileWidth = 64;
/// Pixels of an invocation. More share more, until the registers are full: the state of `exact` is twice as large.
/// Double-float takes seconds to compile even for four.
std::uint32_t raysOf(const Program& p, std::uint32_t solids, bool wide) {
  if (!wide || !p.eye() || p.storage || p.hits || p.real == RealType::df32 || solids > mostWide) return 4;
  return p.method == Method::fast ? 16 : 8;
}

// pixels.comp: Portion
struct PixelPush {
  std::uint32_t wholeWidth, wholeHeight, firstX, firstY, rows, stride, stage, sampleX, sampleY, tileX, tileY;
  SearchPortion search;
  std::uint32_t unused = 0;
  std::uint64_t records = 0, view = 0;  // addresses, where the program reads by them
};
static_assert(sizeof(PixelPush) <= 128);

}  // namespace

GroupSearch::GroupSearch(const PassJob& job, const Scene& scene, const PlanChoice& choice)
    : job_(job),
      scene_(&scene),
      program_(job.program),
      asked_(choice.plan),
      bakeAtOnce_(choice.plan == Plan::baked),
      wide_(choice.wide),
      address_(choice.address),
      turn_(choice.turn),
      buffers_(8) {
  if (choice.plan == Plan::baked || choice.bakeLater) bakingCosts_ = choice.bakingMs;
  setScene(scene);
}

void GroupSearch::setScene(const Scene& scene) {
  scene_ = &scene;
  tiledSearch_.reset();
  tiles_.clear();
  tiledRow_ = -1;
  Stopwatch flattening;
  const bool eyeForms = program_.eye();
  EyeFrame eye = eyeFrame(scene, eyeForms ? program_.real : RealType::f64);
  Records forms, world;
  V3 origin = program_.method == Method::naive ? V3{} : eye.origin;
  if (!eyeForms || program_.hits) world = worldRecords(scene.world, origin, program_.real);
  if (eyeForms) forms = eyeRecords(scene.world, eye, program_.real);
  const Records& search = eyeForms ? forms : world;
  chooseStorage(search, world.bytes.size());
  View view = viewRows(scene, eye, job_.job.width, job_.job.height, job_.samples, program_.real);
  portions_ = program_.storage ? portions(search) : std::vector<SearchPortion>(1);
  // finish.glsl looks free rays' solids up in the records that they are searched in: those stay whole.
  const bool tileable = program_.storage && (eyeForms || !program_.hits);
  if (asked_ == Plan::tiles && !tileable)
    throw Error(Exit::usage,
                "--plan tiles: normals of rays without a common origin need all records in one place, "
                "expected --plan storage");
  if (tileable && asked_ == Plan::tiles) tiledSearch_ = search;
  job_.stats.flatten_ms += flattening.ms();

  Stopwatch making;
  const auto use = program_.storage ? gpu::BufferUse::storage : gpu::BufferUse::uniform;
  auto& device = job_.device;
  if (eyeForms) buffers_[0] = filledBuffer(device, forms.bytes, use);
  if (!world.bytes.empty() || !eyeForms || program_.hits) buffers_[1] = filledBuffer(device, world.bytes, use);
  buffers_[2] = filledBuffer(device, view.rows, gpu::BufferUse::uniform);
  if (program_.camera == 1) buffers_[5] = filledBuffer(device, view.angles, gpu::BufferUse::storage);
  if (program_.hits)
    buffers_[7] = filledBuffer(device, std::as_bytes(std::span(world.places)), gpu::BufferUse::storage);
  makePipeline(search, world, view.raws);
  job_.stats.shader_ms += making.ms();
}

/// Storage buffers where the plan says so, or where the records do not fit a uniform buffer after all.
void GroupSearch::chooseStorage(const Records& search, std::size_t worldBytes) {
  const std::size_t bytes = std::max(search.bytes.size(), worldBytes);
  const std::size_t uniformRange = job_.device.info().limits.maxUniformBufferRange;
  const bool fits = bytes <= uniformRange;
  const bool named = job_.options.plan == Plan::uniform || job_.options.plan == Plan::baked;
  if (named && !fits)
    throw Error(Exit::usage, std::string("--plan ") + planName(asked_) + ": the records take " + std::to_string(bytes) +
                                 " bytes, expected at most the " + std::to_string(uniformRange) +
                                 " of a uniform buffer of this device");
  program_.storage = asked_ == Plan::storage || asked_ == Plan::tiles || !fits;
  const std::size_t storageRange = job_.device.info().limits.maxStorageBufferRange;
  if (bytes > storageRange && asked_ != Plan::tiles)
    throw Error(Exit::usage, "the scene's records take " + std::to_string(bytes) +
                                 " bytes, this device's storage buffers hold " + std::to_string(storageRange));
  if (pipeline_) return;
  job_.stats.plan.push_back((program_.storage ? "records in storage buffers: " : "records in a uniform buffer: ") +
                            std::to_string(search.bytes.size()) + " bytes");
}

void GroupSearch::makePipeline(const Records& search, const Records& world, std::size_t viewRaws_) {
  gpu::Specialisation constants = recordConstants(program_, search, world);
  constants[viewRaws] = static_cast<std::uint32_t>(viewRaws_);
  const bool radiance = job_.wanted & (RGB8 | RADIANCE);
  constants[integratorNumber] = radiance ? static_cast<std::uint32_t>(scene_->integrator.index()) : 0;
  constants[greyLevels] = isGrey(*scene_);
  constants[twoSided] = job_.job.twoSided;
  constants[samples] = u(job_.samples);
  constants[wanted] = job_.wanted;
  constants[doubt] = bits(doubtOf(program_));
  constants[hitsInDoubt] = program_.method == Method::exact && program_.real == RealType::f32;
  solids_ = search.solids();
  program_.address = address_ && !bakeAtOnce_ && !program_.storage && solids_ <= mostWide;
  program_.turn = program_.address ? turn_ : 0;
  constants[rays] = program_.turn > 0 ? 16 : raysOf(program_, solids_, wide_);
  const bool same = pipeline_ && constants == constants_ && !bakeAtOnce_;
  if (same) return;
  constants_ = std::move(constants);
  if (bakeAtOnce_) return bake();
  loadModule();
  const bool marked = program_.address && program_.turn == 0;  // its loops for unrolling, by the driver
  usePipeline(marked ? gpu::baked(spirv_, {}) : spirv_);
}

void GroupSearch::loadModule() {
  const std::string name = program_.moduleName();
  if (name == compiled_) return;
  gpu::CompiledModule module = programModule(program_, job_.options);
  CastStats& stats = job_.stats;
  stats.files.insert(stats.files.end(), module.files.begin(), module.files.end());
  stats.spirvBytes += 4 * (module.spirv.size() - spirv_.size());
  if (compiled_.empty()) stats.modules.push_back(name);
  else *std::find(stats.modules.begin(), stats.modules.end(), compiled_) = name;
  spirv_ = std::move(module.spirv);
  compiled_ = name;
}

void GroupSearch::usePipeline(std::span<const std::uint32_t> spirv) {
  job_.stats.specialisedSpirvBytes -= pipeline_ ? pipeline_->spirvBytes() : 0;
  pipeline_.emplace(job_.device.makePipeline(spirv, constants_));
  job_.stats.specialisedSpirvBytes += pipeline_->spirvBytes();
  ++job_.stats.pipelines;
}

void GroupSearch::settle() {
  if (bakingCosts_ && !bakeAtOnce_ && job_.options.plan == Plan::automatic) bake();
}

/// From now on with the records as constants of the pipeline.
void GroupSearch::bake() {
  std::map<std::uint32_t, std::span<const std::byte>> contents;
  for (std::uint32_t binding : {0u, 1u, 2u})  // world records by index of the hit stay a buffer
    if (!buffers_[binding].bytes().empty() && !(binding == 1 && program_.hits))
      contents[binding] = buffers_[binding].bytes();
  program_.address = false;
  program_.turn = 0;
  loadModule();
  constants_[rays] = raysOf(program_, solids_, true);
  usePipeline(gpu::baked(spirv_, contents));
  job_.stats.plan.push_back("records baked into the pipeline as constants");
  job_.stats.planName = planName(Plan::baked);
  bakeAtOnce_ = true;
}

/// Tiles of the band and their records, where the plan has them.
void GroupSearch::prepareTiles(const Band& band) {
  if (!tiledSearch_ || tiledRow_ == band.firstRow) return;
  Stopwatch flattening;
  tiledRow_ = band.firstRow;
  tiles_.clear();
  const Crop& crop = job_.crop;
  TileGrid grid{{crop.x, crop.y + band.firstRow, band.width, band.rows}, tileWidth, 2 * groupRows};
  while (std::int64_t{grid.across()} * grid.down() > 1024 && grid.tileHeight < band.rows) grid.tileHeight *= 2;
  TileLists lists = tileLists(*scene_, job_.job.width, job_.job.height, job_.samples, grid);
  const std::size_t limit = job_.device.info().limits.maxStorageBufferRange;
  auto tiled = tiledRecords(lists, grid, *tiledSearch_, limit);
  if (!tiled && tiledSearch_->bytes.size() > limit)
    throw Error(Exit::usage, "the scene's records take " + std::to_string(tiledSearch_->bytes.size()) +
                                 " bytes, this device's storage buffers hold " + std::to_string(limit));
  std::span<const std::byte> bytes = tiled ? std::span<const std::byte>(tiled->bytes) : tiledSearch_->bytes;
  buffers_[program_.eye() ? 0 : 1] = filledBuffer(job_.device, bytes, gpu::BufferUse::storage);
  if (tiled) tiles_ = std::move(tiled->tiles);
  tileRows_ = grid.tileHeight;
  if (!warm_)
    job_.stats.plan.push_back(tiled ? "searched by screen tiles of " + std::to_string(tileWidth) + "x" +
                                          std::to_string(tileRows_) + " pixels: " + std::to_string(bytes.size()) +
                                          " bytes of records, " + std::to_string(lists.everywhere.size()) +
                                          " solid(s) in every tile"
                                    : "not by screen tiles: their records would not fit a storage buffer");
  job_.stats.flatten_ms += flattening.ms();
}

double GroupSearch::dispatch(const PassTarget& target, const Band& band, int sample) {
  if (bakingCosts_ && !bakeAtOnce_ && spent_ > *bakingCosts_) bake();
  if (program_.storage) {
    const std::size_t kept = portions_.size() > 1 ? std::size_t{u(target.stride)} * u(target.rows) * stateBytes : 64;
    if (buffers_[6].bytes().size() < kept) buffers_[6] = job_.device.makeBuffer(kept, gpu::BufferUse::storage);
  }
  std::vector<const gpu::Buffer*> bound;
  for (const gpu::Buffer& b : buffers_) bound.push_back(b.bytes().empty() ? nullptr : &b);
  bound[3] = &target.image;
  bound[4] = target.doubts;
  const int n = job_.samples;
  std::vector<PixelPush> pushes;
  std::vector<int> heights;
  auto addressOf = [&](std::size_t binding) {
    return program_.address && bound[binding] ? bound[binding]->address() : 0;
  };
  auto push = [&](int x, int y, int rows, const std::vector<SearchPortion>& search) {
    for (std::size_t p = 0; p < search.size(); ++p) {
      std::uint32_t stage = (p == 0 ? 1u : 0u) | (p + 1 == search.size() ? 2u : 0u);
      pushes.push_back({u(job_.job.width), u(job_.job.height), u(job_.crop.x), u(job_.crop.y + band.firstRow),
                        u(target.rows), u(target.stride), stage, u(sample % n), u(sample / n), u(x), u(y), search[p], 0,
                        addressOf(program_.eye() ? 0 : 1), addressOf(2)});
      heights.push_back(rows);
    }
  };
  for (const TileSearch& tile : tiles_) push(tile.x, tile.y, std::min(tileRows_, target.rows - tile.y), tile.portions);
  if (tiles_.empty()) push(0, 0, target.rows, portions_);
  const int across = 8 * static_cast<int>(constants_.at(rays));  // pixels of a workgroup
  std::vector<gpu::Dispatch> dispatches;
  for (std::size_t i = 0; i < pushes.size(); ++i)
    dispatches.push_back(
        {&*pipeline_,
         bound,
         std::as_bytes(std::span(&pushes[i], 1)),
         {u(padded(tiles_.empty() ? band.width : tileWidth, across) / across), u(heights[i] / groupRows), 1}});
  double ms = job_.device.run(dispatches);
  if (warm_) spent_ += ms;
  warm_ = true;
  return ms;
}

}  // namespace solidcast
