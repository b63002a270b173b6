// The list of solids that a scene keeps (host/scene/solids.h): kind by kind, and yet in the order in which they came.
#include "host/scene/solids.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace solidcast {
namespace {

std::vector<SolidEntry> some() {
  std::vector<SolidEntry> all;
  for (int i = 0; i < 40; ++i) {
    const double x = i;
    const std::array<Shape, 7> shapes = {InfinitePlane{{x, 0, 0}, {0, 1, 0}},
                                         AABox{{x, 0, 0}, {x + 1, 1, 1}},
                                         Sphere{{x, 1, 2}, 3},
                                         Disc{{x, 0, 0}, {0, 0, 1}, 2},
                                         Triangle{{x, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                         Quad{{x, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                         Quadric{{x, 1, 1, 0, 0, 0, 0, 0, 0, -1}}};
    // The first ten are of one kind.
    all.push_back({i % 9 == 4 ? "solid " + std::to_string(i) : "",
                   shapes[i < 10 ? 2 : static_cast<std::size_t>(i * 5 % 7)], static_cast<std::uint32_t>(i / 4)});
  }
  return all;
}

TEST(Solids, ComeOutAsTheyWentIn) {
  const std::vector<SolidEntry> all = some();
  Solids solids;
  std::array<std::size_t, 7> counts{};
  for (std::size_t n = 0; n < all.size(); ++n) {
    solids.push_back(all[n]);
    ++counts[all[n].shape.index()];
    ASSERT_EQ(solids.size(), n + 1);
    for (std::size_t i = 0; i <= n; ++i) {  // before and after there is a second kind
      ASSERT_EQ(solids[i], all[i]) << n << " " << i;
      EXPECT_EQ(solids.shape(i).copy(), all[i].shape);
      EXPECT_EQ(solids.shape(i).index(), all[i].shape.index());
      EXPECT_EQ(solids.shape(i).getIf<Sphere>() != nullptr, std::holds_alternative<Sphere>(all[i].shape));
      EXPECT_EQ(solids.name(i), all[i].name);
      EXPECT_EQ(solids.group(i), all[i].group);
    }
  }
  EXPECT_EQ(std::vector<SolidEntry>(solids.begin(), solids.end()), all);
  for (std::size_t kind = 0; kind < counts.size(); ++kind) EXPECT_EQ(solids.count(kind), counts[kind]);
}

TEST(Solids, AreEqualWhereAllIs) {
  const std::vector<SolidEntry> all = some();
  const Solids solids(all);
  EXPECT_EQ(solids, Solids(all));
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<SolidEntry> others = all;
    others[i].group += 1;
    EXPECT_NE(solids, Solids(others));
    others = all;
    others[i].name += "'";
    EXPECT_NE(solids, Solids(others));
    others = all;
    others[i].shape = Sphere{{0, 0, 0}, 1 + double(i)};
    EXPECT_NE(solids, Solids(others));
    others = all;
    std::swap(others[i], others[(i + 1) % all.size()]);
    EXPECT_NE(solids, Solids(others));
  }
}

}  // namespace
}  // namespace solidcast
