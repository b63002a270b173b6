#include "host/cast/list_search.h"

#include <algorithm>
#include <bit>

#include "host/cast/stopwatch.h"
#include "host/error.h"

namespace solidcast {
namespace {

// lists.comp: Portion
struct ListPush {
  std::uint32_t wholeWidth, wholeHeight, firstX, firstY, rows, stride, sampleX, sampleY, from, to, last, listTexels;
};

constexpr std::uint32_t groupLanes = 64;  // lists.comp: local_size_x
/// Entries that a dispatch walks: llvmpipe stops all loops of an invocation after 65535 rounds without a word.
constexpr std::uint32_t mostEntries = 65000;
constexpr std::size_t readAhead = 2;         // lists.comp: rows that it loads behind the last one
constexpr std::size_t stateBytes = 40 * 16;  // lists.comp: State, by tile, at most

/// What is taken for a buffer of so many bytes, so that it serves the next scene too.
std::size_t withRoom(std::size_t bytes) { return std::max<std::size_t>(bytes + bytes / 8, 64) / 16 * 16; }

/// Into the buffer that is there, if it has that size.
void fill(gpu::Device& device, gpu::Buffer& buffer, std::span<const std::byte> bytes, gpu::BufferUse use) {
  if (buffer.bytes().size() == bytes.size()) std::ranges::copy(bytes, buffer.bytes().begin());
  else buffer = filledBuffer(device, bytes, use);
}

/// Keeps the buffer while it is large enough; its contents are not kept.
void reserve(gpu::Device& device, gpu::Buffer& buffer, std::size_t bytes, gpu::BufferUse use) {
  if (buffer.bytes().size() >= std::max<std::size_t>(bytes, 16)) return;
  buffer = {};
  buffer = device.makeBuffer(withRoom(bytes), use);
}

}  // namespace

ListSearch::ListSearch(const PassJob& job, const Scene& scene) : job_(job), scene_(&scene), program_(job.program) {
  program_.job = Job::lists;
  program_.storage = !job_.device.info().name.starts_with("llvmpipe");
  job_.stats.modules.push_back(program_.moduleName());
  loadShader();
  setScene(scene);
}

void ListSearch::loadShader() {
  gpu::CompiledModule module = programModule(program_, job_.options);
  job_.stats.files.insert(job_.stats.files.end(), module.files.begin(), module.files.end());
  spirv_ = std::move(module.spirv);
  job_.stats.spirvBytes += spirv_.size() * 4;
  pipeline_.reset();
}

void ListSearch::setScene(const Scene& scene) {
  scene_ = &scene;
  builtRow_ = -1;
  Stopwatch flattening;
  builder_.prepare();
  silhouette_.emplace(scene, job_.job.width, job_.job.height, job_.job.samples);
  eye_ = eyeFrame(scene, program_.eye() ? program_.real : RealType::f64);
  const View view = viewRows(scene, eye_, job_.job.width, job_.job.height, job_.samples, program_.real);
  fill(job_.device, view_, view.rows, gpu::BufferUse::uniform);
  if (program_.camera == 1) fill(job_.device, angles_, view.angles, gpu::BufferUse::storage);
  viewRaws_ = static_cast<std::uint32_t>(view.raws);
  job_.stats.flatten_ms += flattening.ms();
}

void ListSearch::prepare(const PassTarget& target, const Band& band) {
  if (builtRow_ == band.firstRow) return;
  builtRow_ = band.firstRow;
  build(target, band);
}

void ListSearch::build(const PassTarget& target, const Band& band) {
  Stopwatch flattening;
  ListGrid grid;
  grid.region = {job_.crop.x, job_.crop.y + band.firstRow, band.width, band.rows};
  grid.across = target.stride / ListGrid::tile, grid.down = target.rows / ListGrid::tile;
  builder_.collect(*scene_, eye_, program_.real, program_.eye(), *silhouette_, grid, [this] { return room(); });
  job_.stats.flatten_ms += flattening.ms();
  if (!told_)
    job_.stats.plan.push_back("lists of " + std::to_string(builder_.seen()) + " solids for " +
                              std::to_string(builder_.listedTiles()) + " tiles of 4x4 pixels, up to " +
                              std::to_string(builder_.longest()) +
                              " in one: " + std::to_string(builder_.rows() * rowBytes(program_.real)) + " bytes");
  told_ = true;
  Stopwatch making;
  makePipeline();
  job_.stats.shader_ms += making.ms();
}

/// Buffers that hold what has been found.
ListRoom ListSearch::room() {
  for (std::size_t k = 0; k < kindCount; ++k) kinds_[k] = kinds_[k] || builder_.kinds()[k];
  const bool exact = program_.method == Method::exact;
  grazing_ = grazing_ || (exact && builder_.grazing());
  farSphere_ = farSphere_ || builder_.farSphere();
  boxOnFace_ = boxOnFace_ || (exact && builder_.boxOnFace());
  // Solids of one kind are walked in the order of their indices, but for the wide tiles' among them.
  ties_ = ties_ || builder_.wideOnes() || std::count(kinds_.begin(), kinds_.end(), true) > 1;
  portioned_ = portioned_ || builder_.longest() > mostEntries;

  // Whole workgroups, filled up with tiles that have no solids; there are always enough of them.
  lanes_ = (builder_.listedTiles() + groupLanes - 1) / groupLanes * groupLanes;
  const std::size_t laneTexels = 1 + std::count(kinds_.begin(), kinds_.end(), true);
  const std::size_t bytes = builder_.rows() * rowBytes(program_.real);
  const std::size_t listBytes = lanes_ * laneTexels * 16;
  const std::size_t texels = job_.device.info().limits.maxTexelBufferElements;
  if (!program_.storage &&
      std::max(withRoom(bytes + readAhead * rowBytes(program_.real)), withRoom(listBytes)) / 16 > texels) {
    program_.storage = true;  // from now on
    records_ = {}, lists_ = {};
    loadShader();
  }
  const auto use = program_.storage ? gpu::BufferUse::storage : gpu::BufferUse::texels;
  reserve(job_.device, records_, bytes + readAhead * rowBytes(program_.real), use);
  reserve(job_.device, lists_, listBytes, use);
  reserve(job_.device, state_, portioned_ ? lanes_ * stateBytes : 16, gpu::BufferUse::storage);
  return {records_.bytes(), lists_.bytes(), lanes_, kinds_};
}

void ListSearch::makePipeline() {
  gpu::Specialisation constants;
  for (std::uint32_t kind = 0; kind < kindCount; ++kind) constants[kind] = kinds_[kind];
  constants[viewRaws] = viewRaws_;
  constants[boxFacePlane] = boxOnFace_;
  constants[someGraze] = grazing_;
  constants[someFarSphere] = farSphere_;
  constants[portioned] = portioned_;
  const bool radiance = job_.wanted & (RGB8 | RADIANCE);
  constants[integratorNumber] = radiance ? static_cast<std::uint32_t>(scene_->integrator.index()) : 0;
  constants[greyLevels] = isGrey(*scene_);
  constants[twoSided] = job_.job.twoSided;
  constants[samples] = u(job_.samples);
  constants[wanted] = job_.wanted;
  constants[doubt] = bits(doubtOf(program_));
  constants[hitsInDoubt] = false;
  constants[someTie] = ties_;
  if (pipeline_ && constants == constants_) return;
  constants_ = std::move(constants);
  pipeline_.emplace(job_.device.makePipeline(spirv_, constants_));
  ++job_.stats.pipelines;
  job_.stats.specialisedSpirvBytes += pipeline_->spirvBytes();
}

/// Tiles without solids are not dispatched: the host says that nothing is seen there.
/// They are in their order, whole rows of them beside each other.
void ListSearch::fillUnlisted(const PassTarget& target) const {
  std::uint32_t* plane = target.image.as<std::uint32_t>().data();
  const std::size_t stride = static_cast<std::size_t>(target.stride), words = stride * u(target.rows);
  const auto across = static_cast<std::uint32_t>(target.stride / ListGrid::tile);
  const auto tiles = builder_.tiles().subspan(lanes_);
  const auto fill = [&](int planes, std::uint32_t value, std::size_t tileWords = ListGrid::tile) {
    for (; planes > 0; --planes, plane += words)
      for (std::size_t first = 0, end; first < tiles.size(); first = end) {
        const std::uint32_t row = tiles[first] / across, next = (row + 1) * across;
        for (end = first + 1; end < tiles.size() && tiles[end] == tiles[end - 1] + 1 && tiles[end] != next;) ++end;
        std::uint32_t* to = plane + (std::size_t{row} * ListGrid::tile * across + tiles[first] % across) * tileWords;
        for (int y = 0; y < ListGrid::tile; ++y, to += across * tileWords)
          std::fill_n(to, (end - first) * tileWords, value);
      }
  };
  if (job_.wanted & RGB8) fill(1, 0, isGrey(*scene_) ? 1 : ListGrid::tile);
  if (job_.wanted & RADIANCE) fill(3, 0);
  if (job_.wanted & DISTANCE) fill(1, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()));
  if (job_.wanted & SOLID) fill(1, ~0u);
}

double ListSearch::dispatch(const PassTarget& target, const Band& band, int sample) {
  const int n = job_.samples;
  std::vector<ListPush> pushes;
  const auto texels = static_cast<std::uint32_t>(1 + std::count(kinds_.begin(), kinds_.end(), true));
  for (std::uint32_t from = 0; from == 0 || from < builder_.longest(); from += mostEntries)
    pushes.push_back({u(job_.job.width), u(job_.job.height), u(job_.crop.x), u(job_.crop.y + band.firstRow),
                      u(target.rows), u(target.stride), u(sample % n), u(sample / n), from, from + mostEntries,
                      from + mostEntries >= builder_.longest(), texels});
  const std::vector<const gpu::Buffer*> bound = {&records_,     &lists_,  &view_, &target.image,
                                                 target.doubts, &angles_, &state_};
  std::vector<gpu::Dispatch> dispatches;
  for (const ListPush& push : pushes)
    dispatches.push_back({&*pipeline_,
                          bound,
                          std::as_bytes(std::span(&push, 1)),
                          {static_cast<std::uint32_t>(lanes_) / groupLanes, 1, 1}});
  const auto fill = [&] {
    if (sample == 0) fillUnlisted(target);
  };
  if (lanes_ > 0) return job_.device.run(dispatches, fill);
  fill();
  return 0;
}

}  // namespace solidcast
