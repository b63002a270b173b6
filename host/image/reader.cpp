#include "host/image/reader.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <string_view>

#include "host/error.h"
#include "host/image/decoders.h"
#include "host/image/output_file.h"

namespace solidcast {
namespace {

/// Twice what the largest image takes uncompressed.
constexpr std::size_t kMostFileBytes = std::size_t{24} * kMostPixels;

std::vector<std::uint8_t> readFile(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) badImage(path, systemMessage(errno));
  struct stat status {};
  if (::fstat(::fileno(file.get()), &status) != 0) badImage(path, systemMessage(errno));
  if (S_ISDIR(status.st_mode)) badImage(path, "is a folder, expected an image file");
  std::vector<std::uint8_t> content(S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0);
  if (content.size() > kMostFileBytes) badImage(path, "larger than any image that can be compared");
  content.resize(std::fread(content.data(), 1, content.size(), file.get()));
  // Pipes tell no size, and a file may grow: read on until the end.
  for (std::uint8_t block[65536]; content.size() <= kMostFileBytes;) {
    const std::size_t got = std::fread(block, 1, sizeof block, file.get());
    if (got == 0) break;
    content.insert(content.end(), block, block + got);
  }
  if (std::ferror(file.get())) badImage(path, systemMessage(errno));
  return content;
}

bool startsWith(Content content, std::string_view start) {
  return content.size() >= start.size() &&
         std::string_view(reinterpret_cast<const char*>(content.data()), start.size()) == start;
}

}  // namespace

void badImage(const std::string& name, const std::string& what) { throw Error(Exit::usage, name + ": " + what); }

void checkImageSize(std::int64_t width, std::int64_t height, const std::string& name) {
  if (width >= 1 && height >= 1 && width <= kMostPixels / height) return;
  badImage(name, "image size " + std::to_string(width) + "x" + std::to_string(height) +
                     " is out of range, expected 1 to " + std::to_string(kMostPixels) + " pixels");
}

Image decodeImage(const std::vector<std::uint8_t>& content, const std::string& name) {
  if (content.empty()) badImage(name, "is empty, expected a PNG, PFM or Radiance HDR image");
  if (startsWith(content, "\x89PNG")) return decodePng(content, name);
  if (startsWith(content, "PF") || startsWith(content, "Pf")) return decodePfm(content, name);
  if (startsWith(content, "#?")) return decodeHdr(content, name);
  badImage(name, "unknown kind of file, expected a PNG, PFM or Radiance HDR image");
}

Image readImage(const std::string& path) { return decodeImage(readFile(path), path); }

}  // namespace solidcast
