// renderGpu(): a picture in bands. Each band is dispatched (once for every sample and portion of the solids), its
// doubtful pixels get their second pass, and it goes to the sink.
#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <mutex>

#include "host/cast/program.h"
#include "host/cast/second_pass.h"
#include "host/cast/tiles.h"
#include "host/error.h"

namespace solidcast {
namespace {

using Clock = std::chrono::steady_clock;
double since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// pixels.comp: Portion
struct PixelPush {
  std::uint32_t wholeWidth, wholeHeight, firstX, firstY, rows, stride, stage, sampleX, sampleY, tileX, tileY;
  SearchPortion search;
};
static_assert(sizeof(PixelPush) <= 128);

enum Wanted : std::uint32_t { RGB8 = 1, RADIANCE = 2, DISTANCE = 4, SOLID = 8, NORMAL = 16, LOCAL = 32, POSITION = 64 };

// A workgroup's pixels (pixels.comp: local_size, RAYS). Buffers hold whole workgroups: the shader has no branch for
// pixels beyond the edge.
constexpr int groupWidth = 64, groupRows = 4;
constexpr int padded(int n, int to) { return (n + to - 1) / to * to; }

/// Words a pixel takes in the image buffer; the planes lie one after the other in the order of the bits.
std::uint32_t wordsOf(std::uint32_t wanted) {
  std::uint32_t words = 0;
  for (std::uint32_t bit = 1; bit <= POSITION; bit *= 2)
    if (wanted & bit) words += bit == RGB8 || bit == DISTANCE || bit == SOLID ? 1 : 3;
  return words;
}

std::uint8_t level(float v) { return static_cast<std::uint8_t>((v < 0 ? 0.f : v > 1 ? 1.f : v) * 255.f); }

/// One pass over the image: what the shader stores for one specialisation.
class Pass {
 public:
  Pass(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options, bool radiance,
       bool others, CastStats& stats)
      : device_(device), scene_(scene), job_(job), stats_(stats) {
    const Channels& c = job.channels;
    program_.job = Job::pixels;
    program_.method = options.method;
    program_.camera = cameraNumber(scene.camera);
    std::string why;
    program_.real = chooseReal(device.info(), options, Job::pixels, program_.camera, why);
    exact_ = options.method == Method::exact;
    surfaces_ = others && exact_ && (c.normal || c.local || c.position);
    program_.hits = others && !exact_ && (c.normal || c.local || c.position);
    samples_ = radiance ? job.samples : 1;
    wanted_ = 0;
    if (radiance && (c.rgb8 || c.radiance)) wanted_ |= c.rgb8 && !c.radiance && samples_ == 1 ? RGB8 : RADIANCE;
    if (others && (c.distance || surfaces_)) wanted_ |= DISTANCE;
    if (others && (c.solid || surfaces_)) wanted_ |= SOLID;
    if (program_.hits) wanted_ |= NORMAL * c.normal | LOCAL * c.local | POSITION * c.position;
    radiance_ = radiance, others_ = others;

    auto start = Clock::now();
    EyeFrame eye = eyeFrame(scene, program_.eye() ? program_.real : RealType::f64);
    Records forms;
    V3 origin = options.method == Method::naive ? V3{} : eye.origin;
    Records world;
    if (!program_.eye() || program_.hits) world = worldRecords(scene.world, origin, program_.real);
    if (program_.eye()) forms = eyeRecords(scene.world, eye, program_.real);
    const Records& search = program_.eye() ? forms : world;
    const auto& limits = device.info().limits;
    program_.storage =
        std::max(forms.bytes.size(), world.bytes.size()) > limits.maxUniformBufferRange || search.solids() > 4096;
    View view = viewRows(scene, eye, job.width, job.height, samples_, program_.real);
    portions_ = program_.storage ? portions(search) : std::vector<SearchPortion>(1);
    // finish.glsl looks free rays' solids up in the records that they are searched in: those stay whole.
    if (program_.storage && (program_.eye() || !program_.hits)) tiledSearch_ = search;
    stats.flatten_ms += since(start);

    start = Clock::now();
    gpu::Specialisation& constants = constants_;
    constants = recordConstants(program_, search, world);
    constants[viewRaws] = static_cast<std::uint32_t>(view.raws);
    constants[integratorNumber] = static_cast<std::uint32_t>(scene.integrator.index());
    constants[twoSided] = job.twoSided;
    constants[samples] = static_cast<std::uint32_t>(samples_);
    constants[wanted] = wanted_;
    // 32 u for prepared forms; for forms made on the way, what s needs to 2^-27 (fp64) or decisions alone (fp32).
    bool coarse = exact_ && program_.real == RealType::f32;
    float bound =
        program_.eye() ? static_cast<float>(32 * unitRoundoff(program_.real)) : std::ldexp(1.f, coarse ? -9 : -20);
    constants[doubt] = bits(bound);
    constants[hitsInDoubt] = coarse;
    spirv_ = programSpirv(program_, options);
    bakingCosts_ = options.baking == Baking::never ? std::nullopt : bakingMs(device.info(), program_, search);
    if (!bakingCosts_ || options.baking == Baking::automatic) pipeline_.emplace(device.makePipeline(spirv_, constants));
    auto use = program_.storage ? gpu::BufferUse::storage : gpu::BufferUse::uniform;
    buffers_.resize(8);
    if (program_.eye()) buffers_[0] = filledBuffer(device, forms.bytes, use);
    if (!world.bytes.empty() || !program_.eye() || program_.hits) buffers_[1] = filledBuffer(device, world.bytes, use);
    buffers_[2] = filledBuffer(device, view.rows, gpu::BufferUse::uniform);
    if (program_.camera == 1) buffers_[5] = filledBuffer(device, view.angles, gpu::BufferUse::storage);
    if (program_.hits)
      buffers_[7] = filledBuffer(device, std::as_bytes(std::span(world.places)), gpu::BufferUse::storage);
    if (options.baking == Baking::always) bake();
    stats.shader_ms += since(start);
    stats.module += (stats.module.empty() ? "" : ", ") + program_.moduleName();
    stats.spirvBytes += spirv_.size() * 4;
    stats.specialisedSpirvBytes += pipeline_->spirvBytes();
    stats.plan.push_back(why);
    stats.plan.push_back(program_.storage
                             ? "records in storage buffers: " + std::to_string(search.bytes.size()) + " bytes, " +
                                   std::to_string(portions_.size()) + " portion(s)"
                             : "records in a uniform buffer: " + std::to_string(search.bytes.size()) + " bytes");
    if (surfaces_) stats.plan.push_back("normals, local coordinates, points: in binary128 on the host, as exact asks");
  }

  /// Bytes of device memory a row of the crop takes, beside the records.
  std::size_t bytesPerRow(int width) const {
    std::size_t state = portions_.size() > 1 ? 48 : 0;
    return static_cast<std::size_t>(padded(width, groupWidth)) * (wordsOf(wanted_) * 4 + state) + width / 2;
  }
  const Program& program() const { return program_; }

  void makeBuffers(int width, int rows) {
    stride_ = padded(width, groupWidth);
    std::size_t pixels = static_cast<std::size_t>(stride_) * padded(rows, groupRows);
    buffers_[3] =
        device_.makeBuffer(std::max<std::size_t>(16, pixels * wordsOf(wanted_) * 4), gpu::BufferUse::readback);
    if (exact_) makeDoubts(pixels / 16 + 4096);
    if (program_.storage)
      buffers_[6] = device_.makeBuffer(portions_.size() > 1 ? pixels * 48 : 64, gpu::BufferUse::storage);
  }

  /// From now on with the records as constants of the pipeline, if that is possible and not done yet.
  void bake() {
    if (!bakingCosts_) return;
    std::map<std::uint32_t, std::span<const std::byte>> contents;
    for (std::uint32_t binding : {0u, 1u, 2u})  // world records by index of the hit stay a buffer
      if (!buffers_[binding].bytes().empty() && !(binding == 1 && program_.hits))
        contents[binding] = buffers_[binding].bytes();
    pipeline_.emplace(device_.makePipeline(gpu::baked(spirv_, contents), constants_));
    stats_.plan.push_back("records baked into the pipeline as constants");
    bakingCosts_.reset();
  }

  /// Tiles of the band and their records, where the scene is large enough to have them.
  void prepareTiles(const Band& band, const Crop& crop) {
    if (!tiledSearch_ || tiledRow_ == band.firstRow) return;
    auto start = Clock::now();
    tiledRow_ = band.firstRow;
    tiles_.clear();
    TileGrid grid{{crop.x, crop.y + band.firstRow, band.width, band.rows}, groupWidth, 4 * groupRows};
    while (std::int64_t{grid.across()} * grid.down() > 1024 && grid.tileHeight < band.rows) grid.tileHeight *= 2;
    TileLists lists = tileLists(scene_, job_.width, job_.height, samples_, grid);
    const auto& limits = device_.info().limits;
    auto tiled = tiledRecords(lists, grid, *tiledSearch_, limits.maxStorageBufferRange);
    std::span<const std::byte> bytes = tiled ? std::span<const std::byte>(tiled->bytes) : tiledSearch_->bytes;
    buffers_[program_.eye() ? 0 : 1] = filledBuffer(device_, bytes, gpu::BufferUse::storage);
    if (tiled) tiles_ = std::move(tiled->tiles);
    tileRows_ = grid.tileHeight;
    if (band.firstRow == 0)
      stats_.plan.push_back(tiled ? "searched by screen tiles of " + std::to_string(groupWidth) + "x" +
                                        std::to_string(tileRows_) + " pixels: " + std::to_string(bytes.size()) +
                                        " bytes of records, " + std::to_string(lists.everywhere.size()) +
                                        " solid(s) in every tile"
                                  : "not by screen tiles: their records would not fit a storage buffer");
    stats_.flatten_ms += since(start);
  }

  /// Runs the shader over the band and keeps the list of doubts.
  void dispatch(const Band& band, const Crop& crop) {
    prepareTiles(band, crop);
    if (doubtful_.size() < static_cast<std::size_t>(samples_) * samples_) doubtful_.resize(samples_ * samples_);
    std::vector<const gpu::Buffer*> bound;
    for (const gpu::Buffer& b : buffers_) bound.push_back(b.bytes().empty() ? nullptr : &b);
    for (int sample = 0; sample < samples_ * samples_; ++sample) {
      if (bakingCosts_ && spent_ > *bakingCosts_) bake();
      if (exact_) buffers_[4].as<std::uint32_t>()[0] = 0;
      std::vector<PixelPush> pushes;
      std::vector<int> heights;
      auto push = [&](int x, int y, int rows, const std::vector<SearchPortion>& search) {
        for (std::size_t p = 0; p < search.size(); ++p) {
          std::uint32_t stage = (p == 0 ? 1u : 0u) | (p + 1 == search.size() ? 2u : 0u);
          pushes.push_back({u(job_.width), u(job_.height), u(crop.x), u(crop.y + band.firstRow),
                            u(padded(band.rows, groupRows)), u(stride_), stage, u(sample % samples_),
                            u(sample / samples_), u(x), u(y), search[p]});
          heights.push_back(rows);
        }
      };
      int rows = padded(band.rows, groupRows);
      for (const TileSearch& tile : tiles_) push(tile.x, tile.y, std::min(tileRows_, rows - tile.y), tile.portions);
      if (tiles_.empty()) push(0, 0, rows, portions_);
      std::vector<gpu::Dispatch> dispatches;
      for (std::size_t i = 0; i < pushes.size(); ++i)
        dispatches.push_back({&*pipeline_,
                              bound,
                              std::as_bytes(std::span(&pushes[i], 1)),
                              {tiles_.empty() ? u(stride_ / groupWidth) : 1u, u(heights[i] / groupRows), 1}});
      auto start = Clock::now();
      double ms = device_.run(dispatches);
      if (warm_) spent_ += ms;
      if (!warm_) stats_.first_dispatch_ms += since(start);
      warm_ = true;
      stats_.dispatch_ms += ms;
      stats_.rays += static_cast<std::uint64_t>(band.width) * band.rows;
      if (!exact_) continue;
      auto doubts = buffers_[4].as<std::uint32_t>();
      if (doubts[0] > capacity_) return;
      doubtful_[static_cast<std::size_t>(sample)] = doubtfulPixels(doubts.subspan(2, doubts[0]), band);
    }
  }
  /// Fills the band's channels; the band's geometry is set already.
  void run(Band& band, const Crop& crop) {
    dispatch(band, crop);
    if (exact_ && buffers_[4].as<std::uint32_t>()[0] > capacity_) {  // more doubt than room: once more, with room
      makeDoubts(buffers_[4].as<std::uint32_t>()[0]);
      dispatch(band, crop);
    }
    auto start = Clock::now();
    read(band);
    stats_.readback_ms += since(start);
    start = Clock::now();
    if (exact_) secondPass(band, crop);
    if (samples_ > 1) {
      float n = static_cast<float>(samples_ * samples_);
      for (float& v : band.radiance) v /= n;
    }
    if (radiance_ && job_.channels.rgb8 && !(wanted_ & RGB8)) {
      band.rgb8.resize(band.radiance.size());
      std::transform(band.radiance.begin(), band.radiance.end(), band.rgb8.begin(), level);
    }
    if (radiance_ && !job_.channels.radiance) band.radiance.clear();
    if (others_ && !job_.channels.distance) band.distance.clear();
    if (others_ && !job_.channels.solid) band.solid.clear();
    stats_.fallback_ms += since(start);
  }

 private:
  void makeDoubts(std::size_t capacity) {
    capacity_ = static_cast<std::uint32_t>(capacity);
    buffers_[4] = device_.makeBuffer(8 + capacity * 4, gpu::BufferUse::readback);
    buffers_[4].as<std::uint32_t>()[1] = capacity_;
  }

  /// Pixels of the band, in order, from entries of pixels.comp's Doubts.
  std::vector<std::uint32_t> doubtfulPixels(std::span<const std::uint32_t> entries, const Band& band) const {
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t entry : entries) {
      std::uint32_t first = entry / 16 * 4, y = first / u(stride_), x = first % u(stride_);
      if (y >= u(band.rows)) continue;
      for (std::uint32_t k = 0; k < 4 && x + k < u(band.width); ++k)
        if (entry >> k & 1) pixels.push_back(y * u(band.width) + x + k);
    }
    std::sort(pixels.begin(), pixels.end());
    return pixels;
  }

  static std::uint32_t u(int v) { return static_cast<std::uint32_t>(v); }

  template <class T>
  void readPlanes(const std::uint32_t*& plane, int count, const Band& band, std::vector<T>& to) {
    to.resize(static_cast<std::size_t>(band.width) * band.rows * count);
    for (int c = 0; c < count; ++c, plane += static_cast<std::size_t>(stride_) * padded(band.rows, groupRows))
      for (int y = 0; y < band.rows; ++y) {
        const std::uint32_t* row = plane + static_cast<std::size_t>(y) * stride_;
        T* out = to.data() + (static_cast<std::size_t>(y) * band.width) * count + c;
        for (int x = 0; x < band.width; ++x) out[static_cast<std::size_t>(x) * count] = std::bit_cast<T>(row[x]);
      }
  }

  void read(Band& band) {
    const std::uint32_t* plane = buffers_[3].as<std::uint32_t>().data();
    if (wanted_ & RGB8) {
      band.rgb8.resize(static_cast<std::size_t>(band.width) * band.rows * 3);
      std::uint8_t* out = band.rgb8.data();
      for (int y = 0; y < band.rows; ++y) {
        const std::uint32_t* row = plane + static_cast<std::size_t>(y) * stride_;
        for (int x = 0; x < band.width; ++x, out += 3) {
          out[0] = static_cast<std::uint8_t>(row[x]);
          out[1] = static_cast<std::uint8_t>(row[x] >> 8);
          out[2] = static_cast<std::uint8_t>(row[x] >> 16);
        }
      }
      plane += static_cast<std::size_t>(stride_) * padded(band.rows, groupRows);
    }
    if (wanted_ & RADIANCE) readPlanes(plane, 3, band, band.radiance);
    if (wanted_ & DISTANCE) readPlanes(plane, 1, band, band.distance);
    if (wanted_ & SOLID) readPlanes(plane, 1, band, band.solid);
    if (wanted_ & NORMAL) readPlanes(plane, 3, band, band.normal);
    if (wanted_ & LOCAL) readPlanes(plane, 3, band, band.local);
    if (wanted_ & POSITION) readPlanes(plane, 3, band, band.position);
  }

  struct Light {
    float rgb[3] = {0, 0, 0};
  };
  /// The integrators of shaders/integrators once more, for single pixels.
  Light integrate(const RayQ& ray, const ExactHit& hit, V3 normal) const {
    if (!hit) return {};
    float cosine = static_cast<float>(-dot(normal, ray.direction));
    cosine = job_.twoSided ? std::abs(cosine) : std::max(cosine, 0.f);
    Light light{{cosine, cosine, cosine}};
    if (const auto* dist = std::get_if<RayCastingDistIntegrator>(&scene_.integrator)) {
      auto nearDist = static_cast<float>(dist->nearDist), farDist = static_cast<float>(dist->farDist);
      float part = std::clamp((static_cast<float>(hit.t) - nearDist) / (farDist - nearDist), 0.f, 1.f);
      for (int c = 0; c < 3; ++c) {
        auto from = static_cast<float>(dist->nearColor[static_cast<std::size_t>(c)]);
        auto to = static_cast<float>(dist->farColor[static_cast<std::size_t>(c)]);
        light.rgb[c] = (from + part * (to - from)) * cosine;
      }
    }
    return light;
  }

  void secondPass(Band& band, const Crop& crop) {
    std::size_t doubts = 0;
    for (const auto& list : doubtful_) doubts += list.size();
    stats_.fallbackRays += doubts;
    if (doubts == 0 && !surfaces_) return;
    if (!second_) second_.emplace(scene_.world);
    PixelRays rays(scene_, job_.width, job_.height, samples_);
    auto rayOf = [&](std::size_t pixel, std::size_t sample) {
      std::int64_t x = crop.x + static_cast<std::int64_t>(pixel) % band.width;
      std::int64_t y = crop.y + band.firstRow + static_cast<std::int64_t>(pixel) / band.width;
      auto n = static_cast<std::size_t>(samples_);
      return rays.ray(x * samples_ + static_cast<std::int64_t>(sample % n),
                      y * samples_ + static_cast<std::int64_t>(sample / n));
    };
    for (std::size_t sample = 0; sample < doubtful_.size(); ++sample) {
      const auto& list = doubtful_[sample];
      inParallel(list.size(), [&](std::size_t i) {
        std::size_t pixel = list[i];
        RayQ ray = rayOf(pixel, sample);
        ExactHit hit = second_->cast(ray);
        Light light = integrate(ray, hit, hit ? second_->surface(ray, hit).normal : V3{});
        for (std::size_t c = 0; c < 3; ++c) {
          if (wanted_ & RGB8) band.rgb8[3 * pixel + c] = level(light.rgb[c]);
          if (wanted_ & RADIANCE) band.radiance[3 * pixel + c] += light.rgb[c];
        }
        if (wanted_ & DISTANCE)
          band.distance[pixel] = hit ? static_cast<float>(hit.t) : std::numeric_limits<float>::infinity();
        if (wanted_ & SOLID) band.solid[pixel] = hit.index;
      });
    }
    if (surfaces_) fillSurfaces(band, rayOf);
  }

  template <class RayOf>
  void fillSurfaces(Band& band, const RayOf& rayOf) {
    const Channels& c = job_.channels;
    std::size_t pixels = static_cast<std::size_t>(band.width) * band.rows;
    if (c.normal) band.normal.assign(3 * pixels, 0);
    if (c.local) band.local.assign(3 * pixels, 0);
    if (c.position) band.position.assign(3 * pixels, 0);
    inParallel(pixels, [&](std::size_t pixel) {
      if (band.solid[pixel] < 0) return;
      RayQ ray = rayOf(pixel, 0);
      ExactHit hit = second_->castAt(ray, band.solid[pixel]);
      if (!hit) hit = {band.solid[pixel], band.distance[pixel]};
      Surface s = second_->surface(ray, hit);
      V3 p = ray.origin + hit.t * ray.direction;
      for (int k = 0; k < 3; ++k) {
        std::size_t at = 3 * pixel + static_cast<std::size_t>(k);
        if (c.normal) band.normal[at] = static_cast<float>(s.normal[k]);
        if (c.local) band.local[at] = static_cast<float>(s.local[k]);
        if (c.position) band.position[at] = static_cast<float>(p[k]);
      }
    });
  }

  gpu::Device& device_;
  const Scene& scene_;
  const RenderJob& job_;
  CastStats& stats_;
  Program program_;
  bool exact_ = false, surfaces_ = false, radiance_ = false, others_ = false, warm_ = false;
  int samples_ = 1, stride_ = 0;
  std::uint32_t wanted_ = 0, capacity_ = 0;
  std::vector<SearchPortion> portions_;
  std::optional<Records> tiledSearch_;  // what tiles are made from
  std::vector<TileSearch> tiles_;       // of the band that starts at tiledRow_; empty: the whole band at once
  int tiledRow_ = -1, tileRows_ = 0;
  std::optional<gpu::Pipeline> pipeline_;
  std::vector<std::uint32_t> spirv_;
  gpu::Specialisation constants_;
  std::optional<double> bakingCosts_;                 // ms; none: not possible, not wanted, or done
  double spent_ = 0;                                  // ms of dispatches so far, without the first
  std::vector<gpu::Buffer> buffers_;                  // by binding
  std::vector<std::vector<std::uint32_t>> doubtful_;  // by sample: pixels of the band
  std::optional<SecondPass> second_;
};

}  // namespace

struct ImageCaster::Impl {
  gpu::Device& device;
  const Scene& scene;
  const RenderJob& job;
  Crop crop;
  CastStats stats;
  std::vector<std::unique_ptr<Pass>> passes;
  int bandRows = 0;

  Impl(gpu::Device& d, const Scene& s, const RenderJob& j, const CastOptions& options)
      : device(d), scene(s), job(j), crop(j.crop) {
    if (crop.width == 0) crop = {0, 0, job.width, job.height};
    const Channels& c = job.channels;
    bool radiance = c.rgb8 || c.radiance;
    bool others = c.distance || c.solid || c.normal || c.local || c.position;
    if (!radiance && !others) throw Error(Exit::usage, "render: no channel was asked for");
    // With several samples the other channels, which are of the pixel's centre, need a pass of their own.
    if (job.samples == 1 || !others || !radiance) {
      addPass(options, radiance, others);
    } else {
      addPass(options, true, false);
      addPass(options, false, true);
    }
    bandRows = rowsInBudget(options.memoryBudget);
    for (auto& pass : passes) pass->makeBuffers(crop.width, bandRows);
    stats.leftOut = leftOutLines(passes.front()->program(), scene.world, job.channels);
    stats.deviceBytes = device.peakBytes();
  }

  void addPass(const CastOptions& options, bool radiance, bool others) {
    passes.push_back(std::make_unique<Pass>(device, scene, job, options, radiance, others, stats));
  }

  int rowsInBudget(std::size_t budget) {
    std::size_t perRow = 0, largest = 0;
    for (const auto& pass : passes) {
      perRow += pass->bytesPerRow(crop.width);
      largest = std::max(largest, pass->bytesPerRow(crop.width));
    }
    const auto& limits = device.info().limits;
    // The host holds a copy of a band, so half of the budget is the device's; and no band above 64 MiB: nothing is
    // gained by it.
    std::size_t room = std::min<std::size_t>(budget / 2, std::size_t{64} << 20);
    std::size_t groups = std::min({room / (perRow * groupRows), limits.maxStorageBufferRange / (largest * groupRows),
                                   std::size_t{limits.maxWorkGroupCount[1]}});
    std::size_t rows = std::min(groups * groupRows, static_cast<std::size_t>(crop.height));
    if (rows == 0)
      throw Error(Exit::usage, "render: " + std::to_string(groupRows) + " rows of " + std::to_string(crop.width) +
                                   " pixels take " + std::to_string(perRow * groupRows) + " bytes, expected at most " +
                                   std::to_string(std::min<std::size_t>(room, limits.maxStorageBufferRange)));
    if (static_cast<int>(rows) < crop.height)
      stats.plan.push_back("in bands of " + std::to_string(rows) + " rows: " + std::to_string(perRow) +
                           " bytes a row, at most " + std::to_string(room) + " a band");
    return static_cast<int>(rows);
  }

  void forEachBand(const std::function<void(Band&)>& f) {
    for (int first = 0; first < crop.height; first += bandRows) {
      Band band;
      band.firstRow = first;
      band.rows = std::min(bandRows, crop.height - first);
      band.width = crop.width;
      f(band);
    }
  }
};

ImageCaster::ImageCaster(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options)
    : impl_(std::make_unique<Impl>(device, scene, job, options)) {}
ImageCaster::~ImageCaster() = default;

void ImageCaster::render(const BandSink& sink, const CastProgress& progress) {
  impl_->forEachBand([&](Band& band) {
    for (auto& pass : impl_->passes) pass->run(band, impl_->crop);
    impl_->stats.deviceBytes = impl_->device.peakBytes();
    int done = band.firstRow + band.rows;
    sink(band);
    if (progress) progress(double(done) / impl_->crop.height);
  });
}

double ImageCaster::dispatchOnly() {
  for (auto& pass : impl_->passes) pass->bake();
  double before = impl_->stats.dispatch_ms;
  impl_->forEachBand([&](Band& band) {
    for (auto& pass : impl_->passes) pass->dispatch(band, impl_->crop);
  });
  return impl_->stats.dispatch_ms - before;
}

const CastStats& ImageCaster::stats() const { return impl_->stats; }

void renderGpu(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options,
               const BandSink& sink, CastStats& stats, const CastProgress& progress) {
  ImageCaster caster(device, scene, job, options);
  caster.render(sink, progress);
  stats = caster.stats();
}

}  // namespace solidcast
