// Answers judged by the oracle, ray by ray, and summed up to Errors.
#pragma once
#include <span>
#include <vector>

#include "host/oracle/oracle.h"
#include "host/study/study.h"

namespace solidcast::study {

/// What the oracle says, as small as the judging needs it.
struct Verdict {
  std::int32_t index = -1;  // -1: no hit, or one whose t is beyond fp32
  oracle::Real t = 0;
  double marginUlps = 0;
};
Verdict verdictOf(const oracle::WorldTruth& truth);

/// The truth about free rays, on all cores.
std::vector<Verdict> judge(const World& world, std::span<const QueryRay> rays);
/// The truth about the pixels of a picture, row by row, on all cores.
std::vector<Verdict> judge(const Scene& scene);

class ErrorSum {
 public:
  /// `t` of an answer without a hit is not looked at.
  void add(std::int32_t index, float t, const Verdict& truth);
  Errors result() const;

 private:
  Errors errors_;
  std::vector<float> ulps_;
};

}  // namespace solidcast::study
