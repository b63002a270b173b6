// The catalogue's hard cases, each as a picture of one pixel: the stages follow the device bit by bit, who is wrong is
// said, and where the digits went.
#include "host/catalogue/catalogue.h"

#include "tests/explain/fixture.h"

namespace solidcast::explain {
namespace {

const catalogue::Catalogue& cases() {
  static const catalogue::Catalogue read = catalogue::readCatalogue(SOLIDCAST_CATALOGUE);
  return read;
}

/// What must hold of every explanation.
void check(const Explanation& e, const std::string& what) {
  EXPECT_TRUE(e.followed) << what;
  EXPECT_EQ(e.conclusion.find("the GPU is right") != std::string::npos || e.conclusion.find("both are right") == 0,
            e.gpu.right)
      << what << ": " << e.conclusion;
  if (e.method == "exact") {
    EXPECT_TRUE(e.gpu.right || e.onEdge) << what << ": " << e.gpu.fault;
    EXPECT_EQ(e.secondPass, !e.doubts.empty()) << what;
  }
  if (e.gpu.right) return;
  EXPECT_FALSE(e.gpu.fault.empty()) << what;
  if (e.onEdge || (e.gpu.index == e.truth.index && e.gpu.ulps < 2)) return;  // roundings that add up
  // Some solid shows why: a wrong sign, a stage that lost digits, or a formula without an answer.
  bool shown = false;
  for (const Candidate& c : e.candidates) {
    if (!c.matters) continue;
    EXPECT_FALSE(c.lost.empty()) << what;
    const bool digits = !c.trial.stages.empty() && c.trial.worst() != nullptr;
    bool sign = false;
    for (const Decision& d : c.trial.decisions) sign = sign || d.wrong();
    sign = sign || c.lost.find("the formula itself fails here") != std::string::npos;
    shown = shown || digits || sign;
  }
  EXPECT_TRUE(shown) << what << "\n" << asText(e);
}

class HardPixels : public Explain, public testing::WithParamInterface<Method> {};
INSTANTIATE_TEST_SUITE_P(, HardPixels, testing::ValuesIn(kMethods),
                         [](const auto& info) { return std::string(nameOf(info.param)); });

TEST_P(HardPixels, OfTheCataloguesRays) {
  int wrong = 0, hardCases = 0;
  for (const catalogue::RayCase& c : cases().rays) {
    const bool hard = (GetParam() == Method::naive ? c.naive : c.fast).decision == catalogue::Allowed::any;
    if (GetParam() != Method::exact && !hard) continue;
    ++hardCases;
    Triple eye, forward;
    for (std::size_t k = 0; k < 3; ++k) eye[k] = c.ray.origin[k], forward[k] = c.ray.direction[k];
    const Explanation e = at(onePixel(c.solids, eye, forward), 0, 0, GetParam());
    check(e, c.id + ", " + c.note);
    wrong += !e.gpu.right;
  }
  // The catalogue bites: there is something to explain. What exact gets "wrong" lies on an edge.
  EXPECT_GE(hardCases, 20);
  if (GetParam() == Method::exact) EXPECT_LE(wrong, 3);
  else EXPECT_GE(wrong, 5);
}

TEST_P(HardPixels, OfTheCataloguesImages) {
  for (const catalogue::ImageCase& c : cases().images)
    for (const catalogue::ImageCase::Pixel& p : c.pixels) {
      const Explanation e = at(c.scene, p.x, p.y, GetParam());
      check(e, c.id + " (" + std::to_string(p.x) + ", " + std::to_string(p.y) + "), " + c.note);
      EXPECT_EQ(e.truth.index, p.truth.hit ? p.truth.index : -1) << c.id;
    }
}

}  // namespace
}  // namespace solidcast::explain
