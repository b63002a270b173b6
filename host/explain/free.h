// KIND_free of shaders/solids: what fast and exact do for rays with origins of their own (orthographic cameras).
#pragma once
#include <utility>

#include "host/explain/world_quadric.h"

namespace solidcast::explain {

template <class Real>
class Free {
 public:
  using N = Traced<Real>;
  using V = TracedVector<Real>;

  Free(Log<Real>& log, const std::vector<f128>& rows, const V& origin, const V& direction)
      : log_(log), rows_(rows), o_(log.stage("origin o", origin)), d_(log.stage("direction d", direction)) {
    log_.squared = log_.stage("|d|^2", linear(d_, d_));
    length_ = root(log_.squared);
    reach_ = length(o_);
  }

  void plane() {
    const V p = vector("record p0", 0), n = vector("record n", 1);
    const V f = log_.stage("f = p0 - o", p - o_);
    const N distance = log_.stage("n.f", linear(n, f)), towards = log_.stage("n.d", linear(n, d_));
    const N s = log_.stage("s = n.d / n.f", towards / distance);
    log_.countedAgainst("distance n.f", distance, scale(p));
    log_.countedAgainst("slope n.d", towards, length_);
    log_.offer(!zero(distance), s);
  }

  void sphere() {
    const V c = vector("record c", 0);
    N r = log_.stage("record r", at(0, 3)), unit(1);
    V f = log_.stage("f = o - c", o_ - c);
    const N size = scale(c), bound = size * size + r * r;
    if (!log_.exact()) {  // a power of two: rounds nothing
      const N big = larger(larger(larger(magnitude(f.x), magnitude(f.y)), magnitude(f.z)), r);
      unit = Log<Real>::fromExact(powerOfTwo(solidcast::larger(wide(big.shader), f128(0x1p-126))));
      f = f / unit, r = r / unit;
    }
    const N outside = log_.stage("C = |f|^2 - r^2", linear(f, f) - r * r);
    const N b = log_.stage("b = f.d", linear(f, d_));
    N q;
    if (log_.exact()) {
      q = log_.stage("q = b^2 - |d|^2 C", b * b - log_.squared * outside);
    } else {
      const V across = log_.stage("across = f - d b / |d|^2", f - d_ * (b / log_.squared));
      q = log_.stage("q = |d|^2 (r^2 - |across|^2)", log_.squared * (r * r - linear(across, across)));
    }
    const N h = log_.stage("h = sqrt q", root(q));
    const bool inner = outside < N(0) || (zero(outside) && b < N(0)), deep = inner && b < N(0);
    const N numerator = deep ? log_.squared : inner ? h + b : h - b;
    const N denominator = deep ? h - b : magnitude(outside);
    const N s = log_.stage(deep    ? "s = |d|^2 / (h - b)"
                           : inner ? "s = (h + b) / |C|"
                                   : "s = (h - b) / |C|",
                           numerator / denominator);
    log_.countedAgainst("inside or outside C = |f|^2 - r^2", outside, bound);
    log_.countedAgainst("discriminant q", q, log_.squared * bound);
    if (!inner && q >= N(0)) log_.sign("in front: b = f.d", b);
    log_.offer(inner || b < N(0), s / unit);
  }

  void box() {
    const V low = vector("record lo", 0), high = vector("record hi", 1);
    const V lo = log_.stage("lo - o", low - o_), hi = log_.stage("hi - o", high - o_);
    const N size = scale(low) + scale(high);
    N enter(0), leave(0), towardsEnter(0), towardsLeave(0);
    bool unbounded = true, miss = false;
    for (int i = 0; i < 3; ++i) {
      if (zero(d_[i])) {
        miss = miss || N(0) < lo[i] || hi[i] < N(0);
        log_.countedAgainst("lo - o, ray along the slab", lo[i], size);
        log_.countedAgainst("hi - o, ray along the slab", hi[i], size);
        continue;
      }
      const bool forwards = N(0) < d_[i];
      const N first = (forwards ? lo[i] : hi[i]) / d_[i], second = (forwards ? hi[i] : lo[i]) / d_[i];
      if (unbounded || enter < first) enter = first, towardsEnter = magnitude(d_[i]);
      if (unbounded || second < leave) leave = second, towardsLeave = magnitude(d_[i]);
      unbounded = false;
    }
    enter = log_.stage("enter = greatest (face - o) / d_i", enter);
    leave = log_.stage("leave = least (face - o) / d_i", leave);
    const N interval = log_.stage("leave - enter", leave - enter);
    log_.countedAgainst("interval leave - enter", interval, magnitude(leave) + magnitude(enter));
    log_.countedAgainst("in front: enter", enter * towardsEnter, size);
    log_.countedAgainst("in front: leave", leave * towardsLeave, size);
    const bool outside = N(0) < enter;
    const N t = outside ? enter : leave;
    const bool hit = !miss && leave >= enter && N(0) < t;
    log_.countedAgainst("|d_i| of the face", hit ? (outside ? towardsEnter : towardsLeave) : length_, length_, false);
    log_.offer(hit, N(1) / t);
  }

  void disc() {
    const V c = vector("record c", 0), n = vector("record n", 1);
    const V f = log_.stage("f = c - o", c - o_);
    const N distance = log_.stage("n.f", linear(n, f)), towards = log_.stage("n.d", linear(n, d_)), radius = at(1, 3);
    V q = log_.stage("q = d (n.f) - f (n.d)", d_ * distance - f * towards);
    N r = radius * towards;
    if (!log_.exact()) {
      const N unit = larger(larger(larger(magnitude(q.x), magnitude(q.y)), magnitude(q.z)), magnitude(r));
      if (N(0) < unit) q = q / unit, r = r / unit;
    }
    const N inside = log_.stage("(r n.d)^2 - |q|^2", r * r - linear(q, q));
    const N reach = scale(c);
    const bool within = inside >= N(0);
    log_.countedAgainst("rim (r n.d)^2 - |q|^2", inside, log_.squared * (reach * reach + radius * radius));
    log_.countedAgainst("distance n.f", within ? distance : reach, reach);
    log_.countedAgainst("slope n.d", within ? towards : N(1), length_);
    log_.offer(within && !zero(distance) && !zero(towards), log_.stage("s = n.d / n.f", towards / distance));
  }

  void triangle() { span(false); }
  void quad() { span(true); }

  void quadric() {
    const WorldQuadric<Real> Q(
        log_, [this](int row, int column) { return at(row, column); }, o_, d_);
    N A = Q.A, B = Q.B, C = Q.C;
    const N size = length(Q.m) + N(2) * length(Q.n), slope = size * reach_ + length(Q.l);
    const N cScale = (size * reach_ + N(2) * length(Q.l)) * reach_ + magnitude(Q.j);
    if (C < N(0)) A = -A, B = -B, C = -C;
    const N q = log_.stage("q = B^2 - C A", B * B - C * A);
    const N h = log_.stage("h = sqrt q", root(q));
    const bool away = N(0) < B, on = zero(C);
    const N sum = h + magnitude(B);
    const N s = away || on ? log_.stage(away ? "s = -A / (h + B)" : "s = -A / (2B)", -A / (away ? sum : B + B))
                           : log_.stage("s = (h - B) / C", sum / C);
    const N whole = slope * slope + cScale * size;
    log_.countedAgainst("inside or outside C = Q(o)", C, cScale);
    log_.countedAgainst("discriminant q = B^2 - C A", q, log_.squared * whole);
    log_.countedAgainst("h (h + |B|), accuracy of s", q < N(0) ? whole : h * sum, log_.squared * whole, false);
    if (away) log_.countedAgainst("A = d'Md, sign of s", A, log_.squared * size);
    log_.offer(N(0) < s, s);
  }

 private:
  N at(int row, int column) const { return fromRecord<Real>(rows_[static_cast<std::size_t>(4 * row + column)]); }
  V vector(const std::string& name, int i) { return log_.stage(name, V{at(i, 0), at(i, 1), at(i, 2)}); }
  static bool zero(const N& x) { return wide(x.shader) == 0; }
  /// hit.glsl: originScale() of a camera's grid of origins.
  N scale(const V& point) const { return length(point) + reach_; }

  void span(bool quad) {
    const V v1 = vector("record v1", 0), e1 = vector("record e1", 1), e2 = vector("record e2", 2);
    const V f = log_.stage("f = o - v1", o_ - v1);
    const V p = log_.stage("p = d x e2", cross(d_, e2));
    const N det = log_.stage("determinant e1.p", linear(e1, p));
    const bool turned = det < N(0);
    const N sign(turned ? -1 : 1), u = log_.stage("u = f.p", sign * linear(f, p));
    const V q = log_.stage("q = f x e1", cross(f, e1));
    const N v = log_.stage("v = d.q", sign * linear(d_, q)), distance = log_.stage("e2.q", sign * linear(e2, q));
    const N size = magnitude(det);
    const N third = quad ? size - larger(u, v) : size - u - v;
    const N inside = log_.stage(quad ? "least of u, v, |det| - u, |det| - v" : "least of u, v, |det| - u - v",
                                smaller(smaller(u, v), third));
    const N reach = scale(v1), l1 = length(e1), l2 = length(e2);
    const bool hit = inside >= N(0) && !zero(det);
    log_.countedAgainst("edge: least of u, v and the rest", inside, length_ * (reach * (l1 + l2) + l1 * l2));
    log_.countedAgainst("determinant e1.(d x e2)", det, length_ * l1 * l2);
    if (hit) log_.countedAgainst("in front: e2.q", distance, reach * l1 * l2);
    log_.offer(hit && !zero(distance), log_.stage("s = |det| / e2.q", size / distance));
  }

  Log<Real>& log_;
  const std::vector<f128>& rows_;
  V o_, d_;
  N length_, reach_;
};

}  // namespace solidcast::explain
