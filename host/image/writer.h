// Image files written while the image is still being made: bands go in from the top down, memory stays bounded.
//
// | kind               | .png (8 bit, a picture to look at)             | .pfm (float32, for comparing) | .hdr (RGBE)  |
// |--------------------|------------------------------------------------|-------------------------------|--------------|
// | radiance           | Band::rgb8                                     | 3 channels                    | 3 channels   |
// | distance           | t / (1 + t): near is dark, a miss is white     | 1 channel, a miss is +inf     | refused      |
// | solid              | a colour for each index, a miss is black       | 1 channel, a miss is -1       | refused      |
// | normal             | n / 2 + 1/2, a miss is mid grey                | 3 channels                    | refused      |
// | local              | weights in [0,1] as they are, else x - floor x | 3 channels                    | refused      |
// | position           | 1/2 + p / (2 (1 + |p|)) by component           | 3 channels                    | refused      |
//
// RGBE holds neither negative numbers nor infinity, so it takes radiance only (NaN and negatives become 0).
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/image/band.h"

namespace solidcast {

enum class ImageFormat { png, pfm, hdr };
enum class ImageKind { radiance, distance, solid, normal, local, position };

/// By the ending, in any case of letters. "-" (standard output) has none: `PNG`. Throws Error(Exit::usage) naming
/// the known endings.
ImageFormat imageFormat(const std::string& path);

/// "png", "pfm" or "hdr". Throws Error(Exit::usage).
ImageFormat imageFormatByName(std::string_view name);

/// "distance", "normal", ... as `--aov` takes them (not radiance). Throws Error(Exit::usage) naming the known ones.
ImageKind imageKindByName(std::string_view name);
const char* imageKindName(ImageKind kind);

/// "out.pfm", normal -> "out.normal.pfm". Throws Error(Exit::usage) for "-": standard output holds one image.
std::string imagePathFor(const std::string& path, ImageKind kind);

/// Asks for the channel of a Band that a file of this format and kind is made of.
void addChannel(Channels& channels, ImageFormat format, ImageKind kind);

/// A PNG in memory, of 3 bytes a pixel: for what is shown and not kept.
std::string pngOf(const std::vector<std::uint8_t>& rgb8, int width, int height);

class ImageWriter {
 public:
  /// Opens at once, so that a bad path fails before the image is made: Error(Exit::output), or Error(Exit::usage) for a
  /// format that can't hold this kind or size. `path` "-" is standard output. Without `format` the ending decides.
  ImageWriter(const std::string& path, int width, int height, ImageKind kind = ImageKind::radiance,
              std::optional<ImageFormat> format = std::nullopt);
  ImageWriter(ImageWriter&&) noexcept;
  ~ImageWriter();  // without finish(): nothing stays, an existing file is untouched

  /// The next rows. Reads only the channel that addChannel() names; the other vectors may be empty.
  /// Throws Error(Exit::output) when they can't be written, std::logic_error when the band isn't the next one.
  void rows(const Band& band);

  /// After the last row. The file appears under its name now.
  void finish();

  double encodeMilliseconds() const;  // in rows() and finish(), without the writing
  double writeMilliseconds() const;   // in system calls

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace solidcast
