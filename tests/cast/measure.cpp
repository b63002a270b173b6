#include "tests/cast/measure.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <thread>

#include "host/scene/load.h"

namespace solidcast {
namespace {

constexpr std::size_t kComplaints = 5;

template <class... Arguments>
std::string format(const char* how, Arguments... arguments) {
  char buffer[512];
  std::snprintf(buffer, sizeof buffer, how, arguments...);
  return buffer;
}

std::string hex(const Triple& v) { return format("{%a, %a, %a}", v[0], v[1], v[2]); }
std::string hex(const std::array<float, 3>& v) { return format("{%af, %af, %af}", v[0], v[1], v[2]); }
std::string plain(const oracle::Real3& v) {
  return format("(%.9g %.9g %.9g)", double(v[0]), double(v[1]), double(v[2]));
}
std::string plain(const std::array<float, 3>& v) { return format("(%.9g %.9g %.9g)", v[0], v[1], v[2]); }

struct Numbers {
  std::string operator()(const InfinitePlane& s) const { return hex(s.origin) + ", " + hex(s.normal); }
  std::string operator()(const AABox& s) const { return hex(s.corner1) + ", " + hex(s.corner2); }
  std::string operator()(const Sphere& s) const { return hex(s.center) + format(", %a", s.radius); }
  std::string operator()(const Disc& s) const {
    return hex(s.center) + ", " + hex(s.normal) + format(", %a", s.radius);
  }
  std::string operator()(const Triangle& s) const { return hex(s.v1) + ", " + hex(s.v2) + ", " + hex(s.v3); }
  std::string operator()(const Quad& s) const { return hex(s.vertex) + ", " + hex(s.span1) + ", " + hex(s.span2); }
  std::string operator()(const Quadric& s) const {
    std::string all;
    for (double c : s.coefficients) all += (all.empty() ? "" : ", ") + format("%a", c);
    return all;
  }
};

/// f(i, tally) for all i on both halves of the machine's cores.
template <class F>
void inShares(std::size_t n, Tally& tally, const F& f) {
  const std::size_t threads = std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), n / 256 + 1);
  std::vector<Tally> parts(threads);
  std::vector<std::thread> helpers;
  const auto work = [&](std::size_t part) {
    for (std::size_t i = part; i < n; i += threads) f(i, parts[part]);
  };
  for (std::size_t part = 1; part < threads; ++part) helpers.emplace_back(work, part);
  work(0);
  for (std::thread& helper : helpers) helper.join();
  for (const Tally& part : parts) tally.add(part);
}

double seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

}  // namespace

void Tally::add(const Tally& other) {
  rays += other.rays, hits += other.hits, wrong += other.wrong, misses += other.misses, doubtful += other.doubtful,
      seconds += other.seconds;
  t = std::fmax(t, other.t), normal = std::fmax(normal, other.normal);
  local = std::fmax(local, other.local), position = std::fmax(position, other.position);
  for (const std::string& complaint : other.complaints)
    if (complaints.size() < kComplaints) complaints.push_back(complaint);
}

World worldOf(const std::vector<Shape>& shapes) {
  World world;
  for (const Shape& shape : shapes) {
    world.groups[0].members.push_back({false, static_cast<std::uint32_t>(world.solids.size())});
    world.solids.push_back({"", shape, 0});
  }
  return world;
}

std::string text(const World& world) {
  if (world.solids.size() > 16) return std::to_string(world.solids.size()) + " solids";
  std::string all;
  for (const SolidEntry& solid : world.solids)
    all += std::string(all.empty() ? "" : "; ") + kindName(solid.shape) + " " + std::visit(Numbers{}, solid.shape);
  return all;
}

std::string text(const QueryRay& ray) {
  return hex(ray.origin) + ", " + hex(ray.direction) + (std::isinf(ray.tMax) ? "" : format(", tMax %a", ray.tMax));
}

std::string text(const Tally& tally) {
  std::string all =
      format("%llu rays, %llu hits, %llu wrong, t %.3f, normal %.3f, local %.3f, position %.3f, %llu doubtful",
             static_cast<unsigned long long>(tally.rays), static_cast<unsigned long long>(tally.hits),
             static_cast<unsigned long long>(tally.wrong), tally.t, tally.normal, tally.local, tally.position,
             static_cast<unsigned long long>(tally.doubtful));
  for (const std::string& complaint : tally.complaints) all += "\n  " + complaint;
  return all;
}

void compare(const Answer& answer, const oracle::WorldTruth& truth, Tally& tally,
             const std::function<std::string()>& where) {
  const oracle::Truth& best = truth.truth;
  // A hit that fp32 cannot tell from infinity is a miss.
  const bool beyond = truth.index >= 0 && oracle::beyondFloat(best.t);
  const std::int32_t index = beyond ? -1 : truth.index;
  ++tally.rays;
  std::string what;
  if (answer.index != index) {
    ++tally.wrong;
    tally.misses += answer.index < 0;
    what = format("solid %d t %.9g, truly %d t %.9g", answer.index, answer.t, index, double(best.t));
  } else if (index >= 0) {
    ++tally.hits;
    const double t = oracle::ulpError(answer.t, best.t), normal = oracle::normalError(answer.normal, best.normal);
    const double local = oracle::localError(answer.local, best.local);
    const double position = oracle::localError(answer.position, best.position);
    // Written so that NaN is the largest error of all.
    tally.t = t <= tally.t ? tally.t : t, tally.normal = normal <= tally.normal ? tally.normal : normal;
    tally.local = local <= tally.local ? tally.local : local;
    tally.position = position <= tally.position ? tally.position : position;
    if (!(t <= 1)) what += format("t %.9g, truly %.9g (%.3g ulp); ", answer.t, double(best.t), t);
    if (!(normal <= 1)) what += "normal " + plain(answer.normal) + ", truly " + plain(best.normal) + "; ";
    if (!(local <= 2)) what += "local " + plain(answer.local) + ", truly " + plain(best.local) + "; ";
    if (!(position <= 2)) what += "position " + plain(answer.position) + ", truly " + plain(best.position) + "; ";
  }
  if (what.empty() || tally.complaints.size() >= kComplaints) return;
  tally.complaints.push_back(what + format(" (margin %.3g ulp, face %.3g) ", truth.marginUlps, best.faceMarginUlps) +
                             where());
}

namespace {

void castAndCompare(QueryCaster& caster, const World& world, const std::vector<QueryRay>& rays, Tally& tally) {
  const auto start = std::chrono::steady_clock::now();
  const std::uint64_t before = caster.stats().fallbackRays;
  std::vector<QueryHit> hits(rays.size());
  caster.cast(rays, hits);
  tally.seconds += seconds(start);
  tally.doubtful += caster.stats().fallbackRays - before;
  inShares(rays.size(), tally, [&](std::size_t i, Tally& part) {
    const QueryHit& h = hits[i];
    compare({h.index, h.t, h.normal, h.local, h.position}, oracle::cast(world, oracle::exactRay(rays[i])), part,
            [&] { return text(world) + " | " + text(rays[i]); });
  });
}

}  // namespace

void castAndCompare(gpu::Device& device, const World& world, const std::vector<QueryRay>& rays,
                    const CastOptions& options, Tally& tally) {
  QueryCaster caster(device, world, options);
  castAndCompare(caster, world, rays, tally);
}

Tally measureFamily(gpu::Device& device, oracle::Kind kind, const std::string& family, const FamilyPlan& plan,
                    const CastOptions& options) {
  Tally tally;
  const auto batches = oracle::makeBatches(kind, family, plan.rays, plan.seed, plan.raysPerShape);
  std::optional<QueryCaster> caster;
  World worlds[2];  // the caster's and the next
  for (std::size_t first = 0, turn = 0; first < batches.size(); first += plan.shapesPerWorld, turn = 1 - turn) {
    std::vector<Shape> shapes;
    std::vector<QueryRay> rays;
    for (std::size_t i = first; i < std::min(first + plan.shapesPerWorld, batches.size()); ++i) {
      shapes.push_back(batches[i].shape);
      rays.insert(rays.end(), batches[i].rays.begin(), batches[i].rays.end());
    }
    worlds[turn] = worldOf(shapes);
    if (caster) caster->setWorld(worlds[turn]);
    else caster.emplace(device, worlds[turn], options);
    castAndCompare(*caster, worlds[turn], rays, tally);
  }
  return tally;
}

RenderJob jobOf(const Scene& scene, const Channels& channels) {
  RenderJob job;
  job.width = scene.width;
  job.height = scene.height;
  job.twoSided = scene.twoSided;
  job.channels = channels;
  return job;
}

Band renderWhole(gpu::Device& device, const Scene& scene, const RenderJob& job, const CastOptions& options,
                 CastStats* stats) {
  Band whole;
  CastStats ignored;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  renderGpu(
      device, scene, job, options,
      [&](Band& band) {
        whole.width = band.width;
        whole.rows += band.rows;
        append(whole.rgb8, band.rgb8), append(whole.radiance, band.radiance), append(whole.distance, band.distance);
        append(whole.solid, band.solid), append(whole.normal, band.normal), append(whole.local, band.local);
        append(whole.position, band.position);
      },
      stats ? *stats : ignored);
  return whole;
}

Tally measureImage(gpu::Device& device, const Scene& scene, const CastOptions& options) {
  Channels channels;
  channels.distance = channels.solid = channels.normal = channels.local = channels.position = true;
  Tally tally;
  CastStats stats;
  const auto start = std::chrono::steady_clock::now();
  const Band band = renderWhole(device, scene, jobOf(scene, channels), options, &stats);
  tally.seconds = seconds(start);
  tally.doubtful = stats.fallbackRays;
  const auto three = [](const std::vector<float>& v, std::size_t i) {
    return std::array<float, 3>{v[3 * i], v[3 * i + 1], v[3 * i + 2]};
  };
  inShares(band.solid.size(), tally, [&](std::size_t i, Tally& part) {
    const auto x = static_cast<int>(i) % scene.width, y = static_cast<int>(i) / scene.width;
    Answer answer{band.solid[i], band.distance[i], three(band.normal, i), three(band.local, i),
                  three(band.position, i)};
    const oracle::Ray128 ray = oracle::pixelRay(scene.camera, scene.width, scene.height, x + 0.5, y + 0.5);
    compare(answer, oracle::cast(scene.world, ray), part,
            [&] { return text(scene.world) + format(" | pixel (%d, %d)", x, y); });
    if (answer.index < 0 && answer.t != INFINITY) ++part.wrong;
  });
  return tally;
}

}  // namespace solidcast
