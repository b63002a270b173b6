// Files: what goes in comes out, however it is cut into bands, and a failure leaves nothing.
#include "host/image/writer.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <functional>
#include <stdexcept>

#include "tests/image/helpers.h"

namespace solidcast {
namespace {

using namespace testing;

const std::vector<float>& floats(const Image& image) { return std::get<1>(image.values); }

void expectSameBits(const std::vector<float>& a, const std::vector<float>& b) {
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0);
}

TEST(Pfm, KeepsEveryBitOfEveryKind) {
  const Folder folder;
  Band band = randomBand(37, 19);
  band.radiance[5] = std::numeric_limits<float>::quiet_NaN();
  band.radiance[6] = -0.0f;
  band.radiance[7] = 1e-42f;
  const auto read = [&](ImageKind kind) {
    writeWhole(folder / "a.pfm", band, kind);
    return readImage(folder / "a.pfm");
  };
  expectSameBits(floats(read(ImageKind::radiance)), band.radiance);
  expectSameBits(floats(read(ImageKind::normal)), band.normal);
  expectSameBits(floats(read(ImageKind::local)), band.local);
  expectSameBits(floats(read(ImageKind::position)), band.position);
  expectSameBits(floats(read(ImageKind::distance)), band.distance);
  expectSameBits(floats(read(ImageKind::solid)), {band.solid.begin(), band.solid.end()});
  EXPECT_EQ(read(ImageKind::distance).channels, 1);
  EXPECT_EQ(read(ImageKind::normal).channels, 3);
}

TEST(Pfm, BottomRowComesFirst) {
  const Folder folder;
  Band band;
  band.rows = 2;
  band.width = 1;
  band.distance = {1.0f, 2.0f};
  writeWhole(folder / "a.pfm", band, ImageKind::distance);
  const auto bytes = bytesOf(folder / "a.pfm");
  const std::string header = "Pf\n1 2\n-1.0\n";
  ASSERT_EQ(bytes.size(), header.size() + 8);
  EXPECT_EQ(std::string(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(header.size())), header);
  float first;
  std::memcpy(&first, &bytes[header.size()], 4);
  EXPECT_EQ(first, 2.0f);
}

TEST(Hdr, RoundTripsWithinHalfAMantissaStep) {
  const Folder folder;
  for (const int width : {1, 7, 8, 129, 1000, 32767, 32768}) {
    Band band = randomBand(width, 3);
    for (std::size_t i = 0; i < band.radiance.size(); i += 5) band.radiance[i] = 0.25f;  // runs
    for (std::size_t i = band.radiance.size() / 2; i < band.radiance.size(); ++i) band.radiance[i] = 0.75f;
    band.radiance[0] = 1e30f;
    band.radiance[1] = 3e29f;
    writeWhole(folder / "a.hdr", band);
    const Image image = readImage(folder / "a.hdr");
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(floats(image).size(), band.radiance.size());
    for (std::size_t i = 0; i < band.radiance.size(); ++i) {
      const std::size_t first = i / 3 * 3;
      const float largest = std::max({band.radiance[first], band.radiance[first + 1], band.radiance[first + 2]});
      ASSERT_NEAR(floats(image)[i], band.radiance[i], largest / 254) << width << " " << i;
    }
  }
}

TEST(Hdr, OddNumbersAreClampedAndMantissasCarry) {
  const Folder folder;
  Band band;
  band.rows = 1;
  band.width = 5;
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  band.radiance = {-1, nan, 0.5f, inf, 0, 0, 0.9999f, 0, 0, 0, 0, 0, 1e-44f, 0, 0};
  writeWhole(folder / "a.hdr", band);
  const std::vector<float> read = floats(readImage(folder / "a.hdr"));
  EXPECT_EQ(read[0], 0);
  EXPECT_EQ(read[1], 0);
  EXPECT_EQ(read[2], 0.5f);
  EXPECT_GT(read[3], 1e38f);
  EXPECT_TRUE(std::isfinite(read[3]));
  EXPECT_EQ(read[6], 1.0f);  // 255.97 of 256 rounds to the next exponent
  EXPECT_EQ(read[9], 0);
  EXPECT_EQ(read[12], 0);
}

TEST(Hdr, FlatAreasAreCompressed) {
  const Folder folder;
  Band band;
  band.rows = 10;
  band.width = 1000;
  band.radiance.assign(3 * 10000, 0.5f);
  writeWhole(folder / "a.hdr", band);
  EXPECT_LT(std::filesystem::file_size(folder / "a.hdr"), 1000u);
}

TEST(Streaming, OddBandsGiveTheSameBytesAsOneBand) {
  const Folder folder;
  const Band whole = randomBand(611, 701);  // several segments of the PNG encoder, the last one short
  for (const char* ending : {".png", ".pfm", ".hdr"}) {
    writeWhole(folder / ("whole" + std::string(ending)), whole);
    const auto expected = bytesOf(folder / ("whole" + std::string(ending)));
    for (const std::vector<int>& heights : std::vector<std::vector<int>>{{1}, {7, 1, 64, 3}, {143, 2}, {700, 1}}) {
      ImageWriter writer(folder / ("bands" + std::string(ending)), whole.width, whole.rows);
      for (int row = 0, i = 0; row < whole.rows; ++i) {
        const int rows = std::min(heights[i % heights.size()], whole.rows - row);
        writer.rows(cut(whole, row, rows));
        row += rows;
      }
      writer.finish();
      EXPECT_EQ(bytesOf(folder / ("bands" + std::string(ending))), expected) << ending;
    }
  }
}

TEST(Streaming, MemoryStaysBoundedForAnImageFarLargerThanABand) {
  const Folder folder;
  const pid_t child = fork();
  if (child == 0) {
    // 4,000 bands of 30,000 x 2 would be 720 MB; the address space above what is in use now is held to 256 MB.
    std::ifstream("/proc/self/statm");
    std::size_t pagesInUse = 0;
    std::ifstream("/proc/self/statm") >> pagesInUse;
    const rlim_t most = pagesInUse * static_cast<rlim_t>(getpagesize()) + (rlim_t{256} << 20);
    const rlimit limit{most, most};
    Band band;
    band.rows = 2;
    band.width = 30000;
    band.rgb8.assign(180000, 77);
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(2);
    try {
      ImageWriter writer(folder / "a.png", 30000, 8000);
      for (; band.firstRow < 8000; band.firstRow += 2) writer.rows(band);
      writer.finish();
    } catch (...) { _exit(1); }
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_GT(bytesOf(folder / "a.png").size(), 100000u);
}

TEST(Streaming, WrongBandsAreAnErrorOfTheCaller) {
  const Folder folder;
  const Band whole = randomBand(8, 8);
  ImageWriter writer(folder / "a.png", 8, 8);
  EXPECT_THROW(writer.rows(cut(whole, 2, 2)), std::logic_error);
  EXPECT_THROW(writer.rows(randomBand(9, 1)), std::logic_error);
  EXPECT_THROW(writer.rows(randomBand(8, 9)), std::logic_error);
  Band empty = cut(whole, 0, 2);
  empty.rgb8.clear();
  EXPECT_THROW(writer.rows(empty), std::logic_error);
  writer.rows(cut(whole, 0, 7));
  EXPECT_THROW(writer.finish(), std::logic_error);
}

TEST(Channels, AreThoseThatTheFileIsMadeOf) {
  Channels channels;
  addChannel(channels, ImageFormat::png, ImageKind::radiance);
  EXPECT_TRUE(channels.rgb8);
  EXPECT_FALSE(channels.radiance);
  addChannel(channels, ImageFormat::pfm, ImageKind::normal);
  EXPECT_TRUE(channels.normal);
  EXPECT_FALSE(channels.distance || channels.solid || channels.local || channels.position || channels.radiance);
  addChannel(channels, ImageFormat::hdr, ImageKind::radiance);
  EXPECT_TRUE(channels.radiance);
}

TEST(Channels, ShowAsReadablePictures) {
  const Folder folder;
  Band band;
  band.rows = 1;
  band.width = 3;
  const float inf = std::numeric_limits<float>::infinity();
  band.distance = {0, 1, inf};
  band.normal = {0, 0, 1, -1, 1, 0, 0, 0, 0};
  band.local = {0.5f, 1, 0, 2.25f, -0.25f, 1.5f, 0, 0, 0};
  band.position = {0, 1, -1, inf, -inf, 3, 0, 0, 0};
  band.solid = {-1, 0, 1};
  const auto shown = [&](ImageKind kind) {
    writeWhole(folder / "a.png", band, kind);
    return levels(readImage(folder / "a.png"));
  };
  using Levels = std::vector<std::uint8_t>;
  EXPECT_EQ(shown(ImageKind::distance), (Levels{0, 0, 0, 127, 127, 127, 255, 255, 255}));
  EXPECT_EQ(shown(ImageKind::normal), (Levels{127, 127, 255, 0, 255, 127, 127, 127, 127}));
  EXPECT_EQ(shown(ImageKind::local), (Levels{127, 255, 0, 63, 191, 127, 0, 0, 0}));
  EXPECT_EQ(shown(ImageKind::position), (Levels{127, 191, 63, 255, 0, 223, 127, 127, 127}));
  const Levels solids = shown(ImageKind::solid);
  EXPECT_EQ(Levels(solids.begin(), solids.begin() + 3), (Levels{0, 0, 0}));
  EXPECT_NE(Levels(solids.begin() + 3, solids.begin() + 6), Levels(solids.begin() + 6, solids.end()));
  EXPECT_NE(Levels(solids.begin() + 3, solids.begin() + 6), (Levels{0, 0, 0}));
}

TEST(Names, FormatsByEnding) {
  EXPECT_EQ(imageFormat("a.png"), ImageFormat::png);
  EXPECT_EQ(imageFormat("b.x/a.Pfm"), ImageFormat::pfm);
  EXPECT_EQ(imageFormat("a.HDR"), ImageFormat::hdr);
  EXPECT_EQ(imageFormat("-"), ImageFormat::png);
  EXPECT_EQ(imageFormatByName("hdr"), ImageFormat::hdr);
  for (const char* path : {"a.jpg", "a", "a.png.bak", ".png", "", "png"})
    EXPECT_TRUE(contains(errorOf(Exit::usage, [&] { imageFormat(path); }), ".png, .pfm or .hdr")) << path;
  EXPECT_TRUE(contains(errorOf(Exit::usage, [] { imageFormatByName("gif"); }), "png, pfm or hdr"));
}

TEST(Names, ChannelsStandBeforeTheEnding) {
  EXPECT_EQ(imagePathFor("out.pfm", ImageKind::normal), "out.normal.pfm");
  EXPECT_EQ(imagePathFor("a.b/out.x.png", imageKindByName("solid")), "a.b/out.x.solid.png");
  EXPECT_TRUE(contains(errorOf(Exit::usage, [] { imagePathFor("-", ImageKind::local); }), "-o FILE"));
  EXPECT_TRUE(contains(errorOf(Exit::usage, [] { imageKindByName("depth"); }), "distance, solid, normal"));
  EXPECT_TRUE(contains(errorOf(Exit::usage, [] { imageKindByName("radiance"); }), "unknown channel"));
}

TEST(Failures, ShowBeforeTheFirstRowAndLeaveNothing) {
  const Folder folder;
  const auto opening = [&](const std::string& path) { return errorOf(Exit::output, [&] { ImageWriter(path, 4, 4); }); };
  EXPECT_TRUE(contains(opening(folder / "none/a.png"), "does not exist"));
  std::filesystem::create_directory(folder / "d.png");
  EXPECT_TRUE(contains(opening(folder / "d.png"), "folder"));
  writeBytes(folder / "file", {1});
  opening(folder / "file/a.png");
  EXPECT_EQ(opening("/proc/a.png").find("/proc/a.png"), 0u);
  EXPECT_TRUE(
      contains(errorOf(Exit::usage, [&] { ImageWriter(folder / "a.hdr", 4, 4, ImageKind::normal); }), "normal"));
  errorOf(Exit::usage, [&] { ImageWriter(folder / "a.png", 0, 4); });
  errorOf(Exit::usage, [&] { ImageWriter(folder / "a.png", 4, -1); });
  errorOf(Exit::usage, [&] { ImageWriter(folder / "a.png", 2000000000, 4); });
  EXPECT_EQ(folder.names().size(), 2u);
}

TEST(Failures, AnUnfinishedImageLeavesTheOldOneUntouched) {
  const Folder folder;
  writeBytes(folder / "a.png", {1, 2, 3});
  for (const char* name : {"a.png", "b.pfm"}) {
    ImageWriter writer(folder / name, 64, 64);
    writer.rows(cut(randomBand(64, 64), 0, 60));
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.png"});
  EXPECT_EQ(bytesOf(folder / "a.png"), (std::vector<std::uint8_t>{1, 2, 3}));
}

TEST(Failures, AFullDeviceIsReported) {
  EXPECT_TRUE(contains(errorOf(Exit::output,
                               [] {
                                 ImageWriter writer("/dev/full", 64, 64, ImageKind::radiance, ImageFormat::png);
                                 writer.rows(randomBand(64, 64));
                                 writer.finish();
                               }),
                       "No space left"));
  EXPECT_TRUE(contains(errorOf(Exit::output,
                               [] {
                                 ImageWriter writer("/dev/full", 64, 64, ImageKind::distance, ImageFormat::pfm);
                                 writer.rows(randomBand(64, 64));
                                 writer.finish();
                               }),
                       "No space left"));
}

/// What a process of its own with this file size limit says; it must exit by itself.
int exitCodeWithFileLimit(rlim_t bytes, const std::function<void()>& work) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, bytes};
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(99);
    try {
      work();
    } catch (const Error& error) { _exit(static_cast<int>(error.code())); }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Failures, ADiskThatFillsUpLeavesTheOldFile) {
  const Folder folder;
  for (const char* name : {"a.png", "a.pfm", "a.hdr"}) {
    writeBytes(folder / name, {9, 9});
    const auto write = [&] { writeWhole(folder / name, randomBand(300, 300)); };
    EXPECT_EQ(exitCodeWithFileLimit(20000, write), static_cast<int>(Exit::output)) << name;
    EXPECT_EQ(bytesOf(folder / name), (std::vector<std::uint8_t>{9, 9}));
  }
  EXPECT_EQ(folder.names().size(), 3u);
}

TEST(Targets, DevicesAreWrittenInPlaceAndLinksStay) {
  const Folder folder;
  const Band band = randomBand(20, 20);
  ImageWriter null("/dev/null", 20, 20, ImageKind::radiance, ImageFormat::pfm);
  null.rows(band);
  null.finish();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));

  writeBytes(folder / "target.png", {1});
  std::filesystem::permissions(folder / "target.png", std::filesystem::perms(0640));
  std::filesystem::create_symlink("target.png", folder / "link.png");
  writeWhole(folder / "link.png", band);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link.png"));
  EXPECT_EQ(levels(readImage(folder / "target.png")), band.rgb8);
  EXPECT_EQ(std::filesystem::status(folder / "target.png").permissions(), std::filesystem::perms(0640));
}

TEST(Targets, NewFilesFollowTheUmask) {
  const Folder folder;
  const mode_t before = umask(027);
  writeWhole(folder / "a.png", randomBand(4, 4));
  umask(before);
  EXPECT_EQ(std::filesystem::status(folder / "a.png").permissions(), std::filesystem::perms(0640));
}

TEST(Targets, StandardOutputTakesEveryFormat) {
  const Folder folder;
  const Band band = randomBand(50, 40);
  for (const auto& [format, name] : std::vector<std::pair<ImageFormat, std::string>>{
           {ImageFormat::png, "a.png"}, {ImageFormat::pfm, "a.pfm"}, {ImageFormat::hdr, "a.hdr"}}) {
    writeWhole(folder / name, band);
    std::fflush(stdout);
    const int saved = dup(STDOUT_FILENO), file = open((folder / "out").c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600);
    dup2(file, STDOUT_FILENO);
    {
      ImageWriter writer("-", 50, 40, ImageKind::radiance, format);
      writer.rows(cut(band, 0, 13));
      writer.rows(cut(band, 13, 27));
      writer.finish();
    }
    dup2(saved, STDOUT_FILENO);
    close(saved);
    close(file);
    EXPECT_EQ(bytesOf(folder / "out"), bytesOf(folder / name)) << name;
  }
}

TEST(Times, EncodingAndWritingAreCountedApart) {
  const Folder folder;
  ImageWriter writer(folder / "a.png", 1000, 1000);
  writer.rows(randomBand(1000, 1000));
  writer.finish();
  EXPECT_GT(writer.encodeMilliseconds(), 0);
  EXPECT_GT(writer.writeMilliseconds(), 0);
}

}  // namespace
}  // namespace solidcast
