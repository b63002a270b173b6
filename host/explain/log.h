// Where the mirrored formulas write what they do.
#pragma once
#include <algorithm>

#include "host/explain/traced.h"
#include "host/explain/trial.h"

namespace solidcast::explain {

template <class Real>
class Log {
 public:
  using N = Traced<Real>;
  using V = TracedVector<Real>;
  static constexpr int kDigits = kTypeOf<Real> == RealType::f32 ? 24 : kTypeOf<Real> == RealType::f64 ? 53 : 44;

  Log(const Setting& setting, Trial& trial) : setting(setting), trial_(trial) {}
  const Setting& setting;
  /// |d|^2, which a decision's bound is counted in.
  N squared{1};
  bool exact() const { return setting.method == Method::exact; }

  N stage(const std::string& name, N x) {
    add(name, &x, 1);
    return x;
  }
  V stage(const std::string& name, V v) {
    add(name, &v.x, 3);
    return v;
  }

  /// A sign that decides; naive and fast count nothing.
  void sign(const std::string& name, const N& x) {
    if (!exact()) decide(name, x, x.bound, x.size() / x.bound);
  }
  /// hit.glsl: decided(best, x weight). `decides`: by its sign; else it only says that something is accurate enough.
  void counted(const std::string& name, const N& x, const N& weight, bool decides = true) {
    if (exact()) count(name, x, magnitude(x * weight));
    else if (decides) sign(name, x);
  }
  /// hit.glsl: decidedAgainst(best, x, scale).
  void countedAgainst(const std::string& name, const N& x, const N& scale, bool decides = true) {
    const double big = kTypeOf<Real> == RealType::f64 ? 1e250 : 3e37;
    const N m = magnitude(x) / scale;
    const bool sound = wide(m.shader) >= 0 && wide((scale * N(big)).shader) >= f128(1e7);
    if (exact()) count(name, x, sound ? m : N(0));
    else if (decides) sign(name, x);
  }

  /// hit.glsl: offer(best, inside, s, ...), t = |d|/s.
  void offer(bool inside, const N& s) {
    trial_.hit = inside && N(0) < s;
    trial_.s = static_cast<double>(wide(s.shader));
    const N scale = fromExact(setting.eye.unit);
    const N t = stage("t = |d| / s", root(squared) / s * scale);
    trial_.t = toFloat(t.shader);
    trial_.tBound = t.bound;
  }
  void offerNaive(bool hit, const N& t) {
    trial_.hit = hit && N(0) < t && t < N(3.402823466e38);  // the search starts there
    trial_.s = trial_.t = toFloat(t.shader);
    trial_.tBound = t.bound;
  }

  static N fromExact(f128 x) {
    N r;
    r.shader = roundedTo<Real>(x);
    r.rounded = r.ray = r.records = r.ideal = x;
    return r;
  }

 private:
  void add(const std::string& name, N* x, int count) {
    Stage stage;
    stage.name = name;
    f128 truth = 0, all = 0, ray = 0, records = 0, arithmetic = 0;
    bool same = true, known = true;
    std::uint64_t from = 0;
    for (int i = 0; i < count; ++i) {
      const f128 shader = wide(x[i].shader);
      stage.shader.push_back(shader);
      stage.truth.push_back(x[i].ideal);
      from |= x[i].stages;
      const bool bothNone = isnanq(shader) && isnanq(x[i].ideal);
      same = same && (bothNone || shader == x[i].ideal);
      known = known && (bothNone || (finiteq(shader) && finiteq(x[i].ideal)));
      const auto square = [](f128 v) { return finiteq(v) ? v * v : 0; };
      truth += square(x[i].ideal), all += square(shader - x[i].ideal);
      ray += square(x[i].ray - x[i].ideal), records += square(x[i].records - x[i].ideal);
      arithmetic += square(shader - x[i].rounded);
    }
    const auto relative = [&](f128 e) {
      return e == 0 ? 0. : truth == 0 ? INFINITY : static_cast<double>(sqrtq(e / truth));
    };
    stage.byRay = relative(ray), stage.byRecords = relative(records), stage.byArithmetic = relative(arithmetic);
    stage.digits = same ? kDigits : !known ? 0 : std::clamp(-std::log2(relative(all)), 0., double(kDigits));
    double before = kDigits;
    for (std::size_t i = 0; i < trial_.stages.size(); ++i)
      if (from >> i & 1) before = std::min(before, trial_.stages[i].digits);
    stage.lost = std::max(0., before - stage.digits);
    for (int i = 0; i < count; ++i) x[i].stages = std::uint64_t{1} << trial_.stages.size();
    trial_.stages.push_back(std::move(stage));
  }

  void count(const std::string& name, const N& x, const N& m) {
    const N limit = squared * N(setting.doubt);
    trial_.doubtful = trial_.doubtful || !(m >= limit);
    const auto margin = static_cast<double>(wide(m.shader) / wide(limit.shader));
    decide(name, x, wide(m.shader) == 0 ? x.bound : x.size() / margin, margin);
  }
  void decide(const std::string& name, const N& x, double bound, double margin) {
    if (std::isnan(bound)) bound = INFINITY;
    if (!(margin >= 0)) margin = bound == 0 ? INFINITY : 0;  // 0/0: exactly 0, and known to be
    trial_.decisions.push_back({name, wide(x.shader), x.ideal, bound, margin});
  }

  Trial& trial_;
};

}  // namespace solidcast::explain
