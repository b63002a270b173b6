#include "host/cast/pass.h"

#include <algorithm>

#include "host/cast/planes.h"
#include "host/cast/stopwatch.h"

namespace solidcast {
namespace {

/// Words a pixel takes in the image buffer; the planes lie one after the other in the order of the bits.
std::uint32_t wordsOf(std::uint32_t wanted) {
  std::uint32_t words = 0;
  for (std::uint32_t bit = 1; bit <= POSITION; bit *= 2)
    if (wanted & bit) words += bit == RGB8 || bit == DISTANCE || bit == SOLID ? 1 : 3;
  return words;
}

}  // namespace

bool isGrey(const Scene& scene) {
  static constexpr int channels[] = {
#define INTEGRATOR(NUMBER, name, Type, CHANNELS) CHANNELS,
#include "shaders/integrators.def"
#undef INTEGRATOR
  };
  const std::size_t number = scene.integrator.index();  // users' own GLSL comes after those of the list
  return number < std::size(channels) && channels[number] == 1;
}

std::uint8_t toLevel(float v) { return static_cast<std::uint8_t>((v < 0 ? 0.f : v > 1 ? 1.f : v) * 255.f); }

Pass::Pass(gpu::Device& device, const Scene& scene, const RenderJob& job, const Crop& crop, const CastOptions& options,
           bool radiance, bool others, CastStats& stats)
    : scene_(&scene), job_(job), device_(device), crop_(crop), stats_(stats), radiance_(radiance), others_(others) {
  const Channels& c = job.channels;
  exact_ = options.method == Method::exact;
  const bool custom = needsCustom(scene, radiance);
  surfaces_ = others && exact_ && !custom && (c.normal || c.local || c.position);
  samples_ = radiance ? job.samples : 1;
  Program program;
  program.job = Job::pixels;
  program.method = options.method;
  program.camera = cameraNumber(scene.camera);
  program.hits = others && !exact_ && !custom && (c.normal || c.local || c.position);
  std::string why;
  program.real = chooseReal(device.info(), options, Job::pixels, program.camera, why);
  stats.plan.push_back(why);
  if (radiance && (c.rgb8 || c.radiance)) wanted_ |= c.rgb8 && !c.radiance && samples_ == 1 ? RGB8 : RADIANCE;
  if (others && (c.distance || surfaces_)) wanted_ |= DISTANCE;
  if (others && (c.solid || surfaces_)) wanted_ |= SOLID;
  if (program.hits) wanted_ |= NORMAL * c.normal | LOCAL * c.local | POSITION * c.position;
  levels_ = wanted_ & RGB8;
  if (custom) wanted_ = DISTANCE | SOLID;
  search_ = makeSearch({device, job, options, crop, program, wanted_, samples_, stats}, scene);
  if (custom)
    custom_ = std::make_unique<CustomStage>(
        CustomStage::Job{device, job, options, crop, radiance, levels_, others, samples_, stats}, scene);
  if (surfaces_) stats.plan.push_back("normals, local coordinates, points: in binary128 on the host, as exact asks");
}

void Pass::setScene(const Scene& scene) {
  scene_ = &scene;
  second_.reset();
  search_->setScene(scene);
  if (custom_) custom_->setScene(scene);
}

/// Of a pixel, on the device.
std::size_t Pass::words() const { return custom_ ? CustomStage::hitWords + custom_->colourWords() : wordsOf(wanted_); }

std::size_t Pass::bytesPerRow(int width) const {
  return static_cast<std::size_t>(padded(width, groupWidth)) * (words() * 4 + search_->bytesPerPixel()) + u(width) / 2;
}

void Pass::makeBuffers(int width, int rows) {
  stride_ = padded(width, groupWidth);
  std::size_t pixels = static_cast<std::size_t>(stride_) * u(padded(rows, groupRows));
  const std::size_t own = custom_ ? CustomStage::hitWords : wordsOf(wanted_);
  image_ = device_.makeBuffer(std::max<std::size_t>(16, pixels * own * 4), gpu::BufferUse::readback);
  if (custom_) custom_->makeBuffers(pixels);
  if (exact_) makeDoubts(pixels / 16 + 4096);
}

PassTarget Pass::target(const Band& band) const {
  return {image_, exact_ ? &doubts_ : nullptr, stride_, padded(band.rows, groupRows)};
}

double Pass::dispatchSample(const Band& band, int sample) {
  if (exact_) doubts_.as<std::uint32_t>()[0] = 0;
  return search_->dispatch(target(band), band, sample);
}

void Pass::dispatch(const Band& band) {
  const auto count = static_cast<std::size_t>(samples_) * u(samples_);
  if (doubtful_.size() < count) doubtful_.resize(count);
  for (std::size_t sample = 0; sample < count; ++sample) {
    search_->prepare(target(band), band);
    Stopwatch watch;
    double ms = dispatchSample(band, static_cast<int>(sample));
    if (exact_ && custom_ && doubts_.as<std::uint32_t>()[0] > capacity_) {  // as in run(), but before the stage
      makeDoubts(doubts_.as<std::uint32_t>()[0]);
      ms += dispatchSample(band, static_cast<int>(sample));
    }
    if (exact_ && doubts_.as<std::uint32_t>()[0] <= capacity_)
      doubtful_[sample] = doubtfulPixels(doubts_.as<std::uint32_t>().subspan(2, doubts_.as<std::uint32_t>()[0]), band);
    if (custom_) {
      settleDoubts(band, sample);
      ms += custom_->dispatch(image_, stride_, padded(band.rows, groupRows), band, static_cast<int>(sample));
    }
    if (!warm_) stats_.first_dispatch_ms += watch.ms();
    warm_ = true;
    stats_.dispatch_ms += ms;
    stats_.rays += static_cast<std::uint64_t>(band.width) * u(band.rows);
    if (exact_ && doubts_.as<std::uint32_t>()[0] > capacity_) return;
  }
}

void Pass::run(Band& band) {
  dispatch(band);
  if (exact_ && doubts_.as<std::uint32_t>()[0] > capacity_) {  // more doubt than room: once more, with room
    makeDoubts(doubts_.as<std::uint32_t>()[0]);
    dispatch(band);
  }
  Stopwatch reading;
  read(band);
  stats_.readback_ms += reading.ms();
  Stopwatch finishing;
  if (exact_ && !custom_) secondPass(band);
  if (samples_ > 1) {
    float n = static_cast<float>(samples_ * samples_);
    for (float& v : band.radiance) v /= n;
  }
  if (radiance_ && job_.channels.rgb8 && !levels_) {
    band.rgb8.resize(band.radiance.size());
    std::transform(band.radiance.begin(), band.radiance.end(), band.rgb8.begin(), toLevel);
  }
  if (radiance_ && !job_.channels.radiance) band.radiance.clear();
  if (others_ && !job_.channels.distance) band.distance.clear();
  if (others_ && !job_.channels.solid) band.solid.clear();
  stats_.fallback_ms += finishing.ms();
}

void Pass::makeDoubts(std::size_t capacity) {
  capacity_ = static_cast<std::uint32_t>(capacity);
  doubts_ = device_.makeBuffer(8 + capacity * 4, gpu::BufferUse::readback);
  doubts_.as<std::uint32_t>()[1] = capacity_;
}

/// Pixels of the band, in order, from entries of pixels.comp's Doubts.
std::vector<std::uint32_t> Pass::doubtfulPixels(std::span<const std::uint32_t> entries, const Band& band) const {
  std::vector<std::uint32_t> pixels;
  for (std::uint32_t entry : entries) {
    std::uint32_t first = entry / 256 * 8, y = first / u(stride_), x = first % u(stride_);
    if (y >= u(band.rows)) continue;
    for (std::uint32_t k = 0; k < 8 && x + k < u(band.width); ++k)
      if (entry >> k & 1) pixels.push_back(y * u(band.width) + x + k);
  }
  std::sort(pixels.begin(), pixels.end());
  return pixels;
}

void Pass::read(Band& band) const {
  const int rows = padded(band.rows, groupRows);
  if (custom_) {
    custom_->read(image_, stride_, rows, band);
    return;
  }
  const std::uint32_t* plane = image_.as<std::uint32_t>().data();
  const auto words = static_cast<std::size_t>(stride_) * u(rows);
  const auto channel = [&](std::uint32_t bit, int count, auto& to) {
    if (!(wanted_ & bit)) return;
    readPlanes(plane, words, stride_, count, band, to);
    plane += words * u(count);
  };
  if (wanted_ & RGB8) {
    if (isGrey(*scene_)) readGreys(reinterpret_cast<const std::uint8_t*>(plane), stride_, band, band.rgb8);
    else readLevels(plane, stride_, band, band.rgb8);
    plane += words;
  }
  channel(RADIANCE, 3, band.radiance);
  channel(DISTANCE, 1, band.distance);
  channel(SOLID, 1, band.solid);
  channel(NORMAL, 3, band.normal);
  channel(LOCAL, 3, band.local);
  channel(POSITION, 3, band.position);
}

}  // namespace solidcast
