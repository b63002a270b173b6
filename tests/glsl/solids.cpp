#include "tests/glsl/solids.h"

#include <algorithm>
#include <cmath>

#include "host/cast/solids/all.h"

namespace solidcast::glsl_test {
namespace {

/// The solid's file, with record() and worldRecord() from the array `rows`.
const std::string prelude = R"(
#if EXACT_SEARCH
#define EXACT
#endif
bool testGrazing, testFace;
#define GRAZING testGrazing
#define BOX_FACE testFace
#include "solidcast/hit.glsl"
#include "solidcast/solids/KIND.glsl"

real4 rowAt(uint row) {
#if ARITHMETIC == 2
  vec4 high = rows(2u * row), low = rows(2u * row + 1u);
  return real4(real(high.x, low.x), real(high.y, low.y), real(high.z, low.z), real(high.w, low.w));
#else
  return rows(row);
#endif
}
real4 record(uint row) { return rowAt(row); }
real4 worldRecord(uint row) { return rowAt(row); }
)";

const std::string eyeSignature =
    "void eye(uint row, vec3 direction, float unit, bool grazing, bool face, float doubt, out bool hit, out bool "
    "clear, "
    "out float t, out float cosine)";
const std::string eyeBody = R"( {
  testGrazing = grazing;
  testFace = face;
  EyeRay ray;
  ray.direction = real3(number(direction.x), number(direction.y), number(direction.z));
  ray.world = ray.direction;
  ray.squared = linear(ray.direction, ray.direction);
  Best best = noHit();
  KIND_eye(row, ray, best);
  hit = less(number(0.0), best.s);
  clear = true;
#ifdef EXACT
  clear = atLeast(best.margin, mul(ray.squared, number(doubt)));
#endif
  t = toFloat(mul(quotient(number(1.0), best.s), number(unit)));
  cosine = toFloat(best.cosine) / sqrt(toFloat(ray.squared));
})";

const std::string freeSignature =
    "void free(uint row, vec3 origin, vec3 direction, float doubt, out bool hit, out bool clear, out float t, "
    "out float cosine)";
const std::string freeBody = R"( {
  FreeRay ray;
  ray.origin = real3(origin);
  ray.direction = real3(direction);
  ray.squared = dot3(ray.direction, ray.direction);
  ray.reach = length3(ray.origin);
  Best best = noHit();
  KIND_free(row, ray, best);
  hit = best.s > real(0);
  clear = true;
#ifdef EXACT
  clear = best.margin >= real(doubt);
#endif
  t = toFloat(quotient(number(1.0), best.s));
  cosine = toFloat(best.cosine / root(ray.squared));
})";

const std::string naiveSignature =
    "void naive(uint row, vec3 origin, vec3 direction, out bool hit, out float t, out float cosine)";
const std::string naiveBody = R"( {
  Nearest best = Nearest(3.402823466e38, 0.0, -1.0);
  KIND_naive(row, origin, direction, best);
  hit = best.index >= 0.0;
  t = best.t;
  cosine = best.cosine / length3(direction);
})";

const std::string finishSignature =
    "void finishOne(uint row, POINT point, vec3 direction, float cosine, out vec3 normal, out vec3 local)";
const std::string finishBody = R"( {
  real3 n = real3(0), where = real3(point);
  KIND_finish(row, real3(point), real3(direction), real(cosine), n, where);
  normal = vec3(n);
  local = vec3(where);
})";

Function made(gpu::Device& device, const std::string& kind, RealType type, bool exact, const std::string& signature,
              const std::string& body) {
  std::string text = prelude + signature + body;
  for (const std::string place = "KIND"; text.find(place) != std::string::npos;) {
    text.replace(text.find(place), place.size(), kind);
  }
  Options options;
  options.defines = {{"ARITHMETIC", std::to_string(arithmeticOf(type))},
                     {"EXACT_SEARCH", exact ? "1" : "0"},
                     {"ORIGIN_EXACT", type == RealType::f64 ? "1" : "0"}};
  options.arrays = {type == RealType::f64 ? "dvec4 rows" : "vec4 rows"};
  options.name = kind;
  options.runs = 1;
  return Function(device, text, signature, options);
}

}  // namespace

std::string labelOf(RealType type) {
  return type == RealType::f32 ? "float" : type == RealType::f64 ? "double" : "double-float";
}

std::vector<Aimed> aimed(oracle::Kind kind, const std::vector<std::string>& families, std::size_t each, bool eye) {
  std::vector<Aimed> all;
  for (const std::string& family : families) {
    for (const oracle::Batch& batch : oracle::makeBatches(kind, family, each, 20240607)) {
      for (QueryRay ray : batch.rays) {
        if (eye) {
          float longest = 0;
          for (const float d : ray.direction) longest = std::max(longest, std::fabs(d));
          const int exponent = std::ilogb(longest);
          bool same = true;
          for (float& d : ray.direction) {
            const float scaled = std::scalbn(d, -exponent);
            same = same && std::scalbn(scaled, exponent) == d;
            d = scaled;
          }
          if (!same) continue;
        }
        ray.tMax = std::numeric_limits<float>::infinity();
        all.push_back({family, batch.shape, ray, oracle::intersect(batch.shape, oracle::exactRay(ray))});
      }
    }
  }
  return all;
}

Values Packed::values() const { return {{rows.type() == RealType::f64 ? Base::f64 : Base::f32, 4}, rows.bytes()}; }
std::vector<Float3> Packed::origins(const std::vector<Aimed>& all) const {
  return truths([&](std::size_t i) { return all[i].ray.origin; }, elements);
}
std::vector<Float3> Packed::directions(const std::vector<Aimed>& all) const {
  return truths([&](std::size_t i) { return all[i].ray.direction; }, elements);
}

std::map<int, Packed> packedForEye(const std::vector<Aimed>& all, RealType type, std::vector<std::size_t>& none) {
  std::map<int, Packed> packed;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto& o = all[i].ray.origin;
    EyeFrame eye;
    eye.origin = {o[0], o[1], o[2]}, eye.right = {1, 0, 0}, eye.upward = {0, 1, 0}, eye.backward = {0, 0, 1};
    const f128 away = std::visit([&](const auto& s) { return length(V3(ball(s).center) - eye.origin); }, all[i].shape);
    if (type != RealType::f64 && away > 0) eye.unit = powerOfTwo(away);
    EyeRecord<f128> record(type);
    bool onFace = false;
    std::visit([&](const auto& s) { packEye(s, eye, f128(0), record); }, all[i].shape);
    if (const auto* box = std::get_if<AABox>(&all[i].shape)) onFace = eyeOnFacePlane(*box, eye);
    if (record.kind < 0) {
      none.push_back(i);
      continue;
    }
    Packed& p = packed.try_emplace(record.kind, type).first->second;
    p.elements.push_back(i);
    p.row.push_back(static_cast<std::uint32_t>(p.rows.rows()));
    for (int r = 0; r < record.rows; ++r) p.rows.add(record.row[r]);
    p.unit.push_back(static_cast<float>(eye.unit));
    p.grazing.push_back(record.grazing);
    p.onFace.push_back(onFace);
  }
  return packed;
}

Packed packedWorld(const std::vector<Aimed>& all, RealType type) {
  Packed p(type);
  for (std::size_t i = 0; i < all.size(); ++i) {
    p.elements.push_back(i);
    p.row.push_back(static_cast<std::uint32_t>(p.rows.rows()));
    std::visit([&](const auto& s) { packWorld(s, V3{}, 0, p.rows); }, all[i].shape);
  }
  return p;
}

Function eyeFunction(gpu::Device& device, const std::string& kind, RealType type, bool exact) {
  return made(device, kind, type, exact, eyeSignature, eyeBody);
}
Function freeFunction(gpu::Device& device, const std::string& kind, RealType type, bool exact) {
  return made(device, kind, type, exact, freeSignature, freeBody);
}
Function naiveFunction(gpu::Device& device, const std::string& kind) {
  return made(device, kind, RealType::f32, false, naiveSignature, naiveBody);
}
Function finishFunction(gpu::Device& device, const std::string& kind, RealType type) {
  std::string signature = finishSignature;  // a device without fp64 has no dvec3
  signature.replace(signature.find("POINT"), 5, type == RealType::f64 ? "dvec3" : "vec3");
  return made(device, kind, type, type == RealType::f64, signature, finishBody);
}

float doubtOf(RealType type, bool eye) {
  if (eye) return static_cast<float>(32 * unitRoundoff(type));
  return std::ldexp(1.f, type == RealType::f64 ? -24 : -9);
}

}  // namespace solidcast::glsl_test
