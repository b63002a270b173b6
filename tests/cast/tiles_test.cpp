// Screen tiles: a list that lacks a solid would lose it from the picture without a trace.
#include "host/cast/tiles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/scene/load.h"
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

TEST_F(OnDevice, EveryPixelsSolidIsInItsTilesList) {
  for (const char* name : {"a_solids", "showpiece", "quadrics", "orthographic", "environment", "nested_groups"}) {
    SCOPED_TRACE(name);
    std::vector<std::string> warnings;
    const Scene scene = loadScene(SOLIDCAST_SOURCE_DIR "/scenes/" + std::string(name) + ".json", warnings);
    RenderJob job;
    job.width = 203, job.height = 151;
    job.crop = {10, 20, 150, 101};
    job.channels.solid = true;
    const TileGrid grid{job.crop, 8, 4};
    const TileLists lists = tileLists(scene, job.width, job.height, 1, grid);
    CastStats stats;
    int seen = 0, listed = 0;
    renderGpu(
        device(), scene, job, {},
        [&](Band& band) {
          for (int y = 0; y < band.rows; ++y)
            for (int x = 0; x < band.width; ++x) {
              const auto solid = band.solid[static_cast<std::size_t>(y * band.width + x)];
              if (solid < 0) continue;
              ++seen;
              const auto tile = static_cast<std::size_t>((y + band.firstRow) / 4 * grid.across() + x / 8);
              const auto begin = lists.solids.begin();
              listed += std::binary_search(lists.everywhere.begin(), lists.everywhere.end(), solid) ||
                        std::binary_search(begin + lists.first[tile], begin + lists.first[tile + 1], solid);
            }
        },
        stats);
    EXPECT_GT(seen, 500);
    EXPECT_EQ(listed, seen);
  }
}

}  // namespace
}  // namespace solidcast
