// Formulas without a care for rounding: the numbers are GMP's rationals, and t = u + v sqrt(q) is compared by squaring.
#include "host/cast/rational_pass.h"

#include <gmpxx.h>

#include <array>
#include <variant>

namespace solidcast {
namespace {

using Q = mpq_class;
using Q3 = std::array<Q, 3>;

Q3 exact(const Triple& v) { return {Q(v[0]), Q(v[1]), Q(v[2])}; }
Q3 exact(const V3& v) {
  return {Q(static_cast<double>(v.x)), Q(static_cast<double>(v.y)), Q(static_cast<double>(v.z))};
}
Q3 minus(const Q3& a, const Q3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Q dot(const Q3& a, const Q3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Q3 cross(const Q3& a, const Q3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Line {
  Q3 origin, direction;
  explicit Line(const RayQ& ray) : origin(exact(ray.origin)), direction(exact(ray.direction)) {}
};

/// t = u + v sqrt(q), q >= 0.
struct Root {
  bool hit = false;
  Q u, v, q;
};

/// Of u + v sqrt(q).
int signOf(const Q& u, const Q& v, const Q& q) {
  const int su = sgn(u), sv = sgn(v) * sgn(q);
  if (su == sv || sv == 0) return su;
  if (su == 0) return sv;
  return su * sgn(Q(u * u - v * v * q));
}

int order(const Root& a, const Root& b) {
  // X = (a.u - b.u) + a.v sqrt(a.q) against Y = b.v sqrt(b.q)
  const Q u = a.u - b.u;
  const int x = signOf(u, a.v, a.q), y = sgn(b.v) * sgn(b.q);
  if (x != y) return x < y ? -1 : 1;
  if (x == 0) return 0;
  return x * signOf(Q(u * u + a.v * a.v * a.q - b.v * b.v * b.q), Q(2 * u * a.v), a.q);  // X^2 - Y^2
}

f128 rounded(const mpf_class& x) {
  long exponent = 0;
  if (mpf_get_d_2exp(&exponent, x.get_mpf_t()) == 0) return 0;
  mpf_class rest = x;
  if (exponent > 0) mpf_div_2exp(rest.get_mpf_t(), rest.get_mpf_t(), static_cast<unsigned long>(exponent));
  else mpf_mul_2exp(rest.get_mpf_t(), rest.get_mpf_t(), static_cast<unsigned long>(-exponent));
  f128 sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double part = rest.get_d();
    sum += part;
    rest -= part;
  }
  return ldexpq(sum, static_cast<int>(exponent));
}

f128 valueOf(const Root& root) {
  constexpr mp_bitcnt_t bits = 320;
  const mpf_class u(root.u, bits), v(root.v, bits);
  if (sgn(root.v) == 0) return rounded(u);
  const mpf_class h = v * sqrt(mpf_class(root.q, bits));
  if (sgn(u) * sgn(h) >= 0) return rounded(mpf_class(u + h, bits));
  // Of opposite signs: (u^2 - v^2 q)/(u - v sqrt q) does not cancel.
  const mpf_class numerator(Q(root.u * root.u - root.v * root.v * root.q), bits);
  return rounded(mpf_class(numerator / mpf_class(u - h, bits), bits));
}

Root rational(const Q& t) { return {sgn(t) > 0, t, 0, 0}; }

Root plane(const Q3& n, const Q3& p, const Line& ray) {
  const Q towards = dot(n, ray.direction);
  if (sgn(towards) == 0) return {};
  return rational(Q(dot(n, minus(p, ray.origin)) / towards));
}

Root root(const InfinitePlane& s, const Line& ray) { return plane(exact(s.normal), exact(s.origin), ray); }

Root root(const Disc& s, const Line& ray) {
  const Root t = plane(exact(s.normal), exact(s.center), ray);
  if (!t.hit) return {};
  Q3 p = minus(ray.origin, exact(s.center));
  for (std::size_t i = 0; i < 3; ++i) p[i] += t.u * ray.direction[i];
  const Q r(s.radius);
  return dot(p, p) <= r * r ? t : Root{};
}

Root spanned(const Q3& v1, const Q3& e1, const Q3& e2, bool quad, const Line& ray) {
  const Q3 n = cross(e1, e2), f = minus(ray.origin, v1);
  const Q det = -dot(n, ray.direction);
  if (sgn(det) == 0) return {};
  const Q beta = dot(cross(ray.direction, e2), f) / det, gamma = dot(cross(e1, ray.direction), f) / det;
  if (beta < 0 || gamma < 0) return {};
  if (quad ? beta > 1 || gamma > 1 : beta + gamma > 1) return {};
  return plane(n, v1, ray);
}

Root root(const Triangle& s, const Line& ray) {
  const Q3 v1 = exact(s.v1);
  return spanned(v1, minus(exact(s.v2), v1), minus(exact(s.v3), v1), false, ray);
}
Root root(const Quad& s, const Line& ray) {
  return spanned(exact(s.vertex), exact(s.span1), exact(s.span2), true, ray);
}

/// Where the ray enters and leaves slab i of a box that is not parallel to it.
std::array<Q, 2> slab(const AABox& box, const Line& ray, std::size_t i) {
  const Q a = (Q(box.corner1[i]) - ray.origin[i]) / ray.direction[i];
  const Q b = (Q(box.corner2[i]) - ray.origin[i]) / ray.direction[i];
  if (a < b) return {a, b};
  return {b, a};
}

Root root(const AABox& s, const Line& ray) {
  std::optional<Q> enter, leave;
  for (std::size_t i = 0; i < 3; ++i) {
    if (sgn(ray.direction[i]) == 0) {
      const int a = sgn(Q(s.corner1[i] - ray.origin[i])), b = sgn(Q(s.corner2[i] - ray.origin[i]));
      if (a * b > 0) return {};
      continue;
    }
    const auto [first, second] = slab(s, ray, i);
    if (!enter || first > *enter) enter = first;
    if (!leave || second < *leave) leave = second;
  }
  if (!enter || *enter > *leave) return {};
  return rational(sgn(*enter) > 0 ? *enter : *leave);
}

/// A t^2 + 2 B t + C = 0
Root smallest(const Q& A, const Q& B, const Q& C) {
  if (sgn(A) == 0) return sgn(B) == 0 ? Root{} : rational(Q(-C / (2 * B)));
  const Q q = B * B - A * C;
  if (sgn(q) < 0) return {};
  const Q u = -B / A, v = 1 / abs(A);
  if (signOf(u, Q(-v), q) > 0) return {true, u, -v, q};
  if (signOf(u, v, q) > 0) return {true, u, v, q};
  return {};
}

Root root(const Sphere& s, const Line& ray) {
  const Q3 f = minus(ray.origin, exact(s.center));
  const Q r(s.radius);
  return smallest(dot(ray.direction, ray.direction), dot(f, ray.direction), Q(dot(f, f) - r * r));
}

Root root(const Quadric& s, const Line& ray) {
  std::array<Q, 10> c;
  for (std::size_t i = 0; i < 10; ++i) c[i] = Q(s.coefficients[i]);
  // 2 a'Mb without the halves of the mixed coefficients
  const auto form = [&c](const Q3& a, const Q3& b) {
    return Q(2 * (c[0] * a[0] * b[0] + c[1] * a[1] * b[1] + c[2] * a[2] * b[2]) + c[3] * (a[0] * b[1] + a[1] * b[0]) +
             c[4] * (a[0] * b[2] + a[2] * b[0]) + c[5] * (a[1] * b[2] + a[2] * b[1]));
  };
  const Q3 l{c[6], c[7], c[8]};
  const Q3 &o = ray.origin, &d = ray.direction;
  // Everything twice: A, B, C with Q(o + t d) = A t^2 + 2 B t + C.
  return smallest(form(d, d), Q(form(o, d) + dot(l, d)), Q(form(o, o) + 2 * dot(l, o) + 2 * c[9]));
}

Root rootOf(const Shape& shape, const RayQ& ray) {
  return std::visit([line = Line(ray)](const auto& s) { return root(s, line); }, shape);
}

}  // namespace

Cut rationalCut(const Shape& shape, const RayQ& ray) {
  const Root t = rootOf(shape, ray);
  return t.hit ? Cut{true, valueOf(t)} : Cut{};
}

int rationalOrder(const Shape& a, const Shape& b, const RayQ& ray) { return order(rootOf(a, ray), rootOf(b, ray)); }

int rationalOrder(const Shape& shape, double limit, const RayQ& ray) {
  return order(rootOf(shape, ray), {true, Q(limit), 0, 0});
}

int rationalFace(const AABox& box, const RayQ& ray, bool entering) {
  const Line line(ray);
  int face = -1;
  Q best;
  for (std::size_t i = 0; i < 3; ++i) {
    if (sgn(line.direction[i]) == 0) continue;
    const Q t = slab(box, line, i)[entering ? 0 : 1];
    if (face >= 0 && (entering ? t <= best : t >= best)) continue;
    face = static_cast<int>(i);
    best = t;
  }
  return face;
}

}  // namespace solidcast
