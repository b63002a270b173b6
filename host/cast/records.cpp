#include "host/cast/records.h"

#include <algorithm>
#include <tuple>
#include <type_traits>
#include <utility>

#include "host/cast/solids/all.h"
#include "host/cast/ties.h"

namespace solidcast {
namespace {

struct KindRow {
  const char* label;
  std::uint32_t eyeRows, worldRows;
};
constexpr KindRow kindTable[kindCount] = {
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) {#kind, EYE_ROWS, WORLD_ROWS},
#include "shaders/solids.def"
#undef SOLID
};

template <class Shape>
constexpr int numberOf() {
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  if constexpr (std::is_same_v<Shape, Type>) return NUMBER;
#include "shaders/solids.def"
#undef SOLID
}

std::vector<RowWriter> writers(RealType type) { return std::vector<RowWriter>(kindCount, RowWriter(type)); }

Records joined(const std::vector<RowWriter>& rows, bool eye) {
  Records records;
  std::size_t row = 0;
  for (int kind = 0; kind < kindCount; ++kind) {
    const RowWriter& w = rows[static_cast<std::size_t>(kind)];
    std::uint32_t per = eye ? kindTable[kind].eyeRows : kindTable[kind].worldRows;
    auto k = static_cast<std::size_t>(kind);
    records.rowsPer[k] = per;
    records.firstRow[k] = static_cast<std::uint32_t>(row);
    records.count[k] = static_cast<std::uint32_t>(w.rows() / per);
    records.bytes.insert(records.bytes.end(), w.bytes().begin(), w.bytes().end());
    row += w.rows();
  }
  records.raws = row * (rows[0].type() == RealType::df32 ? 2 : 1);
  return records;
}

f128 radians(double degrees) { return f128(degrees) * M_PIq / 180; }

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace

std::pair<f128, f128> pixelSteps(const Camera& camera, std::int64_t columns, std::int64_t rows) {
  return std::visit(
      Overloaded{[&](const PerspectiveCamera& c) {
                   return std::pair{2 * tanq(radians(c.horizontalAngle) / 2) / columns,
                                    2 * tanq(radians(c.verticalAngle) / 2) / rows};
                 },
                 [&](const OrthographicCamera& c) {
                   return std::pair{f128(c.scaleX) / columns, f128(c.scaleY) / rows};
                 },
                 [&](const EnvironmentCamera& c) {
                   return std::pair{radians(c.horizontalAngle) / columns, radians(c.verticalAngle) / rows};
                 }},
      camera);
}

const char* kindLabel(int kind) { return kindTable[kind].label; }
int kindNumber(ShapeRef shape) {
  return shape.visit([]<class Solid>(const Solid&) { return numberOf<Solid>(); });
}
std::array<std::uint32_t, kindCount> solidsOfKinds(const World& world) {
  std::array<std::uint32_t, kindCount> counts;
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) \
  counts[NUMBER] = static_cast<std::uint32_t>(world.solids.of<Type>().size());
#include "shaders/solids.def"
#undef SOLID
  return counts;
}

std::uint32_t Records::solids() const {
  std::uint32_t n = 0;
  for (std::uint32_t c : count) n += c;
  return n;
}

Records eyeRecords(const World& world, const EyeFrame& eye, RealType type) {
  std::vector<RowWriter> rows = writers(type);
  const EyeFrames frames(eye);
  Records flags;
  std::vector<std::array<std::uint32_t, 2>> places;
  for (std::size_t i = 0; i < world.solids.size(); ++i) {
    const ShapeRef shape = world.solids.shape(i);
    const auto keep = [&](const auto& record) {
      auto kind = static_cast<std::uint32_t>(record.kind < 0 ? kindCount : record.kind);
      places.push_back({kind, kind < kindCount ? static_cast<std::uint32_t>(rows[kind].rows()) : 0});
      for (int r = 0; r < record.rows; ++r) rows[kind].add(record.row[r]);
      flags.grazing = flags.grazing || (record.kind >= 0 && record.grazing);
    };
    shape.visit([&](const auto& s) { packed(s, frames, i, type, keep); });
    if (const auto* sphere = shape.getIf<Sphere>()) flags.farSphere = flags.farSphere || isFar(*sphere, frames.plain);
    if (const auto* box = shape.getIf<AABox>())
      flags.boxOnFace = flags.boxOnFace || eyeOnFacePlane(*box, frames.extended);
  }
  Records records = joined(rows, true);
  for (auto& place : places)
    if (place[0] < kindCount) place[1] += records.firstRow[place[0]];
  records.places = std::move(places);
  records.boxOnFace = flags.boxOnFace;
  records.grazing = flags.grazing;
  records.farSphere = flags.farSphere;
  if (type == RealType::f32) records.ties = mayTie(records, eye);
  return records;
}

Records worldRecords(const World& world, V3 origin, RealType type) {
  std::vector<RowWriter> rows = writers(type);
  std::vector<std::array<std::uint32_t, 2>> places;
  for (std::size_t i = 0; i < world.solids.size(); ++i) {
    const ShapeRef shape = world.solids.shape(i);
    auto kind = static_cast<std::size_t>(kindNumber(shape));
    places.push_back({static_cast<std::uint32_t>(kind), static_cast<std::uint32_t>(rows[kind].rows())});
    shape.visit([&](const auto& s) { packWorld(s, origin, static_cast<double>(i), rows[kind]); });
  }
  Records records = joined(rows, false);
  for (auto& place : places) place[1] += records.firstRow[place[0]];
  records.places = std::move(places);
  return records;
}

EyeFrame eyeFrame(const Scene& scene, RealType type) {
  EyeFrame eye;
  std::visit(
      [&](const auto& camera) {
        eye.origin = V3(camera.center);
        V3 forward = normalized(V3(camera.forward));
        eye.right = normalized(cross(V3(camera.forward), V3(camera.up)));
        eye.upward = cross(eye.right, forward);
        eye.backward = -forward;
      },
      scene.camera);
  if (type == RealType::f64) return eye;
  // The median distance of a hundred solids from all over the scene: any unit near it serves.
  std::vector<double> scales;
  const Triple origin{double(eye.origin.x), double(eye.origin.y), double(eye.origin.z)};
  const std::size_t solids = scene.world.solids.size(), step = solids / 128 + 1;
  for (std::size_t i = 0; i < solids; i += step) {
    const double scale =
        scene.world.solids.shape(i).visit([&](const auto& s) { return distance(ball(s).center, origin); });
    if (scale > 0) scales.push_back(scale);
  }
  if (scales.empty()) return eye;
  auto middle = scales.begin() + static_cast<std::ptrdiff_t>(scales.size() / 2);
  std::nth_element(scales.begin(), middle, scales.end());
  eye.unit = powerOfTwo(f128(*middle));
  return eye;
}

View viewRows(const Scene& scene, const EyeFrame& eye, int width, int height, int samples, RealType type) {
  RowWriter rows(type), angles(type);
  std::int64_t columns = std::int64_t{width} * samples, lines = std::int64_t{height} * samples;
  auto [stepX, stepY] = pixelSteps(scene.camera, columns, lines);
  if (std::holds_alternative<EnvironmentCamera>(scene.camera)) {
    for (std::int64_t i = 0; i < columns; ++i) {
      f128 theta = (i + f128(0.5) - f128(columns) / 2) * stepX;
      angles.row(cosq(theta), sinq(theta), 0, 0);
    }
    for (std::int64_t j = 0; j < lines; ++j) {
      f128 phi = (f128(lines) / 2 - j - f128(0.5)) * stepY;
      angles.row(cosq(phi), sinq(phi), 0, 0);
    }
  }
  rows.row(stepX, stepY, eye.unit, 0);
  rows.row(eye.right, eye.origin.x);
  rows.row(eye.upward, eye.origin.y);
  rows.row(eye.backward, eye.origin.z);
  const RayCastingDistIntegrator* dist = std::get_if<RayCastingDistIntegrator>(&scene.integrator);
  RayCastingDistIntegrator parameters = dist ? *dist : RayCastingDistIntegrator{};
  rows.row(V3(parameters.nearColor), parameters.nearDist);
  rows.row(V3(parameters.farColor), parameters.farDist);
  return {rows.bytes(), rows.rows() * (type == RealType::df32 ? 2 : 1), angles.bytes()};
}

PixelRays::PixelRays(const Scene& scene, int width, int height, int samples)
    : axes_(eyeFrame(scene, RealType::f64)),
      camera_(static_cast<int>(scene.camera.index())),
      columns_(std::int64_t{width} * samples),
      rows_(std::int64_t{height} * samples) {
  std::tie(stepX_, stepY_) = pixelSteps(scene.camera, columns_, rows_);
}

RayQ PixelRays::ray(std::int64_t column, std::int64_t row) const {
  f128 x = (column + f128(0.5) - f128(columns_) / 2) * stepX_, y = (f128(rows_) / 2 - row - f128(0.5)) * stepY_;
  switch (camera_) {
    case 0:
      return {axes_.origin, normalized(axes_.right * x + axes_.upward * y - axes_.backward)};
    case 1:
      return {axes_.origin + axes_.right * x + axes_.upward * y, -axes_.backward};
    default:
      return {axes_.origin, (axes_.right * sinq(x) - axes_.backward * cosq(x)) * cosq(y) + axes_.upward * sinq(y)};
  }
}

}  // namespace solidcast
