// Readers: what other programs may write is read, and nothing that is damaged gets through or crashes.
#include "host/image/reader.h"

#include <spng.h>

#include <cstring>
#include <memory>

#include "tests/image/helpers.h"

namespace solidcast {
namespace {

using namespace testing;
using Bytes = std::vector<std::uint8_t>;

Bytes text(const std::string& start, const Bytes& rest = {}) {
  Bytes bytes(start.begin(), start.end());
  bytes.insert(bytes.end(), rest.begin(), rest.end());
  return bytes;
}

Bytes floatBytes(const std::vector<float>& values, bool swap = false) {
  Bytes bytes(values.size() * 4);
  std::memcpy(bytes.data(), values.data(), bytes.size());
  for (std::size_t i = 0; swap && i < bytes.size(); i += 4) {
    std::swap(bytes[i], bytes[i + 3]);
    std::swap(bytes[i + 1], bytes[i + 2]);
  }
  return bytes;
}

/// A PNG of any kind; `pixels` in the file's own layout (16 bits in the host's byte order).
Bytes png(std::uint32_t width, std::uint32_t height, int bits, int colourType, Bytes pixels,
          const std::vector<spng_plte_entry>& palette = {}) {
  const std::unique_ptr<spng_ctx, void (*)(spng_ctx*)> context(spng_ctx_new(SPNG_CTX_ENCODER), spng_ctx_free);
  spng_set_option(context.get(), SPNG_ENCODE_TO_BUFFER, 1);
  spng_ihdr header{};
  header.width = width;
  header.height = height;
  header.bit_depth = static_cast<std::uint8_t>(bits);
  header.color_type = static_cast<std::uint8_t>(colourType);
  spng_set_ihdr(context.get(), &header);
  spng_plte entries{};
  for (const spng_plte_entry& entry : palette) entries.entries[entries.n_entries++] = entry;
  if (!palette.empty()) spng_set_plte(context.get(), &entries);
  EXPECT_EQ(spng_encode_image(context.get(), pixels.data(), pixels.size(), SPNG_FMT_PNG, SPNG_ENCODE_FINALIZE), 0);
  std::size_t size = 0;
  int error = 0;
  const std::unique_ptr<void, void (*)(void*)> data(spng_get_png_buffer(context.get(), &size, &error), std::free);
  const auto* first = static_cast<const std::uint8_t*>(data.get());
  return {first, first + size};
}

Bytes levels(const Bytes& file) { return std::get<0>(decodeImage(file, "x").values); }
std::vector<float> floats(const Bytes& file) { return std::get<1>(decodeImage(file, "x").values); }

TEST(ReadPng, EveryColourType) {
  EXPECT_EQ(levels(png(2, 1, 8, SPNG_COLOR_TYPE_GRAYSCALE, {7, 200})), (Bytes{7, 7, 7, 200, 200, 200}));
  EXPECT_EQ(levels(png(2, 1, 1, SPNG_COLOR_TYPE_GRAYSCALE, {0x40})), (Bytes{0, 0, 0, 255, 255, 255}));
  EXPECT_EQ(levels(png(1, 2, 8, SPNG_COLOR_TYPE_TRUECOLOR, {1, 2, 3, 4, 5, 6})), (Bytes{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(levels(png(2, 1, 8, SPNG_COLOR_TYPE_INDEXED, {1, 0}, {{9, 8, 7, 255}, {1, 2, 3, 255}})),
            (Bytes{1, 2, 3, 9, 8, 7}));
  const Bytes transparent = png(1, 1, 8, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, {1, 2, 3, 4});
  EXPECT_EQ(levels(transparent), (Bytes{1, 2, 3, 4}));
  EXPECT_EQ(decodeImage(transparent, "x").channels, 4);
}

TEST(ReadPng, SixteenBitsBecomeFloats) {
  const std::uint16_t values[] = {0, 65535, 257, 1, 32768, 255};
  Bytes raw(sizeof values);
  std::memcpy(raw.data(), values, sizeof values);
  const std::vector<float> read = floats(png(2, 1, 16, SPNG_COLOR_TYPE_TRUECOLOR, raw));
  ASSERT_EQ(read.size(), 6u);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(read[i], static_cast<float>(values[i]) / 65535.0f);
  EXPECT_EQ(decodeImage(png(1, 1, 16, SPNG_COLOR_TYPE_GRAYSCALE_ALPHA, Bytes(4)), "x").channels, 4);
}

TEST(ReadPfm, BothByteOrdersAndChannelCounts) {
  const std::vector<float> values{1, -2.5f, std::numeric_limits<float>::infinity(), 4, 5, 6};
  EXPECT_EQ(floats(text("PF\n2 1\n-1.0\n", floatBytes(values))), values);
  EXPECT_EQ(floats(text("PF\n2 1\n1.0\n", floatBytes(values, true))), values);
  EXPECT_EQ(floats(text("PF 2 1 -3.5e0\r", floatBytes(values))), values);
  const std::vector<float> turned{4, 5, 6, 1, -2.5f, std::numeric_limits<float>::infinity()};
  const Image grey = decodeImage(text("Pf\n3 2\n-1\n", floatBytes(values)), "x");
  EXPECT_EQ(std::get<1>(grey.values), turned);
  EXPECT_EQ(grey.channels, 1);
}

TEST(ReadHdr, PlainAndOldRunLengths) {
  const std::string header = "#?RGBE\n# a comment\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=1\n\n-Y 1 +X 4\n";
  const Bytes plain{128, 64, 0, 129, 0, 0, 0, 0, 255, 255, 255, 128, 128, 128, 128, 130};
  EXPECT_EQ(floats(text(header, plain)),
            (std::vector<float>{1, 0.5f, 0, 0, 0, 0, 0.99609375f, 0.99609375f, 0.99609375f, 2, 2, 2}));
  const Bytes run{128, 64, 0, 129, 1, 1, 1, 3};
  EXPECT_EQ(floats(text(header, run)), (std::vector<float>{1, 0.5f, 0, 1, 0.5f, 0, 1, 0.5f, 0, 1, 0.5f, 0}));
}

TEST(BadImages, AreRefusedWithOneLineThatNamesTheFile) {
  const Folder folder;
  const Bytes goodPng = png(3, 3, 8, SPNG_COLOR_TYPE_TRUECOLOR, Bytes(27, 5));
  const std::string hdr = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
  const std::vector<std::pair<Bytes, std::string>> cases{
      {{}, "empty"},
      {text("hello"), "unknown kind"},
      {text("GIF89a"), "unknown kind"},
      {Bytes(goodPng.begin(), goodPng.end() - 30), "not a readable PNG"},
      {Bytes(goodPng.begin(), goodPng.begin() + 20), "not a readable PNG"},
      {text("PF"), "width"},
      {text("PFM\n1 1\n-1\n", Bytes(12)), "PF or Pf"},
      {text("PF\n1 1\n-1\n", Bytes(11)), "expected 12"},
      {text("PF\n1 1\n-1\n", Bytes(13)), "expected 12"},
      {text("PF\n0 1\n-1\n"), "out of range"},
      {text("PF\n-1 1\n-1\n"), "out of range"},
      {text("PF\n1000000000 1000000000\n-1\n"), "out of range"},
      {text("PF\n9223372036854775807 9223372036854775807\n-1\n"), "out of range"},
      {text("PF\n99999999999999999999 1\n-1\n"), "width"},
      {text("PF\n1 x\n-1\n"), "height"},
      {text("PF\n1 1\n0\n", Bytes(12)), "scale"},
      {text("PF\n1 1\nnan\n", Bytes(12)), "scale"},
      {text("PF\n1 1\ninf\n", Bytes(12)), "scale"},
      {text("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n", Bytes(4)), "format"},
      {text("#?RADIANCE"), "header"},
      {text(hdr + "+Y 1 +X 1\n", Bytes(4)), "order"},
      {text(hdr + "-Y 1 +X 1\n", Bytes(3)), "cut short"},
      {text(hdr + "-Y 1 +X 1\n", Bytes(5)), "after its last"},
      {text(hdr + "-Y 1 +X 2\n", {1, 1, 1, 2}), "damaged"},              // repeats before the first pixel
      {text(hdr + "-Y 1 +X 2\n", {5, 5, 5, 5, 1, 1, 1, 2}), "damaged"},  // repeats beyond the row
      {text(hdr + "-Y 1 +X 8\n", {2, 2, 0, 9}), "damaged"},              // another width than the header's
      {text(hdr + "-Y 1 +X 8\n", {2, 2, 0, 8, 0, 136, 1, 136, 1, 136, 1, 136, 1}), "damaged"},  // a run of nothing
      {text(hdr + "-Y 1 +X 8\n", {2, 2, 0, 8, 200, 1}), "damaged"}};                            // a run beyond the row
  for (const auto& [content, expected] : cases) {
    writeBytes(folder / "a.img", content);
    const std::string line = errorOf(Exit::usage, [&] { readImage(folder / "a.img"); });
    EXPECT_EQ(line.find(folder / "a.img"), 0u) << line;
    EXPECT_TRUE(contains(line, expected)) << line << " lacks " << expected;
  }
}

TEST(BadImages, MissingFileAndFolder) {
  const Folder folder;
  EXPECT_TRUE(contains(errorOf(Exit::usage, [&] { readImage(folder / "none.png"); }), "No such file"));
  EXPECT_TRUE(contains(errorOf(Exit::usage, [&] { readImage(folder / ""); }), "folder"));
}

TEST(BadImages, APngThatClaimsToBeHugeIsRefusedBeforeMemoryIsAskedFor) {
  Bytes file = png(3, 3, 8, SPNG_COLOR_TYPE_TRUECOLOR, Bytes(27, 5));
  // Width at byte 16 and height at byte 20 become 2^30; the header's checksum is made to fit.
  file[16] = file[20] = 0x40;
  file[19] = file[23] = 0;
  std::uint32_t checksum = 0xffffffff;
  for (std::size_t i = 12; i < 29; ++i) {
    checksum ^= file[i];
    for (int bit = 0; bit < 8; ++bit) checksum = (checksum >> 1) ^ ((checksum & 1) ? 0xedb88320u : 0);
  }
  for (int i = 0; i < 4; ++i) file[29 + i] = static_cast<std::uint8_t>(~checksum >> (24 - 8 * i));
  EXPECT_TRUE(contains(errorOf(Exit::usage, [&] { decodeImage(file, "x"); }), "1073741824x1073741824"));
}

/// Flips, cuts and doubles bytes. Whatever comes of it: an image of the size it claims, or one line.
void expectToSurviveDamage(const Bytes& good, unsigned seed) {
  std::mt19937 random(seed);
  int refused = 0;
  for (int i = 0; i < 1500; ++i) {
    Bytes bad = good;
    const std::size_t changes = 1 + random() % 4;
    for (std::size_t k = 0; k < changes && !bad.empty(); ++k) {
      const std::size_t at = random() % bad.size();
      switch (random() % 4) {
        case 0:
          bad[at] = static_cast<std::uint8_t>(random());
          break;
        case 1:
          bad[at] ^= static_cast<std::uint8_t>(1u << random() % 8);
          break;
        case 2:
          bad.resize(at);
          break;
        default:
          bad.insert(bad.begin() + static_cast<std::ptrdiff_t>(at), bad[at]);
      }
    }
    try {
      const Image image = decodeImage(bad, "x");
      const std::size_t numbers = std::visit([](const auto& values) { return values.size(); }, image.values);
      ASSERT_EQ(numbers, std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels));
    } catch (const Error& error) {
      ++refused;
      ASSERT_EQ(error.code(), Exit::usage);
      ASSERT_FALSE(contains(error.what(), "\n")) << error.what();
    }
  }
  EXPECT_GT(refused, 150);
}

TEST(BadImages, RandomDamageNeverCrashes) {
  const Folder folder;
  const Band band = randomBand(23, 11);
  for (const char* name : {"a.png", "a.pfm", "a.hdr"}) {
    writeWhole(folder / name, band);
    expectToSurviveDamage(bytesOf(folder / name), 5);
  }
  expectToSurviveDamage(png(9, 5, 16, SPNG_COLOR_TYPE_TRUECOLOR_ALPHA, Bytes(360, 3)), 6);
  expectToSurviveDamage(png(2, 1, 8, SPNG_COLOR_TYPE_INDEXED, {1, 0}, {{9, 8, 7, 255}, {1, 2, 3, 255}}), 7);
}

}  // namespace
}  // namespace solidcast
