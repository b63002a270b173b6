// Inside of host/image: one decoder a format, over a file's whole content. All throw Error(Exit::usage).
#pragma once
#include <cstdint>
#include <span>
#include <string>

#include "host/image/reader.h"

namespace solidcast {

using Content = std::span<const std::uint8_t>;

Image decodePng(Content content, const std::string& name);
Image decodePfm(Content content, const std::string& name);
Image decodeHdr(Content content, const std::string& name);

[[noreturn]] void badImage(const std::string& name, const std::string& what);

/// Refuses sizes below 1 and beyond kMostPixels, before any memory is asked for.
void checkImageSize(std::int64_t width, std::int64_t height, const std::string& name);

}  // namespace solidcast
