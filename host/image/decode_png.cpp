// PNG by libspng: every bit depth and colour type. Checksums are verified, so a damaged file is refused.
#include <spng.h>

#include <cstring>
#include <memory>

#include "host/image/decoders.h"

namespace solidcast {
namespace {

using Context = std::unique_ptr<spng_ctx, void (*)(spng_ctx*)>;

void check(int status, const std::string& name) {
  if (status != SPNG_OK) badImage(name, std::string("not a readable PNG: ") + spng_strerror(status));
}

std::vector<std::uint8_t> decode(spng_ctx* context, spng_format format, const std::string& name) {
  std::size_t bytes = 0;
  check(spng_decoded_image_size(context, format, &bytes), name);
  std::vector<std::uint8_t> out(bytes);
  check(spng_decode_image(context, out.data(), out.size(), format, SPNG_DECODE_TRNS), name);
  check(spng_decode_chunks(context), name);  // what follows the pixels must be whole, too
  return out;
}

/// 16 bits of RGBA to floats, without the fourth where every pixel is opaque by its colour type.
std::vector<float> asFloats(const std::vector<std::uint8_t>& bytes, bool alpha) {
  std::vector<float> out;
  out.reserve(bytes.size() / 8 * (alpha ? 4 : 3));
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    if (!alpha && i % 8 == 6) continue;
    std::uint16_t value;
    std::memcpy(&value, &bytes[i], 2);  // the host's byte order
    out.push_back(static_cast<float>(value) / 65535.0f);
  }
  return out;
}

}  // namespace

Image decodePng(Content content, const std::string& name) {
  const Context context(spng_ctx_new(0), spng_ctx_free);
  if (!context) throw std::bad_alloc();
  check(spng_set_png_buffer(context.get(), content.data(), content.size()), name);
  constexpr std::size_t kMostChunkBytes = std::size_t{64} << 20;  // of text and the like
  check(spng_set_chunk_limits(context.get(), kMostChunkBytes, kMostChunkBytes), name);
  spng_ihdr header{};
  check(spng_get_ihdr(context.get(), &header), name);
  checkImageSize(header.width, header.height, name);

  spng_trns transparent{};
  const bool alpha = (header.color_type & 4) != 0 || spng_get_trns(context.get(), &transparent) == SPNG_OK;
  Image image{static_cast<int>(header.width), static_cast<int>(header.height), alpha ? 4 : 3, {}};
  if (header.bit_depth == 16) image.values = asFloats(decode(context.get(), SPNG_FMT_RGBA16, name), alpha);
  else image.values = decode(context.get(), alpha ? SPNG_FMT_RGBA8 : SPNG_FMT_RGB8, name);
  return image;
}

}  // namespace solidcast
