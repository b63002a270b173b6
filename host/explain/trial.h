// What a method's search finds out about one solid, stage by stage.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "host/cast/caster.h"
#include "host/cast/records.h"

namespace solidcast::explain {

/// A named step of the formula: what the shader has there, and what is true. `digits` are binary digits that are right,
/// at most those of the number type; `lost` what this step lost of those that its operands had. Errors are relative to
/// the truth, by where they come from (traced.h).
struct Stage {
  std::string name;
  std::vector<f128> shader, truth;  // one number, or a vector's three
  double digits = 0, lost = 0;
  double byRay = 0, byRecords = 0, byArithmetic = 0;
  std::string source() const;  // "ray", "records", "arithmetic": the largest; "" without an error
};

/// A number whose sign or size the search decides by.
struct Decision {
  std::string name;
  f128 shader = 0, truth = 0;
  /// Of |shader - truth|: of `exact`, which counts its decisions itself, the bound that is proven for them
  /// (docs/numerics.md) and below which it gives the ray to the second pass; else the running bound.
  double bound = 0;
  double margin = 0;   // |shader| / bound: below 1 the decision is in doubt
  bool wrong() const;  // the other sign is true
};

struct Trial {
  std::string form;      // whose formulas: "sphere", or another kind's that the host chose
  bool dropped = false;  // by the host: no ray from this eye can hit it
  bool hit = false;
  float t = std::numeric_limits<float>::infinity();  // in front: as the shader would store it
  double s = 0;                                      // what the search compares: 1/t in units of its own, naive: t
  double tBound = 0;                                 // of |t - true t|, before the last rounding to fp32
  bool doubtful = false;                             // exact: some decision below its bound
  std::vector<Stage> stages;
  std::vector<Decision> decisions;
  const Decision* decisive() const;  // of the least margin; null: nothing to decide
  const Stage* worst() const;        // the stage that lost most; null: none lost a whole digit
};

/// What all solids' trials share.
struct Setting {
  Method method = Method::exact;
  RealType real = RealType::f64;
  int camera = 0;  // pixels.comp's number
  bool grazing = false, farSphere = false, boxOnFace = false;
  double doubt = 0;  // DOUBT of pixels.comp
  int column = 0, row = 0, width = 0, height = 0;
  EyeFrame eye;
  std::pair<f128, f128> steps;
  bool prepared() const { return method != Method::naive && camera != 2; }
};
Setting settingOf(const Scene& scene, Method method, RealType real, int width, int height, int column, int row);

/// The ray as the shader has it: in camera axes for prepared forms, else in world axes, the origin then relative to the
/// camera's centre (fast, exact) or absolute (naive).
struct ShaderRay {
  V3 origin, direction;
  bool cameraAxes = false;
  double directionError = 0;  // relative to the true direction's length
};
ShaderRay shaderRay(const Setting& setting);

Trial tryOn(const Shape& shape, std::int32_t index, const Setting& setting);

/// second < best (1 - 2^-25), as pixels.comp asks for the order of two hits of exact.
bool orderIsClear(double best, double second, RealType real);

}  // namespace solidcast::explain
