// The census on images made by hand, where every number is known.
#include "host/image/compare.h"

#include "host/image/difference_picture.h"
#include "tests/image/helpers.h"

namespace solidcast {
namespace {

using namespace testing;

constexpr float kInf = std::numeric_limits<float>::infinity(), kNan = std::numeric_limits<float>::quiet_NaN();

Image eightBit(int width, int height, int channels, std::vector<std::uint8_t> values) {
  return {width, height, channels, std::move(values)};
}
Image floating(int width, int height, int channels, std::vector<float> values) {
  return {width, height, channels, std::move(values)};
}

TEST(Census, ClassesOfEightBitImages) {
  const Image a = eightBit(2, 2, 3, {0, 0, 0, 10, 20, 30, 100, 100, 100, 255, 0, 0});
  const Image b = eightBit(2, 2, 3, {0, 0, 0, 10, 21, 30, 103, 99, 100, 0, 0, 0});
  const Census census = compareImages(a, b, {1, 3});
  EXPECT_EQ(census.unit, Unit::levels);
  EXPECT_EQ(census.pixels, 4);
  EXPECT_EQ(census.equal, 1);
  EXPECT_EQ(census.within, 2);
  EXPECT_EQ(census.beyond, 1);
  EXPECT_TRUE(census.pass());
  EXPECT_EQ(census.maxError, 255);
  EXPECT_DOUBLE_EQ(census.meanError, (1 + 3 + 1 + 255) / 12.0);
  EXPECT_DOUBLE_EQ(census.psnr, 10 * std::log10(255.0 * 255 / ((1 + 9 + 1 + 255 * 255) / 12.0)));
  EXPECT_EQ(census.worst.x, 1);
  EXPECT_EQ(census.worst.y, 1);
  EXPECT_EQ(census.worst.a, (std::vector<double>{255, 0, 0}));
  EXPECT_EQ(census.worst.b, (std::vector<double>{0, 0, 0}));
  EXPECT_EQ(census.passingLevel, 3);  // with one pixel allowed to differ
}

TEST(Census, TheBudgetsEdgesBelongToIt) {
  const Image a = eightBit(3, 1, 3, {0, 0, 0, 0, 0, 0, 0, 0, 0}), b = eightBit(3, 1, 3, {2, 0, 0, 0, 2, 0, 0, 0, 7});
  EXPECT_TRUE(compareImages(a, b, {1, 2}).pass());
  EXPECT_FALSE(compareImages(a, b, {0, 2}).pass());
  EXPECT_FALSE(compareImages(a, b, {1, 1.5}).pass());
  EXPECT_TRUE(compareImages(a, b, {3, 0}).pass());
  EXPECT_FALSE(compareImages(a, b, {2, 0}).pass());
  EXPECT_TRUE(compareImages(a, b, {0, 7}).pass());
}

TEST(Census, WhatItSaysWouldPassDoesPassAndNothingLessDoes) {
  std::mt19937 random(11);
  std::vector<float> values(3000), others;
  for (float& value : values) value = static_cast<float>(random()) * 1e-9f;
  others = values;
  for (std::size_t i = 0; i < others.size(); i += 1 + random() % 50)
    others[i] += 1e-3f / static_cast<float>(1 + random() % 99);
  const Image a = floating(100, 10, 3, values), b = floating(100, 10, 3, others);
  for (const std::int64_t differing : {0, 1, 5, 30}) {
    const double level = compareImages(a, b, {differing, 0}).passingLevel;
    ASSERT_GT(level, 0);
    EXPECT_TRUE(compareImages(a, b, {differing, level}).pass());
    EXPECT_FALSE(compareImages(a, b, {differing, std::nextafter(level, 0)}).pass());
    EXPECT_TRUE(contains(censusText(compareImages(a, b, {differing, 0})), "--max-level "));
  }
  const std::int64_t beyond = compareImages(a, b, {0, 1e-4}).beyond;
  EXPECT_TRUE(compareImages(a, b, {beyond, 1e-4}).pass());
  EXPECT_FALSE(compareImages(a, b, {beyond - 1, 1e-4}).pass());
}

TEST(Census, EqualImages) {
  const Image a = eightBit(2, 1, 3, {1, 2, 3, 4, 5, 6});
  const Census census = compareImages(a, a, {});
  EXPECT_TRUE(census.pass());
  EXPECT_EQ(census.equal, 2);
  EXPECT_EQ(census.worst.x, -1);
  EXPECT_EQ(census.psnr, std::numeric_limits<double>::infinity());
  EXPECT_EQ(census.passingLevel, 0);
  EXPECT_FALSE(contains(censusText(census), "worst"));
}

TEST(Census, NanAndInfinity) {
  // equal NaN, equal inf, NaN against number, inf against number, inf against -inf, small difference
  const Image a = floating(6, 1, 1, {kNan, kInf, kNan, 1, kInf, 1});
  const Image b = floating(6, 1, 1, {kNan, kInf, 1, kInf, -kInf, 1.25f});
  const Census census = compareImages(a, b, {0, 0.25});
  EXPECT_EQ(census.unit, Unit::values);
  EXPECT_EQ(census.equal, 2);
  EXPECT_EQ(census.within, 1);
  EXPECT_EQ(census.beyond, 3);
  EXPECT_EQ(census.nanA, 2);
  EXPECT_EQ(census.nanB, 1);
  EXPECT_EQ(census.infA, 2);
  EXPECT_EQ(census.infB, 3);
  EXPECT_EQ(census.maxError, kInf);
  EXPECT_EQ(census.maxFinite, 0.25);
  EXPECT_DOUBLE_EQ(census.meanError, 0.25);
  EXPECT_DOUBLE_EQ(census.peak, 1.25);
  EXPECT_EQ(census.worst.x, 2);
  EXPECT_EQ(census.passingLevel, kInf);
  EXPECT_TRUE(contains(censusText(census), "would pass          --max-differing 3 --max-level 0.25\n"));
  EXPECT_EQ(compareImages(a, b, {3, 0}).passingLevel, 0.25);
}

TEST(Census, DifferentKindsOfImages) {
  const Image grey = floating(1, 1, 1, {0.5f}), colour = floating(1, 1, 3, {0.5f, 0.5f, 0.75f});
  EXPECT_EQ(compareImages(grey, colour, {}).maxError, 0.25);
  const Image opaque = eightBit(1, 1, 3, {9, 9, 9}), clear = eightBit(1, 1, 4, {9, 9, 9, 55});
  EXPECT_EQ(compareImages(opaque, clear, {}).maxError, 200);
  EXPECT_EQ(compareImages(eightBit(1, 1, 3, {51, 51, 51}), floating(1, 1, 3, {0.2f, 0.2f, 0.2f}), {0, 1e-7}).beyond, 0);
}

TEST(Census, SizesThatDifferAreAnErrorWithBoth) {
  const std::string line = errorOf(Exit::usage, [] {
    compareImages(eightBit(2, 1, 3, std::vector<std::uint8_t>(6)), eightBit(1, 2, 3, std::vector<std::uint8_t>(6)), {});
  });
  EXPECT_TRUE(contains(line, "2x1") && contains(line, "1x2")) << line;
}

TEST(Hits, FlipsAndUlps) {
  const float one = 1, next = std::nextafter(1.0f, 2.0f), below = std::nextafter(1.0f, 0.0f);
  const std::vector<float> ta{kInf, 1, kInf, one, one, next, 4}, tb{kInf, kInf, 2, 3, next, below, 4};
  const std::vector<std::int32_t> sa{-1, 0, -1, 1, 2, 3, 4}, sb{-1, -1, 5, 2, 2, 3, 4};
  const HitCensus census = compareHits({ta, sa}, {tb, sb}, 3);
  EXPECT_EQ(census.hitMissFlips, 2);
  EXPECT_EQ(census.solidFlips, 1);
  EXPECT_EQ(census.bothHit, 3);
  EXPECT_EQ(census.maxUlp, 2);
  EXPECT_EQ(census.p99Ulp, 1);  // of 0, 1, 2 ulp the 99 % rank below the last
  EXPECT_EQ(census.worstX, 2);
  EXPECT_EQ(census.worstY, 1);
}

TEST(Hits, NinetyNineOfAHundred) {
  std::vector<float> ta(1000, 1.0f), tb = ta;
  const std::vector<std::int32_t> solids(1000, 0);
  for (int i = 0; i < 5; ++i) tb[static_cast<std::size_t>(i)] = 2;  // 0.5 % far off
  for (int i = 5; i < 500; ++i) tb[static_cast<std::size_t>(i)] = std::nextafter(1.0f, 2.0f);
  const HitCensus census = compareHits({ta, solids}, {tb, solids}, 100);
  EXPECT_EQ(census.p99Ulp, 1);
  EXPECT_EQ(census.maxUlp, 1 << 23);
}

TEST(Text, SaysWhatMatters) {
  const Image a = eightBit(2, 1, 3, {0, 0, 0, 9, 9, 9}), b = eightBit(2, 1, 3, {0, 0, 0, 9, 9, 8});
  Census census = compareImages(a, b, {});
  census.hasHits = true;
  census.hits.hitMissFlips = 17;
  const std::string text = censusText(census);
  for (const char* part :
       {"2x1", "1,0", "(9, 9, 9)", "(9, 9, 8)", "max 1 level,", "17", "--max-level 1", "--max-differing 1", "exceeded"})
    EXPECT_TRUE(contains(text, part)) << part << " is not in\n" << text;
}

std::array<int, 3> pixelAt(const Image& image, int x, int y) {
  const auto& levels = std::get<0>(image.values);
  const std::size_t at =
      3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x));
  return {levels[at], levels[at + 1], levels[at + 2]};
}

/// Number of pixels in a rectangle that are not grey: the heat map's marks on a grey image.
int coloured(const Image& image, int x0, int y0, int x1, int y1) {
  int count = 0;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const auto [r, g, b] = pixelAt(image, x, y);
      if (r != g || g != b) ++count;
    }
  return count;
}

TEST(Picture, ShowsBothImagesAndMarksTheDifference) {
  const Folder folder;
  const int width = 400, height = 100;
  std::vector<std::uint8_t> grey(3 * width * height, 200);
  const Image a = eightBit(width, height, 3, grey);
  grey[3 * (50 * width + 60)] = 100;  // inside: a mark of 3x3
  grey[0] = 199;                      // in the corner: a mark of 2x2
  const Image b = eightBit(width, height, 3, grey);
  DifferencePicture picture(folder / "d.png", width, height);
  picture.write(a, b, compareImages(a, b, {}), "first", "second");
  const Image shown = readImage(folder / "d.png");
  EXPECT_EQ(shown.width, 3 * width + 16);
  ASSERT_GT(shown.height, height);
  const int top = 20, third = 2 * (width + 8);
  EXPECT_EQ(pixelAt(shown, 5, top), (std::array<int, 3>{200, 200, 200}));
  EXPECT_EQ(pixelAt(shown, width + 8 + 60, top + 50), (std::array<int, 3>{100, 200, 200}));
  EXPECT_EQ(coloured(shown, third, top, third + width, top + height), 9 + 4);
  EXPECT_EQ(pixelAt(shown, third + 30, top + 30), (std::array<int, 3>{50, 50, 50}));
  EXPECT_NE(pixelAt(shown, third, top), pixelAt(shown, third + 60, top + 50));  // 1 level and 100 look different
  EXPECT_GT(coloured(shown, third, top + height, third + width, shown.height), 1000) << "no colour bar";
}

TEST(Picture, TakesEverySizeAndKind) {
  const Folder folder;
  const std::vector<std::pair<int, int>> sizes{{1, 1}, {2, 3}, {1, 3000}, {3000, 1}, {320, 2}};
  for (const auto& [width, height] : sizes) {
    std::vector<float> values(static_cast<std::size_t>(width) * height, 5.0f), others = values;
    others.back() = kNan;
    others.front() = width * height > 1 ? 7 : kInf;
    const Image a = floating(width, height, 1, values), b = floating(width, height, 1, others);
    DifferencePicture picture(folder / "d.png", width, height);
    picture.write(a, b, compareImages(a, b, {}), std::string(5000, 'x'), "\xc3\xa4\n\t");
    EXPECT_GE(readImage(folder / "d.png").width, 960);
    DifferencePicture same(folder / "e.png", width, height);
    same.write(a, a, compareImages(a, a, {}), "", "");
    EXPECT_GE(readImage(folder / "e.png").height, height);
  }
}

TEST(Picture, MustBeAPng) {
  const Folder folder;
  EXPECT_TRUE(contains(errorOf(Exit::usage, [&] { DifferencePicture(folder / "d.pfm", 4, 4); }), ".png"));
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace solidcast
