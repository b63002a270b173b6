// Every solid's packing and second pass; one file a solid.
#pragma once
#include "host/cast/solids/box.h"
#include "host/cast/solids/disc.h"
#include "host/cast/solids/plane.h"
#include "host/cast/solids/quad.h"
#include "host/cast/solids/quadric.h"
#include "host/cast/solids/sphere.h"
#include "host/cast/solids/triangle.h"

namespace solidcast {

/// One eye in the three number types that records are made in.
struct EyeFrames {
  EyeFrame exact;
  Frame<long double> extended;
  Frame<double> plain;
  explicit EyeFrames(const EyeFrame& eye) : exact(eye), extended(eye), plain(eye) {}
};

/// Gives the solid's record to `sink`, calculated in the quickest type that serves: double for fp32 rows, extended
/// precision for the others, binary128 where those lose too much (EyeRecord). All plans take their records from here:
/// that is why they give the same bytes.
template <class Solid>
void packed(const Solid& solid, const EyeFrames& eye, std::size_t index, RealType type, const auto& sink) {
  const auto in = [&]<class T>(const Frame<T>& frame) {
    EyeRecord<T> record(type);
    packEye(solid, frame, static_cast<T>(index), record);
    if (!record.poor) sink(record);
    return !record.poor;
  };
  if (type == RealType::f32 ? in(eye.plain) : in(eye.extended)) return;
  in(eye.exact);
}

}  // namespace solidcast
