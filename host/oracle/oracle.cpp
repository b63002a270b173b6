#include "host/oracle/oracle.h"

#include <algorithm>
#include <type_traits>
#include <variant>

#include "host/oracle/forms.h"

namespace solidcast::oracle {
namespace {

constexpr double kUlps = 0x1p24;        // margins are given in units of 2^-24
constexpr double kTAccuracy = 0x1p-48;  // relative; 2^-24 fp32 ulps
constexpr double kSurfaceAccuracy = 0x1p-40;

template <class N>
RayOf<N> rayOf(const Ray128& ray) {
  RayOf<N> result;
  for (int i = 0; i < 3; ++i) {
    result.origin[i] = N::of(ray.origin[i]);
    result.direction[i] = N::of(ray.direction[i]);
  }
  if constexpr (std::is_same_v<N, Bounded<long double>>) {
    result.exactInputs = true;
    for (int i = 0; i < 3; ++i) {
      if (result.origin[i].value != ray.origin[i]) result.exactInputs = false;
    }
  } else {
    result.exactInputs = true;
  }
  return result;
}

// What is reported of the surface, in N; `normal` of any length.
template <class N>
struct Surface {
  Vector<N> position, local, normal;
};

template <class N>
bool vanishes(const Vector<N>& v) {
  return std::all_of(v.begin(), v.end(), [](const N& x) { return signOf(x).is == 0; });
}

template <class S, class N>
Surface<N> surfaceAt(const S& shape, const RayOf<N>& ray, const Solution<N>& solution, const N& s) {
  Surface<N> surface;
  surface.position = ray.origin + s * ray.direction;
  surface.normal = solution.normal;
  surface.local = surface.position;
  if constexpr (std::is_same_v<S, Triangle> || std::is_same_v<S, Quad>) {
    for (int i = 0; i < 3; ++i) surface.local[i] = ratio(solution.weights[i], solution.weightSum);
  } else if constexpr (std::is_same_v<S, Sphere>) {
    surface.normal = between(ray.origin, vectorOf<N>(shape.center), ray.exactInputs) + s * ray.direction;
  } else if constexpr (std::is_same_v<S, Quadric>) {
    surface.normal = gradient(shape.coefficients, surface.position, true);
    if constexpr (std::is_same_v<N, Exact>) {
      // A simple root has gradient.direction = +-sqrt(D) != 0, so only a double one can be a singular point. There s
      // is a/b, and b times the gradient is evaluated without rounding.
      if (solution.maybeApex) {
        const auto& q = shape.coefficients;
        const N &a = solution.root.a, &b = solution.root.b;
        Vector<N> g = gradient(q, b * ray.origin + a * ray.direction, false);
        for (int i = 0; i < 3; ++i) g[i] = g[i] + b * N::of(q[6 + i]);
        if (vanishes(g)) surface.normal = Vector<N>{} - ray.direction;
      }
    }
  }
  return surface;
}

// To binary128; false where the error exceeds kSurfaceAccuracy of the largest component.
template <class T>
bool settle(const Vector<Bounded<T>>& v, Real3& result) {
  double largest = 0, error = 0;
  for (int i = 0; i < 3; ++i) {
    result[i] = v[i].value;
    largest = std::fmax(largest, static_cast<double>(magnitude(v[i].value)));
    error = std::fmax(error, Bounded<T>::kError * v[i].terms);
  }
  return error <= kSurfaceAccuracy * largest;
}
bool settle(const Vector<Exact>& v, Real3& result) {
  for (int i = 0; i < 3; ++i) result[i] = v[i].value.rounded();
  return true;
}

void normalise(Real3& v) {
  const Real largest = std::max({magnitude(v[0]), magnitude(v[1]), magnitude(v[2])});
  int exponent = 0;
  frexpq(largest, &exponent);
  for (Real& x : v) x = ldexpq(x, -exponent);
  const Real length = sqrtq(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (Real& x : v) x /= length;
}

template <class T>
bool accurate(const Bounded<T>& s) {
  // terms = |s| (1 + 2 error / kError), see evaluate().
  const double size = static_cast<double>(magnitude(s.value));
  return s.terms <= size * (1 + 2 * kTAccuracy / Bounded<T>::kError);
}
bool accurate(const Exact&) { return true; }
template <class T>
Real valueOf(const Bounded<T>& s) {
  return s.value;
}
Real valueOf(const Exact& s) { return s.value.rounded(); }

// t < tMax, with the relative distance between them.
template <class T>
Claim before(const Root<Bounded<T>>&, const Bounded<T>& s, const Ray128& ray) {
  const Real t = s.value * ray.length, gap = ray.tMax - t;
  if (magnitude(gap) <= 2 * Real(Bounded<T>::kError * s.terms) * ray.length) return {};
  return {gap > 0 ? Claim::yes : Claim::no, static_cast<double>(magnitude(gap) / (t + ray.tMax))};
}
Claim before(const Root<Exact>& root, const Exact& s, const Ray128& ray) {
  const Root<Exact> limit{Root<Exact>::rational, Exact::of(ray.tMax), Exact::of(ray.length), Exact{}};
  const Real t = s.value.rounded() * ray.length;
  return {compare(root, limit) < 0 ? Claim::yes : Claim::no,
          static_cast<double>(magnitude(ray.tMax - t) / (t + ray.tMax))};
}

// False: this arithmetic does not decide, or not accurately enough.
template <class N, class S>
bool attempt(const S& shape, const Ray128& given, Truth& truth) {
  const RayOf<N> ray = rayOf<N>(given);
  const Solution<N> solution = solve(shape, ray);
  Claim claim = solution.claim;
  if (claim.answer == Claim::doubt) return false;
  N s{};
  if (claim.answer == Claim::yes) {
    s = evaluate(solution.root);
    if (!accurate(s)) return false;
    if (!isinfq(given.tMax)) {
      claim = claim && before(solution.root, s, given);
      if (claim.answer == Claim::doubt) return false;
    }
  }
  truth.hit = claim.answer == Claim::yes;
  truth.marginUlps = claim.margin * kUlps;
  if (!truth.hit) return true;
  truth.exactlyOnEdge = claim.onEdge;
  truth.faceMarginUlps = solution.faceMargin * kUlps;
  truth.t = valueOf(s) * given.length;
  const Surface<N> surface = surfaceAt(shape, ray, solution, s);
  if (!settle(surface.position, truth.position) || !settle(surface.local, truth.local) ||
      !settle(surface.normal, truth.normal)) {
    return false;
  }
  normalise(truth.normal);
  return true;
}

Root<Exact> exactRoot(const Shape& shape, const Ray128& ray) {
  return std::visit([&](const auto& s) { return solve(s, rayOf<Exact>(ray)).root; }, shape);
}

}  // namespace

Truth intersect(const Shape& shape, const Ray128& ray, Effort effort) {
  return std::visit(
      [&](const auto& s) {
        Truth truth;
        if (effort == Effort::enough) {
          truth.level = Level::extended;
          if (attempt<Bounded<long double>>(s, ray, truth)) return truth;
          truth = {};
          truth.level = Level::binary128;
          if (attempt<Bounded<Real>>(s, ray, truth)) return truth;
          truth = {};
        }
        truth.level = Level::exact;
        attempt<Exact>(s, ray, truth);
        return truth;
      },
      shape);
}

int compareHits(const Shape& a, const Shape& b, const Ray128& ray) {
  return compare(exactRoot(a, ray), exactRoot(b, ray));
}

WorldTruth cast(const World& world, const Ray128& ray, Effort effort) {
  WorldTruth result;
  const auto consider = [&result](double margin) { result.marginUlps = std::fmin(result.marginUlps, margin); };
  for (std::size_t i = 0; i < world.solids.size(); ++i) {
    const Shape shape = world.solids[i].shape;
    const Truth truth = intersect(shape, ray, effort);
    if (!truth.hit) {
      consider(truth.marginUlps);
      continue;
    }
    int order = -1;  // of this one to the nearest so far
    if (result.index >= 0) {
      const Real gap = truth.t - result.truth.t;
      order = gap < 0 ? -1 : 1;
      if (magnitude(gap) <= 4 * Real(kTAccuracy) * truth.t) {
        order = compareHits(shape, world.solids[static_cast<std::size_t>(result.index)].shape, ray);
      }
    }
    if (order < 0) {
      if (result.index >= 0) result.secondT = result.truth.t;
      result.index = static_cast<std::int32_t>(i);
      result.truth = truth;
      result.tie = false;
    } else {
      result.secondT = std::min(result.secondT, truth.t);
      if (order == 0) result.tie = true;
    }
  }
  if (result.index >= 0) {
    consider(result.truth.marginUlps);
    if (result.secondT < static_cast<Real>(kInfinity)) {
      const Real gap = result.secondT - result.truth.t;
      consider(result.tie ? 0 : static_cast<double>(magnitude(gap) / result.secondT) * kUlps);
    }
  }
  return result;
}

bool flipsWhenTilted(const World& world, const Ray128& ray, double angle) {
  const std::int32_t index = cast(world, ray).index;
  const Real3& d = ray.direction;
  const Real length = sqrtq(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  // Two vectors across d, from the axis that d is farthest from.
  const int axis = static_cast<int>(
      std::min_element(d.begin(), d.end(), [](Real a, Real b) { return magnitude(a) < magnitude(b); }) - d.begin());
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  Real3 u{};
  u[next] = -d[last];
  u[last] = d[next];
  Real3 v{d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]};
  normalise(u);
  normalise(v);
  for (int k = 0; k < 8; ++k) {
    const Real c = cosq(k * M_PIq / 4) * angle * length, s = sinq(k * M_PIq / 4) * angle * length;
    Ray128 tilted = ray;
    for (int i = 0; i < 3; ++i) tilted.direction[i] += c * u[i] + s * v[i];
    if (cast(world, tilted).index != index) return true;
  }
  return false;
}

}  // namespace solidcast::oracle
