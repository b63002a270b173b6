// Prepared forms, KIND_eye of shaders/solids: what fast and exact do for one shared origin. Names of the stages are those
// of the shaders' head comments.
#pragma once
#include <string>

#include "host/explain/log.h"

namespace solidcast::explain {

template <class Real>
class Eye {
 public:
  using N = Traced<Real>;
  using V = TracedVector<Real>;

  Eye(Log<Real>& log, const std::vector<f128>& rows, const V& direction, const V& world)
      : log_(log), rows_(rows), d_(log.stage("direction d", direction)), world_(world) {
    log_.squared = log_.stage("|d|^2", linear(d_, d_));
  }

  void plane() {
    const V m = vector("record m = n / n.(p0-o)", 0);
    const N s = log_.stage("s = m.d", linear(m, d_));
    log_.counted("s = m.d", s, at(1, 1));
    log_.offer(true, s);
  }

  void sphere() {
    const V f = vector("record f = o - c", 0);
    const N C = log_.stage("record C = |f|^2 - r^2", at(0, 3));
    const N b = log_.stage("b = f.d", linear(f, d_));
    N q;
    if (log_.setting.farSphere) {
      const N inverse = log_.stage("1 / |d|^2", N(1) / log_.squared);
      const V across = log_.stage("across = f - d b / |d|^2", f - d_ * (b * inverse));
      q = log_.stage("q = |d|^2 (r^2 - |across|^2)", log_.squared * (at(1, 3) - linear(across, across)));
    } else {
      q = log_.stage("q = b^2 - |d|^2 C", b * b - log_.squared * C);
    }
    const N h = log_.stage("h = sqrt q", root(q));
    const N difference = log_.stage("h - b", h - b);
    const N s = log_.stage("s = (h - b) / |C|", at(1, 0) * difference);
    log_.counted("discriminant q", q, N(1));
    if (q >= N(0)) log_.sign("in front: h - b", difference);
    log_.offer(true, s);
  }

  void box() {
    const V a = vector("record upper bounds", 0), c = row(1), l1 = vector("record lower bounds", 2), l2 = row(3);
    const V d = log_.stage("d in world axes", world_);
    const V ups{d.x * a.x + c.x, d.y * a.y + c.y, d.z * a.z + c.z};
    const V los{larger(d.x * l1.x, d.x * l2.x), larger(d.y * l1.y, d.y * l2.y), larger(d.z * l1.z, d.z * l2.z)};
    const N up = log_.stage("up = least upper bound of s", smaller(smaller(ups.x, ups.y), ups.z));
    const N lo = log_.stage("lo = greatest lower bound of s", larger(larger(los.x, los.y), los.z));
    const bool inner = N(0) < at(1, 3), hit = up >= lo;
    const N s = inner ? lo : up;
    const bool onX = inner ? los.x >= s : s >= ups.x, onY = inner ? los.y >= s : s >= ups.y;
    const N towards = magnitude(onX ? d.x : onY ? d.y : d.z);
    if (!inner) log_.counted("interval up - lo", log_.stage("up - lo", up - lo), at(2, 3));
    if (log_.setting.grazing && hit) log_.counted("|d_i| of the face, flat angle", towards, at(3, 3), false);
    if (log_.setting.boxOnFace)
      for (int i = 0; i < 3; ++i)
        if (wide(at(4, i).shader) < 1 || wide(d[i].shader) == 0)  // a weight of 2^100 is none, but 0 is doubt
          log_.counted(std::string("d.") + "xyz"[i] + ", eye near a face's plane", d[i], at(4, i), false);
    log_.offer(hit, s);
  }

  void disc() {
    const V m = vector("record m = n / n.(c-o)", 0), U = vector("record U", 1), W = vector("record V", 2);
    const N s = log_.stage("s = m.d", linear(m, d_));
    const N u = log_.stage("u = U.d", linear(U, d_)), v = log_.stage("v = V.d", linear(W, d_));
    const N inside = log_.stage("s^2 - u^2 - v^2", s * s - (u * u + v * v));
    log_.counted("rim s^2 - u^2 - v^2", inside, at(3, 0));
    flat(inside, s);
  }

  void triangle() { span({"edge U.d", "edge V.d", "edge (m-U-V).d"}); }
  void quad() { span({"edge U.d", "edge V.d", "edge (m-U).d", "edge (m-V).d"}); }

  void quadric() {
    const V m = row(0), n = row(1), w = vector("record w = M o + l", 2);
    const N C = log_.stage("record C = Q(o)", at(0, 3));
    V diagonal = log_.stage("record M, diagonal", m), mixed = log_.stage("record M, mixed", n);
    const V g{linear(V{diagonal.x, mixed.x, mixed.y}, d_), linear(V{mixed.x, diagonal.y, mixed.z}, d_),
              linear(V{mixed.y, mixed.z, diagonal.z}, d_)};
    const N A = log_.stage("A = d'Md", linear(g, d_)), B = log_.stage("B = w.d", linear(w, d_));
    const N q = log_.stage("q = B^2 - C A", B * B - C * A);
    const N h = log_.stage("h = sqrt q", root(q));
    const bool away = N(0) < B, on = wide(C.shader) == 0;
    const N sum = h + magnitude(B);
    const N s = away || on ? log_.stage(away ? "s = -A / (h + B)" : "s = -A / (2B)", -A / (away ? sum : B + B))
                           : log_.stage("s = (h - B) / C", sum / C);
    log_.counted("discriminant q = B^2 - C A", q, at(3, 1));
    if (q >= N(0)) log_.counted("h (h + |B|), accuracy of s", h * sum, at(3, 2), false);
    if (away || on) log_.counted("A = d'Md, sign of s", A, at(3, 3));
    if (on || wide(B.shader) == 0) log_.counted("B = w.d", B, at(4, 0));  // 0 is doubt whatever the weight
    log_.offer(N(0) < s, s * at(1, 3));
  }

 private:
  N at(int row, int column) const { return fromRecord<Real>(rows_[static_cast<std::size_t>(4 * row + column)]); }
  V row(int i) const { return {at(i, 0), at(i, 1), at(i, 2)}; }
  V vector(const std::string& name, int i) { return log_.stage(name, row(i)); }

  /// A flat solid's hit: s may be in doubt itself where it is seen at a flat angle.
  void flat(const N& inside, const N& s) {
    const bool hit = inside >= N(0);
    if (hit) log_.sign("in front: s = m.d", s);
    if (log_.setting.grazing && hit) log_.counted("s = m.d, flat angle", s, at(2, 3), false);
    log_.offer(hit, s);
  }

  /// Triangle and quad: the forms of the edges; the least decides.
  void span(const std::vector<std::string>& names) {
    const V m = vector("record m = n / n.(v1-o)", 0);
    const N s = log_.stage("s = m.d", linear(m, d_));
    std::vector<N> edges;
    for (std::size_t i = 0; i < names.size(); ++i) {
      const V form = vector("record " + names[i].substr(5, names[i].size() - 7), static_cast<int>(i) + 1);
      edges.push_back(log_.stage(names[i], linear(form, d_)));
    }
    std::size_t least = 0;
    for (std::size_t i = 1; i < edges.size(); ++i)
      if (edges[i] < edges[least]) least = i;
    log_.counted(names[least], edges[least], N(1));
    flat(edges[least], s);
  }

  Log<Real>& log_;
  const std::vector<f128>& rows_;
  V d_, world_;
};

}  // namespace solidcast::explain
