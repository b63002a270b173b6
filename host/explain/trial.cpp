#include "host/explain/trial.h"

#include <algorithm>
#include <array>
#include <variant>

#include "host/cast/program.h"
#include "host/cast/solids/all.h"
#include "host/explain/eye.h"
#include "host/explain/free.h"
#include "host/explain/naive.h"

namespace solidcast::explain {
namespace {

/// pixels.comp: cameraRay(), combine(). Every number with its true value beside it.
template <class Real>
struct CameraRay {
  using N = Traced<Real>;
  using V = TracedVector<Real>;
  V origin, direction, world;  // direction in camera axes; world: the same in world axes

  explicit CameraRay(const Setting& s) {
    const auto grid = [](int doubled) { return fromRay<Real>(roundedTo<Real>(0.5 * doubled), f128(0.5) * doubled); };
    const auto of = [](f128 ideal) { return fromRay<Real>(roundedTo<Real>(ideal), ideal); };
    const N x = grid(2 * s.column + 1 - s.width), y = grid(s.height - 2 * s.row - 1);
    const N stepX = of(s.steps.first), stepY = of(s.steps.second), none(0);
    const auto combine = [&](const N& a, const N& b, const N& c) {
      const V r = vector(s.eye.right), u = vector(s.eye.upward), w = vector(s.eye.backward);
      return input(V{a * r.x + (b * u.x + c * w.x), a * r.y + (b * u.y + c * w.y), a * r.z + (b * u.z + c * w.z)});
    };
    if (s.camera == 0) {
      direction = input(V{x * stepX, y * stepY, N(-1)});
    } else if (s.camera == 1) {
      const f128 theta = x.ideal * s.steps.first, phi = y.ideal * s.steps.second;
      const N cosLat = of(cosq(phi)), sinLat = of(sinq(phi)), cosLon = of(cosq(theta)), sinLon = of(sinq(theta));
      direction = input(V{cosLat * sinLon, sinLat, -(cosLat * cosLon)});
    } else {
      direction = V{none, none, N(-1)};
      origin = combine(x * stepX, y * stepY, none);
    }
    world = combine(direction.x, direction.y, direction.z);
    if (s.method == Method::naive) {
      origin = input(vector(s.eye.origin) + origin);
      world = input(unit(world));
    }
  }

 private:
  static V vector(V3 v) {
    V r;
    for (int i = 0; i < 3; ++i) r[i] = fromRay<Real>(roundedTo<Real>(v[i]), v[i]);
    return r;
  }
  /// A ray is given to the solids' formulas as it is: all its error is the ray's.
  static V input(V v) {
    for (int i = 0; i < 3; ++i) v[i] = fromRay<Real>(v[i].shader, v[i].ideal);
    return v;
  }
};

/// The rows that the shader has of the solid, before they were rounded, and whose formulas they are for.
struct Rows {
  int kind = kindCount;
  std::vector<f128> numbers;
};

Rows rowsOf(const Shape& shape, std::int32_t index, const Setting& s) {
  Rows rows;
  if (!s.prepared()) {
    RowWriter writer(s.real, &rows.numbers);
    const V3 origin = s.method == Method::naive ? V3{} : s.eye.origin;
    std::visit([&](const auto& solid) { packWorld(solid, origin, index, writer); }, shape);
    rows.kind = kindNumber(shape);
    return rows;
  }
  EyeRecord<f128> record(s.real);
  std::visit([&](const auto& solid) { packEye(solid, s.eye, f128(index), record); }, shape);
  if (record.kind >= 0) rows = {record.kind, {record.row[0], record.row[0] + 4 * record.rows}};
  return rows;
}

template <class Formulas>
void follow(int kind, Formulas formulas) {
  switch (kind) {
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  case NUMBER:                                                \
    return formulas.kind();
#include "shaders/solids.def"
#undef SOLID
  }
}

template <class Real>
void followIn(const Rows& rows, const Setting& setting, Trial& trial) {
  Log<Real> log(setting, trial);
  const CameraRay<Real> ray(setting);
  if (setting.prepared()) return follow(rows.kind, Eye<Real>(log, rows.numbers, ray.direction, ray.world));
  if constexpr (std::is_same_v<Real, float>)
    if (setting.method == Method::naive) return follow(rows.kind, Naive(log, rows.numbers, ray.origin, ray.world));
  follow(rows.kind, Free<Real>(log, rows.numbers, ray.origin, ray.world));
}

template <class Real>
ShaderRay rayIn(const Setting& setting) {
  const CameraRay<Real> ray(setting);
  ShaderRay result;
  result.cameraAxes = setting.prepared();
  const auto& direction = setting.prepared() ? ray.direction : ray.world;
  f128 error = 0, length = 0;
  for (int i = 0; i < 3; ++i) {
    result.origin[i] = wide(ray.origin[i].shader);
    result.direction[i] = wide(direction[i].shader);
    const f128 off = wide(direction[i].shader) - direction[i].ideal;
    error += off * off, length += direction[i].ideal * direction[i].ideal;
  }
  result.directionError = static_cast<double>(sqrtq(error / length));
  return result;
}

}  // namespace

std::string Stage::source() const {
  const double most = std::max({byRay, byRecords, byArithmetic});
  if (!(most > 0)) return "";
  return byArithmetic == most ? "arithmetic" : byRecords == most ? "records" : "ray";
}

bool Decision::wrong() const {
  if (isnanq(shader) || isnanq(truth)) return isnanq(shader) != isnanq(truth);
  return (shader < 0) != (truth < 0);
}

const Decision* Trial::decisive() const {
  const auto least = std::min_element(decisions.begin(), decisions.end(),
                                      [](const Decision& a, const Decision& b) { return a.margin < b.margin; });
  return least == decisions.end() ? nullptr : &*least;
}

const Stage* Trial::worst() const {
  const auto most =
      std::max_element(stages.begin(), stages.end(), [](const Stage& a, const Stage& b) { return a.lost < b.lost; });
  return most == stages.end() || most->lost < 1 ? nullptr : &*most;
}

Setting settingOf(const Scene& scene, Method method, RealType real, int width, int height, int column, int row) {
  Setting s;
  Program program;
  program.method = s.method = method;
  program.real = s.real = real;
  program.camera = s.camera = cameraNumber(scene.camera);
  s.column = column, s.row = row, s.width = width, s.height = height;
  s.eye = eyeFrame(scene, program.eye() ? real : RealType::f64);
  s.steps = pixelSteps(scene.camera, width, height);
  s.doubt = doubtOf(program);
  if (program.eye()) {
    const Records records = eyeRecords(scene.world, s.eye, real);
    s.grazing = records.grazing, s.farSphere = records.farSphere, s.boxOnFace = records.boxOnFace;
  }
  return s;
}

Trial tryOn(const Shape& shape, std::int32_t index, const Setting& setting) {
  Trial trial;
  const Rows rows = rowsOf(shape, index, setting);
  trial.dropped = rows.kind == kindCount;
  if (trial.dropped) return trial;
  trial.form = kindLabel(rows.kind);
  if (setting.real == RealType::f64) followIn<double>(rows, setting, trial);
  else if (setting.real == RealType::df32) followIn<DoubleFloat>(rows, setting, trial);
  else followIn<float>(rows, setting, trial);
  return trial;
}

ShaderRay shaderRay(const Setting& setting) {
  if (setting.real == RealType::f64) return rayIn<double>(setting);
  if (setting.real == RealType::df32) return rayIn<DoubleFloat>(setting);
  return rayIn<float>(setting);
}

bool orderIsClear(double best, double second, RealType real) {
  // In fp32 1 - 2^-25 is 1.
  return second < best * (real == RealType::f32 ? 1. : 1 - 0x1p-25);
}

}  // namespace solidcast::explain
