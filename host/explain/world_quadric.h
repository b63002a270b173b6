// A quadric's forms along a ray with an origin of its own, as quadric_free and quadric_naive both begin:
// A t^2 + 2 B t + C with w = M o + l, A = d'Md, B = w.d, C = Q(o).
#pragma once
#include "host/explain/log.h"

namespace solidcast::explain {

template <class Real>
struct WorldQuadric {
  using N = Traced<Real>;
  using V = TracedVector<Real>;
  V m, n, l, w;  // M's diagonal and mixed entries
  N j, A, B, C;

  template <class Record>
  WorldQuadric(Log<Real>& log, const Record& at, const V& o, const V& d) {
    const auto row = [&](int i) { return V{at(i, 0), at(i, 1), at(i, 2)}; };
    m = log.stage("record M, diagonal", row(0));
    n = log.stage("record M, mixed", row(1));
    l = log.stage("record l", row(2));
    j = log.stage("record j", at(1, 3));
    w = log.stage("w = M o + l", times(o) + l);
    A = log.stage("A = d'Md", linear(d, times(d)));
    B = log.stage("B = w.d", linear(w, d));
    C = log.stage("C = Q(o)", linear(o, w) + linear(o, l) + j);
  }

 private:
  V times(const V& v) const {
    return {linear(V{m.x, n.x, n.y}, v), linear(V{n.x, m.y, n.z}, v), linear(V{n.y, n.z, m.z}, v)};
  }
};

}  // namespace solidcast::explain
