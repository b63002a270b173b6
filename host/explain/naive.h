// KIND_naive of shaders/solids: the textbook in fp32, in t and world coordinates.
#pragma once
#include "host/explain/world_quadric.h"

namespace solidcast::explain {

class Naive {
 public:
  using N = Traced<float>;
  using V = TracedVector<float>;

  Naive(Log<float>& log, const std::vector<f128>& rows, const V& origin, const V& direction)
      : log_(log), rows_(rows), o_(log.stage("origin o", origin)), d_(log.stage("direction d", direction)) {}

  void plane() {
    const V p = vector("record p0", 0), n = vector("record n", 1);
    const N offset = log_.stage("D = -n.p0", -linear(n, p)), towards = log_.stage("n.d", linear(n, d_));
    const N distance = log_.stage("n.o + D", linear(n, o_) + offset);
    log_.sign("slope n.d", towards);
    log_.sign("distance n.o + D", distance);
    log_.offerNaive(!zero(towards), log_.stage("t = -(n.o + D) / n.d", -distance / towards));
  }

  void sphere() {
    const V c = vector("record c", 0);
    const N r = log_.stage("record r", at(0, 3));
    const V f = log_.stage("f = o - c", o_ - c);
    const N a = log_.stage("a = |d|^2", linear(d_, d_)), b = log_.stage("b = f.d", linear(f, d_));
    const N C = log_.stage("C = |f|^2 - r^2", linear(f, f) - r * r);
    const N q = log_.stage("q = b^2 - a C", b * b - a * C);
    const N h = log_.stage("h = sqrt q", root(q));
    const N near = (-b - h) / a, far = (-b + h) / a;
    const bool outside = N(0) < near;
    log_.sign("discriminant q = b^2 - a C", q);
    if (q >= N(0)) log_.sign("in front: -b - h", -b - h);
    log_.offerNaive(q >= N(0), outside ? log_.stage("t = (-b - h) / a", near) : log_.stage("t = (-b + h) / a", far));
  }

  void box() {
    const V low = vector("record lo", 0), high = vector("record hi", 1);
    const V inverse = log_.stage("1 / d", V{N(1) / d_.x, N(1) / d_.y, N(1) / d_.z});
    const V a = log_.stage("(lo - o) (1/d)", times(low - o_, inverse));
    const V b = log_.stage("(hi - o) (1/d)", times(high - o_, inverse));
    const V first{least(a.x, b.x), least(a.y, b.y), least(a.z, b.z)};
    const V second{most(a.x, b.x), most(a.y, b.y), most(a.z, b.z)};
    const N enter = log_.stage("enter = greatest (face - o) (1/d_i)", most(most(first.x, first.y), first.z));
    const N leave = log_.stage("leave = least (face - o) (1/d_i)", least(least(second.x, second.y), second.z));
    const N t = N(0) < enter ? enter : leave;
    log_.sign("interval leave - enter", log_.stage("leave - enter", leave - enter));
    if (leave >= enter) log_.sign("in front: enter or leave", t);
    log_.offerNaive(leave >= enter, t);
  }

  void disc() {
    const V c = vector("record c", 0), n = vector("record n", 1);
    const N towards = log_.stage("n.d", linear(n, d_)), r = at(1, 3);
    const N distance = log_.stage("n.(c - o)", linear(n, c - o_));
    const N t = log_.stage("t = n.(c - o) / n.d", distance / towards);
    const V p = log_.stage("p = o + t d", o_ + d_ * t);
    const V q = log_.stage("q = p - c", p - c);
    const N square = log_.stage("|q|^2", linear(q, q)), limit = r * r;
    log_.sign("rim r^2 - |q|^2", limit - square);
    log_.sign("in front: t", t);
    log_.offerNaive(limit >= square, t);
  }

  void triangle() { span(false); }
  void quad() { span(true); }

  void quadric() {
    const WorldQuadric<float> Q(
        log_, [this](int row, int column) { return at(row, column); }, o_, d_);
    const N &A = Q.A, &B = Q.B, &C = Q.C;
    const N q = log_.stage("q = B^2 - A C", B * B - A * C);
    const N h = log_.stage("h = sqrt q", root(q));
    const N t1 = (-B - h) / A, t2 = (-B + h) / A;
    const N near = least(t1, t2), far = most(t1, t2);
    log_.sign("discriminant q = B^2 - A C", q);
    if (zero(A)) return log_.offerNaive(true, log_.stage("t = -C / (2B), as A is 0", -C / (N(2) * B)));
    log_.sign("which root: A", A);
    const N t = N(0) < near ? log_.stage("t = (-B -+ h) / A, the nearer", near)
                            : log_.stage("t = (-B +- h) / A, the farther", far);
    log_.offerNaive(q >= N(0), t);
  }

 private:
  N at(int row, int column) const { return fromRecord<float>(rows_[static_cast<std::size_t>(4 * row + column)]); }
  V vector(const std::string& name, int i) { return log_.stage(name, V{at(i, 0), at(i, 1), at(i, 2)}); }
  static bool zero(const N& x) { return x.shader == 0; }
  static V times(const V& a, const V& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
  // With NaN (0 times infinity) the other operand, as llvmpipe's min and max; GLSL leaves it open.
  static N least(const N& a, const N& b) { return std::isnan(a.shader) || b < a ? b : a; }
  static N most(const N& a, const N& b) { return std::isnan(a.shader) || a < b ? b : a; }

  /// Moeller and Trumbore.
  void span(bool quad) {
    const V v1 = vector("record v1", 0), e1 = vector("record e1", 1), e2 = vector("record e2", 2);
    const V p = log_.stage("p = d x e2", cross(d_, e2));
    const N det = log_.stage("determinant e1.p", linear(e1, p));
    const N inverse = log_.stage("1 / determinant", N(1) / det);
    const V f = log_.stage("f = o - v1", o_ - v1);
    const N u = log_.stage("u = f.p / det", linear(f, p) * inverse);
    const V q = log_.stage("q = f x e1", cross(f, e1));
    const N v = log_.stage("v = d.q / det", linear(d_, q) * inverse);
    const N t = log_.stage("t = e2.q / det", linear(e2, q) * inverse);
    const N uv = u + v;
    log_.sign("determinant e1.(d x e2)", det);
    log_.sign("edge u", u);
    log_.sign("edge v", v);
    if (quad) {
      log_.sign("edge 1 - u", N(1) - u);
      log_.sign("edge 1 - v", N(1) - v);
    } else {
      log_.sign("edge 1 - (u + v)", N(1) - uv);
    }
    log_.sign("in front: t", t);
    const bool within = quad ? N(1) >= u && N(1) >= v : N(1) >= uv;
    log_.offerNaive(!zero(det) && u >= N(0) && v >= N(0) && within, t);
  }

  Log<float>& log_;
  const std::vector<f128>& rows_;
  V o_, d_;
};

}  // namespace solidcast::explain
