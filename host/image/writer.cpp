#include "host/image/writer.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <stdexcept>

#include "host/error.h"
#include "host/image/encoders.h"
#include "host/image/output_file.h"
#include "host/image/picture.h"

namespace solidcast {
namespace {

constexpr std::array<const char*, 3> kFormatNames{"png", "pfm", "hdr"};  // in the order of the enumeration
constexpr std::array<const char*, 6> kKindNames{"radiance", "distance", "solid", "normal", "local", "position"};
constexpr std::int64_t kMostRowBytes = std::int64_t{1} << 30;

std::unique_ptr<RowEncoder> makeEncoder(ImageFormat format, OutputFile& file, int width, int height, ImageKind kind) {
  const int channels = kind == ImageKind::distance || kind == ImageKind::solid ? 1 : 3;
  switch (format) {
    case ImageFormat::png:
      return makePngEncoder([&file](const void* bytes, std::size_t count) { file.append(bytes, count); }, width,
                            height);
    case ImageFormat::pfm:
      return makePfmEncoder(file, width, height, channels);
    case ImageFormat::hdr:
      return makeHdrEncoder(file, width, height);
  }
  throw std::logic_error("unknown image format");
}

std::vector<float> asFloats(const std::vector<std::int32_t>& solids) { return {solids.begin(), solids.end()}; }

const std::vector<float>& floatChannel(const Band& band, ImageKind kind) {
  switch (kind) {
    case ImageKind::distance:
      return band.distance;
    case ImageKind::normal:
      return band.normal;
    case ImageKind::local:
      return band.local;
    case ImageKind::position:
      return band.position;
    default:
      return band.radiance;
  }
}

/// The arguments are checked before a file is touched.
ImageFormat checkedFormat(const std::string& path, int width, int height, ImageKind kind,
                          std::optional<ImageFormat> given) {
  const ImageFormat format = given ? *given : imageFormat(path);
  if (format == ImageFormat::hdr && kind != ImageKind::radiance)
    throw Error(Exit::usage, path + ": Radiance HDR holds neither negative numbers nor infinity, so no " +
                                 imageKindName(kind) + " image; use .pfm or .png");
  if (width < 1 || height < 1 || 12LL * width > kMostRowBytes)
    throw Error(Exit::usage, path + ": image size " + std::to_string(width) + "x" + std::to_string(height) +
                                 " is out of range, expected 1 to " + std::to_string(kMostRowBytes / 12) +
                                 " columns and at least 1 row");
  return format;
}

}  // namespace

ImageFormat imageFormat(const std::string& path) {
  if (path == "-") return ImageFormat::png;
  std::string ending = std::filesystem::path(path).extension().string();
  for (char& letter : ending)
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  for (std::size_t i = 0; i < kFormatNames.size(); ++i)
    if (ending == std::string(".") + kFormatNames[i]) return static_cast<ImageFormat>(i);
  throw Error(Exit::usage, path + ": " + (ending.empty() ? "no ending" : "unknown ending '" + ending + "'") +
                               ", expected .png, .pfm or .hdr");
}

ImageFormat imageFormatByName(std::string_view name) {
  for (std::size_t i = 0; i < kFormatNames.size(); ++i)
    if (name == kFormatNames[i]) return static_cast<ImageFormat>(i);
  throw Error(Exit::usage, "unknown image format '" + std::string(name) + "', expected png, pfm or hdr");
}

ImageKind imageKindByName(std::string_view name) {
  for (std::size_t i = 1; i < kKindNames.size(); ++i)
    if (name == kKindNames[i]) return static_cast<ImageKind>(i);
  throw Error(Exit::usage,
              "unknown channel '" + std::string(name) + "', expected distance, solid, normal, local or position");
}

const char* imageKindName(ImageKind kind) { return kKindNames.at(static_cast<std::size_t>(kind)); }

std::string imagePathFor(const std::string& path, ImageKind kind) {
  if (path == "-") throw Error(Exit::usage, "standard output holds one image; further channels need -o FILE");
  const std::filesystem::path given(path);
  const std::string name = given.stem().string() + "." + imageKindName(kind) + given.extension().string();
  return (given.parent_path() / name).string();
}

void addChannel(Channels& channels, ImageFormat format, ImageKind kind) {
  switch (kind) {
    case ImageKind::radiance:
      (format == ImageFormat::png ? channels.rgb8 : channels.radiance) = true;
      return;
    case ImageKind::distance:
      channels.distance = true;
      return;
    case ImageKind::solid:
      channels.solid = true;
      return;
    case ImageKind::normal:
      channels.normal = true;
      return;
    case ImageKind::local:
      channels.local = true;
      return;
    case ImageKind::position:
      channels.position = true;
      return;
  }
}

struct ImageWriter::Impl {
  Impl(const std::string& path, ImageFormat format, int width, int height, ImageKind kind)
      : file(path, format == ImageFormat::pfm),
        format(format),
        kind(kind),
        width(width),
        height(height),
        encoder(makeEncoder(format, file, width, height, kind)) {}

  /// `values` must be `perPixel` for each pixel of the band.
  template <class T>
  void encode(const std::vector<T>& values, const Band& band, std::size_t perPixel) {
    if (values.size() != perPixel * static_cast<std::size_t>(band.width) * static_cast<std::size_t>(band.rows))
      throw std::logic_error("a band lacks the channel of its image file");
    encoder->rows(values.data(), band.rows);
  }

  void encode(const Band& band) {
    const std::size_t channels = kind == ImageKind::distance || kind == ImageKind::solid ? 1 : 3;
    if (format == ImageFormat::png && kind == ImageKind::radiance) return encode(band.rgb8, band, 3);
    if (format == ImageFormat::png) return encode(picture(band, kind), band, 3);
    if (kind == ImageKind::solid) return encode(asFloats(band.solid), band, 1);
    encode(floatChannel(band, kind), band, channels);
  }

  template <class Work>
  void timed(Work work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    milliseconds += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  }

  OutputFile file;
  ImageFormat format;
  ImageKind kind;
  int width, height, nextRow = 0;
  double milliseconds = 0;  // encoding and writing
  std::unique_ptr<RowEncoder> encoder;
};

ImageWriter::ImageWriter(const std::string& path, int width, int height, ImageKind kind,
                         std::optional<ImageFormat> format)
    : impl_(std::make_unique<Impl>(path, checkedFormat(path, width, height, kind, format), width, height, kind)) {}
ImageWriter::ImageWriter(ImageWriter&&) noexcept = default;
ImageWriter::~ImageWriter() = default;

void ImageWriter::rows(const Band& band) {
  if (band.width != impl_->width || band.firstRow != impl_->nextRow || band.rows > impl_->height - impl_->nextRow)
    throw std::logic_error("bands must come from the top down and be as wide as the image");
  impl_->timed([&] { impl_->encode(band); });
  impl_->nextRow += band.rows;
}

void ImageWriter::finish() {
  if (impl_->nextRow != impl_->height) throw std::logic_error("an image is finished before its last row");
  impl_->timed([&] {
    impl_->encoder->finish();
    impl_->file.finish();
  });
}

double ImageWriter::encodeMilliseconds() const { return impl_->milliseconds - writeMilliseconds(); }
double ImageWriter::writeMilliseconds() const { return impl_->file.milliseconds(); }

}  // namespace solidcast
