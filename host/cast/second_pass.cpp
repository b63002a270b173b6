#include "host/cast/second_pass.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "host/cast/bounds.h"
#include "host/cast/index.h"
#include "host/cast/rational_pass.h"
#include "host/cast/solids/all.h"

namespace solidcast {
namespace {

constexpr int fewCasts = 8;  // rays that look at every solid's box take as long as building the index

Cut cutOf(ShapeRef shape, const RayQ& ray) {
  Cut c = shape.visit([&](const auto& s) { return cut(s, ray); });
  return c.close && ray.rational ? rationalCut(shape.copy(), ray) : c;
}

}  // namespace

SecondPass::SecondPass(const World& world, const Index* index) : world_(world), index_(index) {}
SecondPass::~SecondPass() = default;

const Cut* SecondPass::note(const RayQ& ray, std::uint32_t solid, std::vector<Candidate>& all) const {
  const ShapeRef shape = world_.solids.shape(solid);
  // Copies of a solid tie everywhere; a pile of them is not to be cut one by one.
  if (!all.empty() && world_.solids.shape(all.back().solid).copy() == shape.copy()) {
    all.back().solid = std::min(all.back().solid, solid);
    return nullptr;
  }
  const Cut c = cutOf(shape, ray);
  if (!c.hit) return nullptr;
  all.push_back({solid, c});
  return &all.back().cut;
}

std::vector<SecondPass::Candidate> SecondPass::candidates(const RayQ& ray, f128 limit) const {
  const f128 perT = length(ray.direction);
  double o[3], d[3], nearest = static_cast<double>(limit * perT);
  for (int k = 0; k < 3; ++k) {
    o[k] = static_cast<double>(ray.origin[k]);
    d[k] = static_cast<double>(ray.direction[k] / perT);
  }
  std::vector<Candidate> all;
  const IndexWalk walk(o, d);
  const auto consider = [&](std::uint32_t solid) {
    if (const Cut* c = note(ray, solid, all)) nearest = std::min(nearest, static_cast<double>(c->t * perT));
  };
  if (index_ == nullptr && cast_++ < fewCasts) {
    for (std::uint32_t solid = 0; solid < world_.solids.size(); ++solid) {
      const auto box = boundsOf(world_.solids.shape(solid));
      if (!box || walk.meets(box->lo, box->hi, nearest)) consider(solid);
    }
    return all;  // by index already
  }
  if (index_ == nullptr) std::call_once(built_, [&] { own_ = std::make_unique<Index>(buildIndex(world_)); });
  walk.visit(index_ != nullptr ? *index_ : *own_, nearest, consider);
  std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) { return a.solid < b.solid; });
  return all;
}

ExactHit SecondPass::cast(const RayQ& ray, std::optional<f128> tMax) const {
  return nearest(ray, candidates(ray, tMax.value_or(HUGE_VALQ)), tMax);
}

ExactHit SecondPass::castAmong(const RayQ& ray, std::span<const std::uint32_t> solids) const {
  std::vector<Candidate> all;
  for (const std::uint32_t solid : solids) note(ray, solid, all);
  return nearest(ray, all, std::nullopt);
}

ExactHit SecondPass::nearest(const RayQ& ray, std::span<const Candidate> candidates, std::optional<f128> tMax) const {
  ExactHit best;
  for (const auto& [solid, c] : candidates) {
    const Shape shape = world_.solids[solid].shape;
    // Near the limit or the best so far, a free ray has rationals to tell; else they count as equal.
    if (tMax) {
      bool open = ray.rational && fabsq(c.t - *tMax) <= slack() * *tMax;
      if (open ? rationalOrder(shape, static_cast<double>(*tMax), ray) >= 0 : c.t >= *tMax) continue;
    }
    if (best && fabsq(c.t - best.t) <= slack() * best.t) {
      const Shape other = world_.solids[static_cast<std::size_t>(best.index)].shape;
      if (!ray.rational || rationalOrder(shape, other, ray) >= 0) continue;
    } else if (best && c.t > best.t) {
      continue;
    }
    best = {static_cast<std::int32_t>(solid), c.t};
  }
  return best;
}

ExactHit SecondPass::castAt(const RayQ& ray, std::int32_t index) const {
  Cut c = cutOf(world_.solids.shape(static_cast<std::size_t>(index)), ray);
  return c.hit ? ExactHit{index, c.t} : ExactHit{};
}

Surface SecondPass::surface(const RayQ& ray, const ExactHit& hit) const {
  return world_.solids.shape(static_cast<std::size_t>(hit.index)).visit([&](const auto& s) {
    return solidcast::surface(s, ray, hit.t);
  });
}

void inParallel(std::size_t n, const std::function<void(std::size_t)>& f, std::size_t share) {
  std::size_t threads = std::min<std::size_t>(std::max(1u, std::thread::hardware_concurrency()), n / share + 1);
  std::atomic<std::size_t> next{0};
  auto work = [&] {
    for (std::size_t first; (first = next.fetch_add(share)) < n;)
      for (std::size_t i = first; i < std::min(n, first + share); ++i) f(i);
  };
  std::vector<std::thread> helpers;
  for (std::size_t i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  for (std::thread& t : helpers) t.join();
}

}  // namespace solidcast
