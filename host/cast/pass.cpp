#include "host/cast/pass.h"

#include <algorithm>
#include <bit>
#include <cstring>

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

std::uint32_t u(int v) { return static_cast<std::uint32_t>(v); }

}  // namespace

std::uint8_t toLevel(float v) { return static_cast<std::uint8_t>((v < 0 ? 0.f : v > 1 ? 1.f : v) * 255.f); }

Pass::Pass(gpu::Device& device, const Scene& scene, const RenderJob& job, const Crop& crop, const CastOptions& options,
           bool radiance, bool others, CastStats& stats)
    : scene_(&scene), job_(job), device_(device), crop_(crop), stats_(stats), radiance_(radiance), others_(others) {
  const Channels& c = job.channels;
  exact_ = options.method == Method::exact;
  surfaces_ = others && exact_ && (c.normal || c.local || c.position);
  samples_ = radiance ? job.samples : 1;
  Program program;
  program.job = Job::pixels;
  program.method = options.method;
  program.camera = cameraNumber(scene.camera);
  program.hits = others && !exact_ && (c.normal || c.local || c.position);
  std::string why;
  program.real = chooseReal(device.info(), options, Job::pixels, program.camera, why);
  stats.plan.push_back(why);
  if (radiance && (c.rgb8 || c.radiance)) wanted_ |= c.rgb8 && !c.radiance && samples_ == 1 ? RGB8 : RADIANCE;
  if (others && (c.distance || surfaces_)) wanted_ |= DISTANCE;
  if (others && (c.solid || surfaces_)) wanted_ |= SOLID;
  if (program.hits) wanted_ |= NORMAL * c.normal | LOCAL * c.local | POSITION * c.position;
  search_ = makeSearch({device, job, options, crop, program, wanted_, samples_, stats}, scene);
  if (surfaces_) stats.plan.push_back("normals, local coordinates, points: in binary128 on the host, as exact asks");
}

void Pass::setScene(const Scene& scene) {
  scene_ = &scene;
  second_.reset();
  search_->setScene(scene);
}

std::size_t Pass::bytesPerRow(int width) const {
  return static_cast<std::size_t>(padded(width, groupWidth)) * (wordsOf(wanted_) * 4 + search_->bytesPerPixel()) +
         u(width) / 2;
}

void Pass::makeBuffers(int width, int rows) {
  stride_ = padded(width, groupWidth);
  std::size_t pixels = static_cast<std::size_t>(stride_) * u(padded(rows, groupRows));
  image_ = device_.makeBuffer(std::max<std::size_t>(16, pixels * wordsOf(wanted_) * 4), gpu::BufferUse::readback);
  if (exact_) makeDoubts(pixels / 16 + 4096);
}

void Pass::dispatch(const Band& band) {
  const auto count = static_cast<std::size_t>(samples_) * u(samples_);
  if (doubtful_.size() < count) doubtful_.resize(count);
  for (std::size_t sample = 0; sample < count; ++sample) {
    if (exact_) doubts_.as<std::uint32_t>()[0] = 0;
    const PassTarget target{image_, exact_ ? &doubts_ : nullptr, stride_, padded(band.rows, groupRows)};
    search_->prepare(target, band);
    Stopwatch watch;
    double ms = search_->dispatch(target, band, static_cast<int>(sample));
    if (!warm_) stats_.first_dispatch_ms += watch.ms();
    warm_ = true;
    stats_.dispatch_ms += ms;
    stats_.rays += static_cast<std::uint64_t>(band.width) * u(band.rows);
    if (!exact_) continue;
    auto doubts = doubts_.as<std::uint32_t>();
    if (doubts[0] > capacity_) return;
    doubtful_[sample] = doubtfulPixels(doubts.subspan(2, doubts[0]), band);
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
  if (exact_) secondPass(band);
  if (samples_ > 1) {
    float n = static_cast<float>(samples_ * samples_);
    for (float& v : band.radiance) v /= n;
  }
  if (radiance_ && job_.channels.rgb8 && !(wanted_ & RGB8)) {
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

template <class T>
void Pass::readPlanes(const std::uint32_t*& plane, int count, const Band& band, std::vector<T>& to) const {
  const auto words = static_cast<std::size_t>(stride_) * u(padded(band.rows, groupRows));
  to.resize(static_cast<std::size_t>(band.width) * u(band.rows) * u(count));
  for (int c = 0; c < count; ++c, plane += words)
    for (int y = 0; y < band.rows; ++y) {
      const std::uint32_t* row = plane + static_cast<std::size_t>(y) * u(stride_);
      T* out = to.data() + (static_cast<std::size_t>(y) * u(band.width)) * u(count) + c;
      for (int x = 0; x < band.width; ++x) out[static_cast<std::size_t>(x) * u(count)] = std::bit_cast<T>(row[x]);
    }
}

void Pass::read(Band& band) const {
  const std::uint32_t* plane = image_.as<std::uint32_t>().data();
  if (wanted_ & RGB8) {
    band.rgb8.resize(static_cast<std::size_t>(band.width) * u(band.rows) * 3);
    std::uint8_t *out = band.rgb8.data(), *const last = out + band.rgb8.size() - 3;
    for (int y = 0; y < band.rows; ++y) {
      const std::uint32_t* row = plane + static_cast<std::size_t>(y) * u(stride_);
      // Four bytes at a time; the fourth is where the next pixel begins. Three stores a pixel take three times as long.
      for (int x = 0; x < band.width; ++x, out += 3) std::memcpy(out, row + x, out == last ? 3 : 4);
    }
    plane += static_cast<std::size_t>(stride_) * u(padded(band.rows, groupRows));
  }
  if (wanted_ & RADIANCE) readPlanes(plane, 3, band, band.radiance);
  if (wanted_ & DISTANCE) readPlanes(plane, 1, band, band.distance);
  if (wanted_ & SOLID) readPlanes(plane, 1, band, band.solid);
  if (wanted_ & NORMAL) readPlanes(plane, 3, band, band.normal);
  if (wanted_ & LOCAL) readPlanes(plane, 3, band, band.local);
  if (wanted_ & POSITION) readPlanes(plane, 3, band, band.position);
}

}  // namespace solidcast
