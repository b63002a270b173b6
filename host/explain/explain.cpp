#include "host/explain/explain.h"

#include <algorithm>
#include <cmath>

#include "host/cast/program.h"
#include "host/cast/solids/all.h"
#include "host/error.h"
#include "host/explain/words.h"

namespace solidcast::explain {
namespace {

constexpr double kNearMiss = 1024;   // a decision within so many of its bounds: nearly the other way
constexpr double kNearTruth = 4096;  // the same of the truth, in units of 2^-24 of the inputs
constexpr std::size_t kTryAll = 1024;

Verdict verdictOf(const Band& band) {
  Verdict v;
  v.index = band.solid[0];
  if (v.index >= 0) v.t = band.distance[0];
  for (std::size_t c = 0; c < 3; ++c) v.radiance[c] = static_cast<double>(band.radiance[c]), v.levels[c] = band.rgb8[c];
  return v;
}

/// The integrators with the truth's t and normal. False for one that is not known here.
bool shade(const Scene& scene, bool twoSided, const oracle::Ray128& ray, const oracle::Truth& truth, Verdict& verdict) {
  f128 cosine = 0;
  for (std::size_t k = 0; k < 3; ++k) cosine -= truth.normal[k] * ray.direction[k];
  cosine /= ray.length;
  cosine = twoSided ? fabsq(cosine) : larger(cosine, 0);
  f128 colour[3] = {cosine, cosine, cosine};
  if (const auto* dist = std::get_if<RayCastingDistIntegrator>(&scene.integrator)) {
    const f128 part = std::clamp<f128>((truth.t - dist->nearDist) / (f128(dist->farDist) - dist->nearDist), 0, 1);
    for (std::size_t c = 0; c < 3; ++c)
      colour[c] *= dist->nearColor[c] + part * (f128(dist->farColor[c]) - dist->nearColor[c]);
  } else if (!std::holds_alternative<RayCastingIntegrator>(scene.integrator)) {
    return false;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    verdict.radiance[c] = static_cast<double>(colour[c]);
    verdict.levels[c] = static_cast<int>(255 * std::clamp<f128>(colour[c], 0, 1));
  }
  return true;
}

/// A ray that passes the solid's ball by so widely that no method could see it there.
bool farOff(const Shape& shape, const oracle::Ray128& ray) {
  const Ball ball = std::visit([](const auto& s) { return solidcast::ball(s); }, shape);
  if (!(ball.radius >= 0)) return false;
  double square = 0, along = 0, sizes = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto origin = static_cast<double>(ray.origin[k]);
    const double f = ball.center[k] - origin;
    square += f * f;
    along += f * static_cast<double>(ray.direction[k] / ray.length);
    sizes += std::fabs(ball.center[k]) + std::fabs(origin);
  }
  const double across = std::sqrt(std::max(0., square - along * along));
  return across > ball.radius + std::sqrt(square) / 16 + sizes * 0x1p-16;
}

void judge(Verdict& v, const Verdict& truth, const std::vector<Candidate>& all, const Scene& scene) {
  const auto name = [&](std::int32_t index) { return solidName(scene.world, index); };
  if (v.index != truth.index) {
    v.right = false;
    if (v.index < 0) v.fault = "misses " + name(truth.index) + ", which the ray hits at t = " + decimal(truth.t);
    else if (truth.index < 0) v.fault = "hits " + name(v.index) + ", where the ray hits nothing";
    else v.fault = "hits " + name(v.index) + ", where the ray hits " + name(truth.index) + " first";
    for (const Candidate& c : all)
      if (c.index == v.index && v.index >= 0 && truth.index >= 0 && c.truth.hit)
        v.fault += " (t = " + decimal(truth.t) + " against " + decimal(c.truth.t) + ")";
    return;
  }
  if (v.index < 0) return;
  v.ulps = oracle::ulpError(static_cast<float>(v.t), truth.t);
  v.right = v.ulps <= 1;
  if (!v.right) v.fault = "gives t with an error of " + brief(v.ulps) + " ulp";
}

/// What the search of `method` makes of the trials.
struct Search {
  std::int32_t index = -1;
  float t = 0;
  bool doubtful = false;
  std::vector<std::string> doubts;
};

Search searched(const std::vector<Candidate>& all, const Setting& setting, const Scene& scene) {
  Search result;
  const bool naive = setting.method == Method::naive, exact = setting.method == Method::exact;
  const Candidate *best = nullptr, *second = nullptr;
  for (const Candidate& c : all) {
    if (c.trial.doubtful) {
      result.doubtful = true;
      for (const Decision& d : c.trial.decisions)
        if (!(d.margin >= 1))
          result.doubts.push_back(solidName(scene.world, c.index) + ": " + d.name + " is within " + brief(d.margin) +
                                  " of its bound");
    }
    if (!c.trial.hit) continue;
    const bool nearer = best == nullptr || (naive ? c.trial.s < best->trial.s : c.trial.s > best->trial.s);
    const Candidate* loser = nearer ? best : &c;
    if (nearer) best = &c;
    if (loser != nullptr && (second == nullptr || loser->trial.s > second->trial.s)) second = loser;
  }
  if (best == nullptr) return result;
  result.index = best->index;
  result.t = best->trial.t;
  if (exact && second != nullptr && !orderIsClear(best->trial.s, second->trial.s, setting.real)) {
    result.doubtful = true;
    result.doubts.push_back("order of " + solidName(scene.world, best->index) + " and " +
                            solidName(scene.world, second->index) + ": 1/t differ by " +
                            brief((best->trial.s - second->trial.s) / best->trial.s * 0x1p24) +
                            " in units of 2^-24, asked is 1/2");
  }
  if (exact && setting.real == RealType::f32) {
    result.doubtful = true;
    result.doubts.push_back("every hit: t in fp32 is not precise enough for exact");
  }
  return result;
}

/// Where the digits of t, or of the decision, went: one line.
std::string lostLine(const Candidate& c, int digits) {
  if (c.trial.dropped) return "dropped by the host: no ray from this eye can hit it";
  std::string line;
  const Stage* worst = c.trial.worst();
  const Stage& last = c.trial.stages.back();
  const auto undefined = std::find_if(c.trial.stages.begin(), c.trial.stages.end(), [](const Stage& s) {
    return std::any_of(s.truth.begin(), s.truth.end(), [](f128 x) { return isnanq(x); });
  });
  if (c.wrong() && worst == nullptr && undefined != c.trial.stages.end()) {
    line += "the formula itself fails here, whatever its digits: " + undefined->name + " is undefined";
  } else if (worst == nullptr) {
    line += "no stage loses a whole digit";
  } else {
    line += worst->name + " loses " + brief(worst->lost) + " of " + std::to_string(digits) + " binary digits";
    const std::string source = worst->source();
    line += source == "arithmetic" ? ", by the method's own roundings"
            : source == "records"  ? ", by what the rounding of the solid's records left it to magnify"
                                   : ", by what the rounding of the ray left it to magnify";
  }
  if (c.wrong()) {
    for (const Decision& d : c.trial.decisions)
      if (d.wrong()) return line + "; wrong sign: " + d.name + " is " + brief(d.shader) + ", truly " + brief(d.truth);
    return line;
  }
  if (c.trial.hit) line += "; t keeps " + brief(last.digits);
  return line;
}

std::string concluded(const Explanation& e) {
  std::string text;
  if (e.gpu.right && e.cpu.right) {
    text = "both are right";
  } else if (!e.gpu.right && !e.cpu.right) {
    text = "both are off: the GPU " + e.gpu.fault + "; the CPU " + e.cpu.fault;
  } else {
    text = e.gpu.right ? "the GPU is right; the CPU " + e.cpu.fault : "the CPU is right; the GPU " + e.gpu.fault;
  }
  const auto off = [&](const Verdict& v, const char* who) {
    if (!v.right || v.levels == e.truth.levels) return;
    text += std::string("; the ") + who + "'s colour is a level off the true one";
  };
  off(e.gpu, "GPU");
  off(e.cpu, "CPU");
  if (e.onEdge) text += "; the ray passes an edge within 2^-100, which for pixels counts as on the edge";
  return text;
}

}  // namespace

void checkPixel(const RenderJob& job, int x, int y) {
  if (x < 0 || y < 0 || x >= job.width || y >= job.height)
    throw Error(Exit::usage, "pixel " + std::to_string(x) + "," + std::to_string(y) +
                                 " lies outside the image, expected 0,0 to " + std::to_string(job.width - 1) + "," +
                                 std::to_string(job.height - 1));
}

Explanation explainPixel(gpu::Device& device, const Scene& scene, const RenderJob& whole, const CastOptions& options,
                         reference::Precision precision, int x, int y) {
  checkPixel(whole, x, y);
  RenderJob job = whole;
  job.crop = {x, y, 1, 1};
  job.samples = 1;
  job.channels = {};
  job.channels.rgb8 = job.channels.radiance = job.channels.distance = job.channels.solid = true;

  Explanation e;
  e.scene = scene.file;
  e.x = x, e.y = y, e.width = job.width, e.height = job.height;
  const char* cameras[] = {"perspective", "environment", "orthographic"};
  e.camera = cameras[cameraNumber(scene.camera)];
  std::string why;
  const RealType real = chooseReal(device.info(), options, Job::pixels, cameraNumber(scene.camera), why);
  e.method = options.method == Method::naive ? "naive" : options.method == Method::fast ? "fast" : "exact";
  e.arithmetic = real == RealType::f64 ? "fp64" : real == RealType::df32 ? "double-float" : "fp32";

  CastStats stats;
  renderGpu(
      device, scene, job, options, [&](Band& band) { e.gpu = verdictOf(band); }, stats);
  e.secondPass = stats.fallbackRays > 0;
  reference::render(
      scene, job, precision, [&](Band& band) { e.cpu = verdictOf(band); }, 1);
  e.gpu.name = "GPU, " + e.method + " in " + e.arithmetic;
  e.cpu.name = std::string("CPU, ") + (precision == reference::Precision::f32   ? "f32"
                                       : precision == reference::Precision::f64 ? "f64"
                                                                                : "f128");

  const oracle::Ray128 ray = oracle::pixelRay(scene.camera, job.width, job.height, x + 0.5, y + 0.5);
  for (int k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(k);
    e.origin[k] = ray.origin[at], e.direction[k] = ray.direction[at] / ray.length;
  }
  const Setting setting = settingOf(scene, options.method, real, job.width, job.height, x, y);
  e.seen = shaderRay(setting);
  const RayQ ideal = PixelRays(scene, job.width, job.height, 1).ray(x, y);

  const oracle::WorldTruth truth = oracle::cast(scene.world, ray);
  e.truth.name = "truth";
  e.truthMargin = truth.marginUlps;
  e.tie = truth.tie;
  if (truth.index >= 0) {
    e.truth.index = truth.index;
    e.truth.t = truth.truth.t;
    if (!shade(scene, job.twoSided || scene.twoSided, ray, truth.truth, e.truth)) e.truth.levels = e.gpu.levels;
  }
  const char* levels[] = {"extended precision with a proven bound", "binary128 with a proven bound",
                          "exact arithmetic"};
  e.decidedBy = levels[static_cast<std::size_t>(truth.truth.level)];

  std::vector<Candidate> all;
  for (std::size_t i = 0; i < scene.world.solids.size(); ++i) {
    const Shape shape = scene.world.solids[i].shape;
    const auto index = static_cast<std::int32_t>(i);
    const bool chosen = index == e.gpu.index || index == e.cpu.index || index == truth.index;
    if (!chosen && scene.world.solids.size() > kTryAll && farOff(shape, ray)) continue;
    all.push_back({index, solidName(scene.world, index), kindLabel(kindNumber(shape)), tryOn(shape, index, setting),
                   oracle::intersect(shape, ray), false, ""});
  }
  for (Verdict* v : {&e.gpu, &e.cpu, &e.truth}) v->solid = solidName(scene.world, v->index);
  judge(e.gpu, e.truth, all, scene);
  judge(e.cpu, e.truth, all, scene);
  const Search search = searched(all, setting, scene);
  e.doubts = search.doubts;
  e.followed = search.doubtful == e.secondPass &&
               (e.secondPass || (search.index == e.gpu.index && (search.index < 0 || search.t == e.gpu.t)));
  const int digits = real == RealType::f32 ? 24 : real == RealType::f64 ? 53 : 44;
  for (Candidate& c : all) {
    c.matters = c.index == e.truth.index || c.index == e.gpu.index || (c.wrong() && (!e.gpu.right || e.secondPass));
    if (!c.matters) continue;
    c.lost = lostLine(c, digits);
    const Shape shape = scene.world.solids[static_cast<std::size_t>(c.index)].shape;
    const Cut cut = std::visit([&](const auto& s) { return solidcast::cut(s, ideal); }, shape);
    e.onEdge = e.onEdge || cut.close || c.truth.marginUlps * 0x1p-24 < 0x1p-100;
  }
  std::erase_if(all, [&](const Candidate& c) {
    const Decision* d = c.trial.decisive();
    const bool near = (d != nullptr && d->margin < kNearMiss) || c.truth.marginUlps < kNearTruth;
    return !c.trial.hit && !c.truth.hit && !near && !c.matters && c.index != e.cpu.index;
  });
  e.clear = scene.world.solids.size() - all.size();
  std::stable_sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    const auto key = [](const Candidate& c) {
      return c.truth.hit ? static_cast<double>(c.truth.t) : c.trial.hit ? static_cast<double>(c.trial.t) : INFINITY;
    };
    return key(a) < key(b);
  });
  for (std::size_t i = all.size(); i-- > 0 && all.size() > kMostCandidates;) {
    if (all[i].matters) continue;
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(i));
    ++e.further;
  }
  e.candidates = std::move(all);
  e.conclusion = concluded(e);
  return e;
}

}  // namespace solidcast::explain
