// The GLSL of every solid, function by function, against the oracle: KIND_eye in float, double and double-float,
// KIND_free in float and double, KIND_naive, KIND_finish.
#include "tests/glsl/solids.h"

#include <cmath>
#include <cstdio>

#include "host/cast/solids/all.h"
#include "host/glsl_test/device.h"

namespace solidcast::glsl_test {
namespace {

using oracle::Kind;

class SolidsTest : public Test, public testing::WithParamInterface<Kind> {
 protected:
  static std::string kindName() {
    return kindLabel(kindNumber(oracle::makeBatches(GetParam(), "generic", 1, 1)[0].shape));
  }
};

std::string hexOf(const Aimed& a) {
  char text[400];
  const auto &o = a.ray.origin, &d = a.ray.direction;
  std::snprintf(text, sizeof text,
                "family %s, origin (%a, %a, %a), direction (%a, %a, %a), truth: %s, t = %.9g, margin %.3g",
                a.family.c_str(), o[0], o[1], o[2], d[0], d[1], d[2], a.truth.hit ? "hit" : "miss",
                static_cast<double>(a.truth.t), a.truth.marginUlps);
  return text;
}

double cosineOf(const Aimed& a) {
  oracle::Real dot = 0, squared = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    dot -= a.truth.normal[i] * a.ray.direction[i];
    squared += oracle::Real(a.ray.direction[i]) * a.ray.direction[i];
  }
  return static_cast<double>(dot / sqrtq(squared));
}

/// What a family's rays came to.
struct Tally {
  std::size_t rays = 0, hits = 0, doubtful = 0, wrong = 0;
  double worstUlp = 0, worstCosine = 0;  // t; cosine in units of 2^-24
  std::string firstWrong, worst;
};

/// `marginUlps`: decisions nearer to flipping than that do not count. `cosines`: where the truth's is well-conditioned.
void tally(std::map<std::string, Tally>& tallies, const std::vector<Aimed>& all, const Packed& packed, const Call& call,
           bool hasClear, double marginUlps = 0) {
  const auto hit = call["hit"].as<bool>();
  const auto clear = hasClear ? call["clear"].as<bool>() : std::vector<bool>(hit.size(), true);
  const auto t = call["t"].as<float>(), cosine = call["cosine"].as<float>();
  for (std::size_t i = 0; i < packed.elements.size(); ++i) {
    const Aimed& a = all[packed.elements[i]];
    Tally& sum = tallies[a.family];
    ++sum.rays;
    if (!clear[i] || a.truth.marginUlps < marginUlps) {
      ++sum.doubtful;
      continue;
    }
    if (hit[i] != a.truth.hit) {
      if (sum.wrong++ == 0) sum.firstWrong = hexOf(a);
      continue;
    }
    if (!hit[i]) continue;
    ++sum.hits;
    const double ulp = oracle::ulpError(t[i], a.truth.t);
    if (ulp > sum.worstUlp) sum.worstUlp = ulp, sum.worst = hexOf(a);
    sum.worstCosine = std::fmax(sum.worstCosine, std::fabs(cosine[i] - cosineOf(a)) * 0x1p24);
  }
}

void print(const std::string& what, const std::map<std::string, Tally>& tallies) {
  for (const auto& [family, s] : tallies) {
    std::printf("    %-28s %-11s %5zu rays %5zu hits %5zu in doubt %3zu wrong, t %.3g ulp, cosine %.3g x 2^-24\n",
                what.c_str(), family.c_str(), s.rays, s.hits, s.doubtful, s.wrong, s.worstUlp, s.worstCosine);
  }
}

std::map<std::string, Tally> eyeTallies(const std::vector<Aimed>& all, RealType type, bool exact,
                                        double marginUlps = 0) {
  std::map<std::string, Tally> tallies;
  std::vector<std::size_t> none;
  for (const auto& [kind, packed] : packedForEye(all, type, none)) {
    Function f = eyeFunction(device(), kindLabel(kind), type, exact);
    f.set("rows", packed.values());
    const Call call =
        f(packed.row, packed.directions(all), packed.unit, packed.grazing, packed.onFace, doubtOf(type, true));
    tally(tallies, all, packed, call, true, marginUlps);
  }
  for (const std::size_t i : none) EXPECT_FALSE(all[i].truth.hit) << "no record for: " << hexOf(all[i]);
  return tallies;
}

// --- exact: what is not in doubt is right ---------------------------------------------------------

void exactEye(Kind kind, const std::string& name, RealType type) {
  const auto tallies = eyeTallies(aimed(kind, oracle::familiesOf(kind), 1000, true), type, true);
  print(name + " eye " + labelOf(type), tallies);
  for (const auto& [family, sum] : tallies) {
    EXPECT_EQ(sum.wrong, 0u) << sum.firstWrong;
    EXPECT_LE(sum.worstUlp, 1) << sum.worst;
  }
  // Were everything in doubt, nothing would have been shown.
  const Tally& generic = tallies.at("generic");
  EXPECT_GT(generic.hits, 25u);
  EXPECT_LT(generic.doubtful, generic.rays / 100);
}

TEST_P(SolidsTest, EyeInDoubleIsExactOrInDoubt) { exactEye(GetParam(), kindName(), RealType::f64); }
TEST_P(SolidsTest, EyeInDoubleFloatIsExactOrInDoubt) { exactEye(GetParam(), kindName(), RealType::df32); }

void exactFree(Kind kind, const std::string& name, RealType type) {
  const std::vector<Aimed> all = aimed(kind, oracle::familiesOf(kind), 1000, false);
  const Packed packed = packedWorld(all, type);
  Function f = freeFunction(device(), name, type, true);
  f.set("rows", packed.values());
  std::map<std::string, Tally> tallies;
  tally(tallies, all, packed, f(packed.row, packed.origins(all), packed.directions(all), doubtOf(type, false)), true);
  print(name + " free " + labelOf(type), tallies);
  for (const auto& [family, sum] : tallies) {
    EXPECT_EQ(sum.wrong, 0u) << sum.firstWrong;
    if (type == RealType::f64) { EXPECT_LE(sum.worstUlp, 1) << sum.worst; }  // in float only decisions are used
  }
  const Tally& generic = tallies.at("generic");
  EXPECT_GT(generic.hits, 25u);
  EXPECT_LT(generic.doubtful, type == RealType::f64 ? generic.rays / 50 : generic.rays * 3 / 5);
}

TEST_P(SolidsTest, FreeInDoubleIsExactOrInDoubt) { exactFree(GetParam(), kindName(), RealType::f64); }
TEST_P(SolidsTest, FreeInFloatDecidesRightOrIsInDoubt) { exactFree(GetParam(), kindName(), RealType::f32); }

// --- fast and naive: right away from edges --------------------------------------------------------

/// Decisions nearer to flipping than this many units of 2^-24 are not asked of fp32.
constexpr double fp32Margin = 64;

/// Errors of t in ulp and of the cosine in 2^-24 on the generic family: the next power of two above the largest of
/// 20,000 rays. They are large where a ray grazes: fp32 cannot do better there, and a change for the worse shows.
struct Bounds {
  double eyeT, eyeCosine, freeT, freeCosine, naiveT, naiveCosine, finishNormal, finishLocal;
};
Bounds boundsOf(Kind kind) {
  switch (kind) {
    case Kind::plane:
      return {2048, 4, 16384, 4, 8192, 4, 0.5, 1};
    case Kind::box:
      return {4, 2, 1024, 2, 1024, 2, 0, 1};
    case Kind::sphere:
      return {256, 4096, 512, 4096, 512, 4096, 4, 1};
    case Kind::disc:
      return {16, 4, 64, 4, 64, 4, 0.5, 1};
    case Kind::triangle:
      return {32, 4, 32, 4, 32, 4, 0.5, 32};
    case Kind::quad:
      return {16, 4, 4096, 4, 4096, 4, 0.5, 32};
    case Kind::quadric:
      break;
  }
  return {512, 8192, 8192, 8192, 8192, 8192, 16, 1};
}

void keeps(double ulp, double cosine, const std::map<std::string, Tally>& tallies) {
  const Tally& sum = tallies.at("generic");
  EXPECT_EQ(sum.wrong, 0u) << sum.firstWrong;
  EXPECT_LE(sum.worstUlp, ulp) << sum.worst;
  EXPECT_LE(sum.worstCosine, cosine);
  EXPECT_GT(sum.hits, 500u);
  EXPECT_LT(sum.doubtful, sum.rays / 100);
}

TEST_P(SolidsTest, EyeInFloatIsRightAwayFromEdges) {
  const auto tallies = eyeTallies(aimed(GetParam(), {"generic"}, 20'000, true), RealType::f32, false, fp32Margin);
  print(kindName() + " eye float", tallies);
  keeps(boundsOf(GetParam()).eyeT, boundsOf(GetParam()).eyeCosine, tallies);
}

TEST_P(SolidsTest, FreeInFloatIsRightAwayFromEdges) {
  const std::vector<Aimed> all = aimed(GetParam(), {"generic"}, 20'000, false);
  const Packed packed = packedWorld(all, RealType::f32);
  Function f = freeFunction(device(), kindName(), RealType::f32, false);
  f.set("rows", packed.values());
  std::map<std::string, Tally> tallies;
  tally(tallies, all, packed, f(packed.row, packed.origins(all), packed.directions(all), 0.f), true, fp32Margin);
  print(kindName() + " free float", tallies);
  keeps(boundsOf(GetParam()).freeT, boundsOf(GetParam()).freeCosine, tallies);
}

TEST_P(SolidsTest, NaiveIsRightAwayFromEdges) {
  const std::vector<Aimed> all = aimed(GetParam(), {"generic"}, 20'000, false);
  const Packed packed = packedWorld(all, RealType::f32);
  Function f = naiveFunction(device(), kindName());
  f.set("rows", packed.values());
  std::map<std::string, Tally> tallies;
  tally(tallies, all, packed, f(packed.row, packed.origins(all), packed.directions(all)), false, fp32Margin);
  print(kindName() + " naive", tallies);
  keeps(boundsOf(GetParam()).naiveT, boundsOf(GetParam()).naiveCosine, tallies);
}

// --- normals and local coordinates ----------------------------------------------------------------

TEST_P(SolidsTest, FinishGivesNormalAndLocalCoordinates) {
  std::vector<Aimed> all;
  for (Aimed& a : aimed(GetParam(), {"generic", "offset"}, 10'000, false)) {
    if (a.truth.hit && a.truth.faceMarginUlps > 64) all.push_back(std::move(a));
  }
  ASSERT_GT(all.size(), 1000u);
  std::vector<std::array<double, 3>> points;
  std::vector<Float3> pointsFloat;
  std::vector<float> cosines;
  for (const Aimed& a : all) {
    points.push_back({});
    pointsFloat.push_back({});
    for (std::size_t i = 0; i < 3; ++i) {
      points.back()[i] = static_cast<double>(a.truth.position[i]);
      pointsFloat.back()[i] = static_cast<float>(a.truth.position[i]);
    }
    cosines.push_back(static_cast<float>(cosineOf(a)));
  }
  for (const RealType type : {RealType::f64, RealType::f32}) {
    const Packed packed = packedWorld(all, type);
    Function f = finishFunction(device(), kindName(), type);
    f.set("rows", packed.values());
    const Call call = type == RealType::f64 ? f(packed.row, points, packed.directions(all), cosines)
                                            : f(packed.row, pointsFloat, packed.directions(all), cosines);
    const auto normals = call["normal"].as<Float3>(), locals = call["local"].as<Float3>();
    double normal = 0, local = 0;
    std::string worst;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (type == RealType::f32 && all[i].family != "generic") continue;
      const double error = oracle::normalError(normals[i], all[i].truth.normal);
      if (error > normal) normal = error, worst = hexOf(all[i]);
      local = std::fmax(local, oracle::localError(locals[i], all[i].truth.local));
    }
    std::printf("    %s finish %s: normal %.3g x 2^-23, local %.3g ulp\n", kindName().c_str(), labelOf(type).c_str(),
                normal, local);
    if (type == RealType::f64) {
      EXPECT_LE(normal, 1) << worst;
      EXPECT_LE(local, 2);
    } else {
      EXPECT_LE(normal, boundsOf(GetParam()).finishNormal) << worst;
      EXPECT_LE(local, boundsOf(GetParam()).finishLocal);
    }
  }
}

// --- the host's second pass, beside the oracle ----------------------------------------------------

TEST_P(SolidsTest, TheSecondPassAgreesWithTheOracle) {
  for (const Aimed& a : aimed(GetParam(), oracle::familiesOf(GetParam()), 500, false)) {
    const auto &o = a.ray.origin, &d = a.ray.direction;
    const RayQ ray{V3(o[0], o[1], o[2]), V3(d[0], d[1], d[2])};
    const Cut cut = std::visit([&](const auto& s) { return solidcast::cut(s, ray); }, a.shape);
    EXPECT_EQ(cut.hit, a.truth.hit) << hexOf(a);
    if (cut.hit && a.truth.hit) {
      EXPECT_LE(static_cast<double>(fabsq(cut.t - a.truth.t) / a.truth.t), 0x1p-40) << hexOf(a);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SolidsTest, testing::ValuesIn(oracle::kKinds),
                         [](const auto& info) { return oracle::nameOf(info.param); });

}  // namespace
}  // namespace solidcast::glsl_test
