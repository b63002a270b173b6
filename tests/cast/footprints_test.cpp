// What list building finds of many solids at a time (host/cast/footprints, depth_bounds, record_batch), each solid against
// binary128: no pixel whose ray meets a solid is without it, nothing counts as covered that is not hit, and records are
// those that are made one by one.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "host/cast/list_routes.h"
#include "host/cast/list_sieve.h"
#include "host/cast/record_batch.h"
#include "host/scene/build.h"
#include "host/scene/random.h"

namespace solidcast {
namespace {

constexpr int width = 72, height = 54;

/// Solids of every size from far below a pixel to most of the picture, at all angles.
std::vector<Shape> solids(int each) {
  std::mt19937_64 bits(11);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto at = [&](double scale) {
    return Triple{scale * uniform(bits), scale * uniform(bits), scale * uniform(bits)};
  };
  const auto plus = [](const Triple& a, const Triple& b) { return Triple{a[0] + b[0], a[1] + b[1], a[2] + b[2]}; };
  std::vector<Shape> all;
  for (int i = 0; i < each; ++i) {
    const double size = std::exp2(uniform(bits) * 4 - 1.5);
    const Triple middle = at(8);
    all.push_back(Sphere{middle, size});
    all.push_back(Triangle{plus(middle, at(size)), plus(middle, at(size)), plus(middle, at(size))});
    all.push_back(Quad{middle, at(size), at(size)});
    all.push_back(AABox{middle, plus(middle, at(size))});
  }
  return all;
}

struct Measured {
  Scene scene = randomScene("sphere", 1, 1);  // for its camera
  Silhouette silhouette{scene, width, height, 1};
  EyeFrames eye{eyeFrame(scene, RealType::f32)};
  DepthScale scale{30};
  Crop region{0, 0, width, height};
  std::vector<RayQ> rays;  // of the pixels
  Footprints footprints{silhouette, region, eye.plain, RealType::f32, scale};

  Measured() {
    const PixelRays of(scene, width, height, 1);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) rays.push_back(of.ray(x, y));
  }

  Footprint seen(const Shape& shape) {
    const ShapeRef one = shape;
    Footprint found;
    footprints.find(std::span(&one, 1), [&](std::size_t, const Footprint& f) { found = f; });
    return found;
  }

  /// Depth along the camera's forward axis, which is -z.
  std::optional<double> hit(const Shape& shape, int x, int y) const {
    const RayQ& ray = rays[static_cast<std::size_t>(y * width + x)];
    const Cut c = std::visit([&](const auto& solid) { return cut(solid, ray); }, shape);
    if (!c.hit || c.t <= 0) return std::nullopt;
    return static_cast<double>(-c.t * ray.direction.z);
  }
};

TEST(Footprints, HoldEveryPixelWhoseRayMeetsTheSolid) {
  Measured m;
  const std::vector<Shape> all = solids(80);
  int hits = 0, missed = 0, without = 0;
  for (const Shape& shape : all) {
    const Footprint f = m.seen(shape);
    without += !f.seen();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (!m.hit(shape, x, y)) continue;
        ++hits;
        ASSERT_TRUE(x >= f.x0 && x <= f.x1 && y >= f.y0 && y <= f.y1) << shape.index() << " " << x << " " << y;
        const int tile = (y / 4 - f.y0 / 4) * 2 + x / 4 - f.x0 / 4;
        EXPECT_FALSE(f.misses != 0 && f.misses >> tile & 1) << shape.index() << " " << x << " " << y;
      }
    missed += f.seen() && f.misses != 0;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GT(missed, 20);   // polygons beside a tile
  EXPECT_GT(without, 20);  // between the centres, or beside the picture
}

void depthsAreLoweredOnlyWhereHit(bool asDiscs) {
  Measured m;
  int hits = 0, lowered = 0;
  for (const Shape& shape : solids(asDiscs ? 600 : 80)) {
    const ShapeRef one = shape;
    const Footprint f = m.seen(shape);
    // The whole picture, then one of its parts.
    for (const Crop& area : {Crop{0, 0, width, (height + 3) / 4 * 4}, Crop{24, 16, 32, 24}}) {
      if (!f.seen() || f.x1 < area.x || f.x0 >= area.x + area.width || f.y1 < area.y || f.y0 >= area.y + area.height)
        continue;
      DepthBounds depths;
      depths.start(area, width, height);
      DepthCode hides = DepthScale::none;
      if (asDiscs) {
        const auto batch = [&](const auto& b) {
          if constexpr (requires { b.disc; })
            if (const SmallDisc disc{b.disc[0]}; b.plain[0] && disc.radius() != 0) {
              hides = disc.hides();
              const SeenWithin seen = within(f, 0, area);
              const std::uint32_t place = 0;
              depths.add({&seen, 1}, {&place, 1}, {&disc, 0});
            }
        };
        m.footprints.findBatches(std::span(&one, 1), true, batch, [](std::size_t, const Footprint&) {});
      } else {
        m.footprints.findCovers(std::span(&one, 1), [&](std::size_t, const Footprint& g, const Cover& cover) {
          hides = g.hides;
          depths.add(within(g, 0, area), hides, cover);
        });
      }
      if (hides == DepthScale::none) continue;
      depths.noteTiles();
      for (int y = area.y; y < std::min(area.y + area.height, height); ++y)
        for (int x = area.x; x < area.x + area.width; ++x) {
          const auto depth = m.hit(shape, x, y);
          hits += depth.has_value();
          // Something there that begins just beyond is hidden.
          const Footprint behind{x, y, x, y, static_cast<DepthCode>(hides + 1), DepthScale::none, 0};
          if (!depths.hides(within(behind, 1, area))) continue;
          ++lowered;
          ASSERT_TRUE(depth) << shape.index() << " " << x << " " << y;
          EXPECT_LE(m.scale.ends(static_cast<float>(*depth)), hides) << shape.index() << " " << x << " " << y;
        }
    }
  }
  EXPECT_GT(lowered, 2000);
  EXPECT_GT(lowered, 0.9 * hits);
}
TEST(DepthBounds, AreLoweredOnlyWhereTheSolidIsHitAndNoNearerThanThat) { depthsAreLoweredOnlyWhereHit(false); }
TEST(DepthBounds, OfSmallDiscsToo) { depthsAreLoweredOnlyWhereHit(true); }

TEST(SeenWithin, HasWhatIsSeenInItsPartOfThePicture) {
  Measured m;
  int missed = 0, hits = 0;
  for (const Shape& shape : solids(80)) {
    const Footprint f = m.seen(shape);
    for (const Crop& area : {Crop{0, 0, 32, 16}, Crop{32, 0, 40, 16}, Crop{0, 16, 32, 40}, Crop{32, 16, 40, 40}}) {
      if (!f.seen() || !overlap(f, area)) continue;
      const SeenWithin s = within(f, 7, area);
      EXPECT_EQ(s.solid, 7u);
      EXPECT_EQ(s.nearest(), f.nearest);
      missed += s.misses() != 0;
      for (int y = area.y; y < std::min(area.y + area.height, height); ++y)
        for (int x = area.x; x < area.x + area.width; ++x) {
          if (!m.hit(shape, x, y)) continue;
          ++hits;
          const int left = x - area.x, top = y - area.y;
          ASSERT_TRUE(left >= s.x0() && left <= s.x1() && top >= s.y0() && top <= s.y1()) << shape.index();
          const int tile = (top / 4 - s.y0() / 4) * 2 + left / 4 - s.x0() / 4;
          EXPECT_FALSE(s.misses() != 0 && s.misses() >> tile & 1) << shape.index() << " " << x << " " << y;
        }
    }
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GT(missed, 20);
}

/// Of solids on both sides of the middle depth, 30, whose code is 2^15.
constexpr DepthSlices slices{{0, 32000, 33200}};

/// Every wide tile's part of a solid is the one that `within` has of it.
TEST(Routes, GoWhereTheSolidIsSeen) {
  Measured m;
  const std::vector<Shape> all = solids(400);
  constexpr int shift = 4, side = 1 << shift, across = (width + side - 1) / side;
  constexpr std::size_t tiles = 1000;  // more than there are
  const Bins bins{shift, across, tiles, slices};
  Routes routes;
  int whole = 0, split = 0, elsewhere = 0, discs = 0, missed = 0;
  std::array<int, DepthSlices::count> ofSlice{};
  for (std::size_t first = 0; first + Footprints::block <= all.size(); first += Footprints::block) {
    std::vector<ShapeRef> shapes;
    for (std::size_t i = 0; i < Footprints::block; ++i) shapes.push_back(all[first + i]);
    const auto batch = [&](const auto& b) {
      route(b, bins, routes);
      for (std::size_t i = 0; i < b.count; ++i) {
        const Footprint f = m.footprints.of(b, i, shapes);
        const bool few = f.x1 / side - f.x0 / side < 2 && f.y1 / side - f.y0 / side < 2;
        const bool plain = f.seen() && b.plain[i] && few;
        ASSERT_EQ(routes.patch[i] != Routes::none, plain);
        if (!plain) {
          ++elsewhere;
          continue;
        }
        std::map<std::size_t, SeenWithin> parts;
        routes.forEach(i, 5, across, [&](std::size_t at, const SeenWithin& s) {
          EXPECT_EQ(at / tiles, slices.of(f.nearest));
          EXPECT_TRUE(parts.emplace(at % tiles, s).second);
        });
        ++ofSlice[slices.of(f.nearest)];
        for (int y = f.y0 / side; y <= f.y1 / side; ++y)
          for (int x = f.x0 / side; x <= f.x1 / side; ++x) {
            ASSERT_TRUE(parts.contains(static_cast<std::size_t>(y * across + x)));
            const SeenWithin s = parts.at(static_cast<std::size_t>(y * across + x));
            const SeenWithin t = within(f, 5, {x * side, y * side, side, side});
            EXPECT_EQ(s.first, t.first);
            EXPECT_EQ(s.last, t.last);
            EXPECT_EQ(s.more & 0xffffff, t.more & 0xffffff);
            EXPECT_EQ(s.covers(), t.covers());
            EXPECT_EQ(s.solid, 5u);
            discs += s.isDisc(), missed += s.misses() != 0;
          }
        const auto parted = static_cast<std::size_t>((f.x1 / side - f.x0 / side + 1) * (f.y1 / side - f.y0 / side + 1));
        EXPECT_EQ(parts.size(), parted);
        ++(parted == 1 ? whole : split);
      }
    };
    m.footprints.findBatches(shapes, true, batch, [](std::size_t, const Footprint&) {});
  }
  for (const int count : {whole, split, elsewhere, discs, missed}) EXPECT_GT(count, 50);
  for (const int count : ofSlice) EXPECT_GT(count, 50);
}

/// Of a crowd, half of it behind a wall: no pixel's nearest solid is dropped, and most of what is hidden is.
TEST(Sieve, KeepsWhatIsNearestInSomePixel) {
  Measured m;
  World world;
  std::mt19937_64 bits(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 600; ++i) {
    const Triple at = {12 * uniform(bits), 9 * uniform(bits), 10 * uniform(bits)};
    if (i % 3 == 0) addSolid(world, Sphere{at, 0.4 + 0.3 * uniform(bits)});
    else if (i % 3 == 1) addSolid(world, Triangle{at, {at[0] + 1.5, at[1], at[2]}, {at[0], at[1] + 1.5, at[2] + 1}});
    else addSolid(world, AABox{at, {at[0] + 0.5, at[1] + 0.5, at[2] + 0.5}});
  }
  addSolid(world, Quad{{-14, -6, 3}, {28, 0, 0.5}, {0, 12, 0}});  // in several patches
  for (const Crop& area : {Crop{0, 0, 64, 56}, Crop{16, 16, 32, 24}}) {
    ListPatch patch;
    patch.depths.start(area, width, height);
    std::array<std::vector<SeenWithin>, DepthSlices::count> first, second;
    std::size_t given = 0;
    std::vector<ListHead> wide;
    std::vector<Footprint> seen;
    for (std::uint32_t i = 0; i < world.solids.size(); ++i) {
      const Footprint f = seen.emplace_back(m.seen(world.solids[i].shape));
      if (!f.seen() || !overlap(f, area)) continue;
      if (i + 1 == world.solids.size() && area.x == 0) wide.push_back({f, i});
      else {  // as two threads take them
        (i / 32 % 2 ? first : second)[slices.of(f.nearest)].push_back(within(f, i, area));
        ++given;
      }
    }
    Sieve sieve(world.solids, m.footprints);
    const std::span<const ListHead> wides[] = {wide};
    for (std::size_t slice = 0; slice < DepthSlices::count; ++slice) {
      EXPECT_GT(first[slice].size(), 5u);
      const std::vector<SeenWithin>* lists[] = {&first[slice], &second[slice]};
      sieve.sift(patch, lists, wides, slices, slice, {nullptr, 0});
    }
    sieve.siftKept(patch);
    EXPECT_LT(patch.kept.size(), given * 2 / 3);
    EXPECT_TRUE(std::is_sorted(patch.kept.begin(), patch.kept.end(),
                               [](const SeenWithin& a, const SeenWithin& b) { return a.solid < b.solid; }));
    int hits = 0;
    for (int y = area.y; y < std::min(area.y + area.height, height); ++y)
      for (int x = area.x; x < area.x + area.width; ++x) {
        std::uint32_t nearest = 0;
        double least = 1e300;
        for (std::uint32_t i = 0; i < world.solids.size(); ++i) {
          const Footprint& f = seen[i];
          if (x < f.x0 || x > f.x1 || y < f.y0 || y > f.y1) continue;
          if (const auto depth = m.hit(world.solids[i].shape, x, y); depth && *depth < least)
            least = *depth, nearest = i;
        }
        if (least == 1e300 || nearest + 1 == world.solids.size()) continue;
        ++hits;
        EXPECT_TRUE(
            std::any_of(patch.kept.begin(), patch.kept.end(), [&](const SeenWithin& s) { return s.solid == nearest; }))
            << nearest << " at " << x << " " << y;
      }
    EXPECT_GT(hits, 200);
  }
}

TEST(DepthScale, AGreaterCodeIsOfAGreaterDepth) {
  std::mt19937_64 bits(5);
  std::uniform_real_distribution<double> uniform(-140, 140);
  const DepthScale scale(3);
  for (int i = 0; i < 20000; ++i) {
    const auto a = static_cast<float>(std::exp2(uniform(bits))), b = i % 2 ? std::nextafter(a, 0.f) : 3 * a / 2;
    EXPECT_TRUE(scale.begins(a) <= scale.ends(b) || a > b) << a << " " << b;
    EXPECT_TRUE(scale.begins(b) <= scale.ends(a) || b > a) << a << " " << b;
  }
  EXPECT_GT(scale.begins(3.001f), scale.ends(3.f));
  EXPECT_LT(scale.begins(INFINITY), scale.ends(INFINITY));
  EXPECT_EQ(scale.begins(-1), 0);
}

TEST(RecordBatch, HasTheVeryNumbersOfRecordsMadeOneByOne) {
  const EyeFrames eye(eyeFrame(randomScene("sphere", 1, 1), RealType::f32));
  std::vector<Shape> all = solids(300);
  for (int i = 0; i < 40; ++i) {
    const double near = std::exp2(-i);
    all.push_back(Sphere{{0, 0, 29 - near}, 1});                                              // the eye near it
    all.push_back(Triangle{{near, 0, 0}, {near, 1, 0}, {2 * near, 0, 20}});                   // seen edge-on
    all.push_back(Quad{{0, 1 + near, 3}, {1, 0, 1e-3}, {-1, near, -1e-3}});                   // all but flat
    all.push_back(Triangle{{near * 1e-9, 0, 0}, {near * 1e-9, 0, 20}, {near * 1e-9, 1, 1}});  // through the eye
  }
  std::map<int, RecordBatch> batches;
  std::map<int, std::vector<std::uint32_t>> members;
  int poor = 0, grazing = 0, same = 0, another = 0;
  const auto check = [&](int kind) {
    RecordBatch& batch = batches.at(kind);
    const std::size_t count = batch.pack(eye.plain);
    ASSERT_EQ(count, members[kind].size());
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t index = members[kind][i];
      std::visit(
          [&](const auto& solid) {
            EyeRecord<double> record(RealType::f32);
            packEye(solid, eye.plain, double(index), record);
            ASSERT_EQ(batch.poor(i), record.poor || record.kind != kind) << index;
            poor += record.poor || record.kind < 0, another += record.kind >= 0 && record.kind != kind;
            if (batch.poor(i)) return;
            EXPECT_EQ(batch.grazing(i), record.grazing) << index;
            grazing += record.grazing;
            std::vector<float> rows(4 * static_cast<std::size_t>(record.rows)), ones(rows.size());
            batch.copy(i, reinterpret_cast<std::byte*>(rows.data()));
            for (std::size_t k = 0; k < ones.size(); ++k) ones[k] = static_cast<float>(record.row[k / 4][k % 4]);
            EXPECT_EQ(rows, ones) << index;
            ++same;
          },
          all[index]);
    }
    members[kind].clear();
  };
  for (std::uint32_t i = 0; i < all.size(); ++i)
    std::visit(
        [&](const auto& solid) {
          if constexpr (requires(RecordBatch b) { b.add(solid, i); }) {
            const int kind = kindNumber(solid);
            RecordBatch& batch = batches.try_emplace(kind, kind).first->second;
            batch.add(solid, i);
            members[kind].push_back(i);
            if (batch.full()) check(kind);
          }
        },
        all[i]);
  for (const auto& [kind, of] : batches) check(kind);
  EXPECT_GT(same, 900);
  EXPECT_GT(poor, 5);
  EXPECT_GT(grazing, 5);
  EXPECT_GT(another, 30);
}

}  // namespace
}  // namespace solidcast
