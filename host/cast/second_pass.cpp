#include "host/cast/second_pass.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "host/cast/rational_pass.h"
#include "host/cast/solids/all.h"

namespace solidcast {
namespace {

Cut cutOf(const Shape& shape, const RayQ& ray) {
  Cut c = std::visit([&](const auto& s) { return cut(s, ray); }, shape);
  return c.close && ray.rational ? rationalCut(shape, ray) : c;
}

}  // namespace

SecondPass::SecondPass(const World& world) : world_(world) {
  balls_.reserve(world.solids.size());
  for (const SolidEntry& solid : world.solids) {
    Ball b = std::visit([](const auto& s) { return ball(s); }, solid.shape);
    double size = std::abs(b.center[0]) + std::abs(b.center[1]) + std::abs(b.center[2]);
    // 2^-40 of all sizes: far above fp64's rounding of the ball itself.
    b.radius = b.radius < 0 || !std::isfinite(b.radius) ? -1 : b.radius + std::ldexp(b.radius + size, -40);
    balls_.push_back(b);
  }
}

ExactHit SecondPass::cast(const RayQ& ray, std::optional<f128> tMax) const {
  const double o[3] = {static_cast<double>(ray.origin.x), static_cast<double>(ray.origin.y),
                       static_cast<double>(ray.origin.z)};
  V3 unit = normalized(ray.direction);
  const double d[3] = {static_cast<double>(unit.x), static_cast<double>(unit.y), static_cast<double>(unit.z)};
  ExactHit best;
  for (std::size_t i = 0; i < balls_.size(); ++i) {
    const Ball& ball = balls_[i];
    if (ball.radius >= 0) {  // the ray passes the ball by: |f|^2 - (f.d)^2 > r^2, with fp64's rounding granted
      double f[3], along = 0, square = 0;
      for (int k = 0; k < 3; ++k) {
        f[k] = ball.center[static_cast<std::size_t>(k)] - o[k];
        along += f[k] * d[k];
        square += f[k] * f[k];
      }
      if (square - along * along > ball.radius * ball.radius + 1e-12 * square) continue;
    }
    const Shape& shape = world_.solids[i].shape;
    Cut c = cutOf(shape, ray);
    if (!c.hit) continue;
    // Near the limit or the best so far, a free ray has rationals to tell; else they count as equal.
    if (tMax) {
      bool open = ray.rational && fabsq(c.t - *tMax) <= slack() * *tMax;
      if (open ? rationalOrder(shape, static_cast<double>(*tMax), ray) >= 0 : c.t >= *tMax) continue;
    }
    if (best && fabsq(c.t - best.t) <= slack() * best.t) {
      const Shape& other = world_.solids[static_cast<std::size_t>(best.index)].shape;
      if (!ray.rational || rationalOrder(shape, other, ray) >= 0) continue;
    } else if (best && c.t > best.t) {
      continue;
    }
    best = {static_cast<std::int32_t>(i), c.t};
  }
  return best;
}

ExactHit SecondPass::castAt(const RayQ& ray, std::int32_t index) const {
  Cut c = cutOf(world_.solids[static_cast<std::size_t>(index)].shape, ray);
  return c.hit ? ExactHit{index, c.t} : ExactHit{};
}

Surface SecondPass::surface(const RayQ& ray, const ExactHit& hit) const {
  return std::visit([&](const auto& s) { return solidcast::surface(s, ray, hit.t); },
                    world_.solids[static_cast<std::size_t>(hit.index)].shape);
}

void inParallel(std::size_t n, const std::function<void(std::size_t)>& f) {
  constexpr std::size_t share = 64;
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
