// PNG files: every size comes back, and one picture is always the same bytes.
#include <pthread.h>
#include <sys/mman.h>

#include <set>

#include "host/image/encoders.h"
#include "tests/image/helpers.h"

namespace solidcast {
namespace {

using namespace testing;

const std::vector<std::uint8_t>& levels(const Image& image) { return std::get<0>(image.values); }

TEST(Png, RoundTripsManySizes) {
  const Folder folder;
  for (const auto& [width, height] :
       std::vector<std::pair<int, int>>{{1, 1}, {3, 2}, {640, 480}, {1, 5000}, {90000, 7}}) {
    const Band band = randomBand(width, height);
    writeWhole(folder / "a.png", band);
    const Image image = readImage(folder / "a.png");
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(levels(image), band.rgb8);
  }
}

TEST(Png, NoiseRoundTripsThoughItGrows) {
  const Folder folder;
  std::mt19937 random(3);
  Band band = randomBand(700, 700);
  for (std::uint8_t& byte : band.rgb8) byte = static_cast<std::uint8_t>(random());
  writeWhole(folder / "a.PNG", band);
  EXPECT_EQ(levels(readImage(folder / "a.PNG")), band.rgb8);
}

// ISA-L by itself makes other bytes of it at one of 2,048 addresses (bits 16 to 47) of its stream, which lies on the stack.
TEST(Png, BytesDoNotDependOnWhereTheStackLies) {
  constexpr std::size_t kStack = std::size_t{1} << 20, kStep = std::size_t{1} << 16, kAddresses = 4096;
  constexpr std::size_t kRoom = kStack + kAddresses * kStep;
  char* room = static_cast<char*>(
      mmap(nullptr, kRoom, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0));
  ASSERT_NE(room, MAP_FAILED);
  const auto encode = [](void* to) -> void* {
    const std::vector<std::uint8_t> black(3 * 8 * 40);
    const ByteSink sink = [to](const void* bytes, std::size_t count) {
      static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), count);
    };
    const std::unique_ptr<RowEncoder> encoder = makePngEncoder(sink, 8, 40);
    encoder->rows(black.data(), 40);
    encoder->finish();
    return nullptr;
  };
  std::set<std::string> files;
  for (std::size_t i = 0; i < kAddresses; ++i) {
    pthread_attr_t attributes;
    pthread_t thread;
    std::string file;
    ASSERT_EQ(pthread_attr_init(&attributes), 0);
    ASSERT_EQ(pthread_attr_setstack(&attributes, room + i * kStep, kStack), 0);
    ASSERT_EQ(pthread_create(&thread, &attributes, encode, &file), 0);
    ASSERT_EQ(pthread_join(thread, nullptr), 0);
    pthread_attr_destroy(&attributes);
    madvise(room + i * kStep, kStack, MADV_DONTNEED);
    files.insert(file);
  }
  munmap(room, kRoom);
  EXPECT_EQ(files.size(), 1u);
}

}  // namespace
}  // namespace solidcast
