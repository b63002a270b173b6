// Error against run time: what `solidcast study` measures and writes. Every measurement is one Row of one table, so that
// CSV, JSON and the page cannot disagree.
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "host/cast/caster.h"
#include "host/oracle/families.h"

namespace solidcast::study {

/// A method as it is measured; `exact` counts twice, for devices with and without fp64.
struct Way {
  const char* id;     // in the files
  const char* label;  // for people
  char letter;        // beside its mark in plots
  const char* colour;
  Method method;
  Arithmetic arithmetic;
};
inline constexpr Way kWays[] = {
    {"naive", "naive", 'N', "#d55e00", Method::naive, Arithmetic::automatic},
    {"fast", "fast", 'F', "#c99a00", Method::fast, Arithmetic::automatic},
    {"exact_fp64", "exact, fp64", 'E', "#0072b2", Method::exact, Arithmetic::fp64},
    {"exact_df32", "exact, without fp64", 'D', "#00a27a", Method::exact, Arithmetic::df32},
};
inline constexpr std::size_t kWayCount = sizeof kWays / sizeof *kWays;

/// A wrong decision with a margin of at most so many fp32 ulps of the inputs (oracle.h: marginUlps) is called near an
/// edge: rounding the inputs to fp32 alone might cause it.
inline constexpr double kNearUlps = 4;

/// Errors of one way on some rays, against the oracle. Quantiles are of |t - truth| in fp32 ulps over the hits on which
/// way and oracle agree; NaN where there is none. NaN or infinity answered for a finite truth is an infinite error.
struct Errors {
  std::uint64_t rays = 0, agreedHits = 0;
  double p50 = std::numeric_limits<double>::quiet_NaN(), p99 = p50, p999 = p50, max = p50;
  std::uint64_t misses = 0, falseHits = 0, otherSolid = 0;  // the wrong decisions, by kind
  std::uint64_t notFinite = 0;                              // t NaN or infinite although a hit was reported
  std::uint64_t wrongNear = 0, wrongBeyond = 0;             // the wrong decisions, by margin
  double worstMargin = 0;                                   // the largest margin of a wrong decision, in ulps
  std::uint64_t wrong() const { return wrongNear + wrongBeyond; }
  double wrongShare() const { return rays > 0 ? static_cast<double>(wrong()) / static_cast<double>(rays) : 0; }
};

/// GPU time of one ray and one solid (scenes: one ray), from `runs` dispatches of `raysPerRun` rays, in ns.
/// What is in it is said in kTimed. runs == 0: not timed.
struct Timing {
  int runs = 0;
  std::uint64_t raysPerRun = 0;
  double median = 0, quarter = 0, threeQuarters = 0, least = 0;
  /// Of `exact`, per ray: the host's time (second pass, and for free rays the finish of every hit in binary128), and
  /// how many rays were in doubt.
  double host = 0;
  std::uint64_t doubtful = 0;
};

enum class Section { rays, pixels, sweep, catalogue, scene };
const char* nameOf(Section section);

struct Row {
  Section section = Section::rays;
  std::string kind, family;          // sweep: the sweep's id; catalogue: the case; scene: "scene" and its name
  std::optional<double> difficulty;  // sweep: x
  std::size_t way = 0;
  Errors errors;
  Timing timing;
};

/// Error against difficulty: the rows of one sweep have its id as family.
struct Sweep {
  std::string id, kind, title, axis, note;
  std::vector<double> values;  // from easy to hard
  bool smallerIsHarder = false;
};

/// One case of the catalogue; its rows have its id as family.
struct CaseNote {
  std::string id, kind, note, truth;
  std::string allowed[kWayCount];  // what the tests demand of the way
};

struct ScenePicture {
  std::string scene, caption;
  std::size_t way;      // kWayCount: the picture itself
  std::string pngFile;  // the bytes
  int width, height;
};

struct Request {
  bool families = true, sweeps = true, catalogue = true;
  std::optional<oracle::Kind> kind;  // families and sweeps of this kind alone
  std::vector<Scene> scenes;
  std::size_t rays = 100'000;  // a family
  std::uint64_t seed = 1;
  int runs = 25;
};

struct Study {
  Request request;
  std::string version, command;
  gpu::DeviceInfo device;
  std::string arithmetic32, arithmetic64;  // the probe, in words
  std::vector<std::size_t> ways;           // of kWays, that this device can run
  std::vector<Row> rows;
  std::vector<Sweep> sweeps;
  std::vector<CaseNote> cases;
  std::vector<ScenePicture> pictures;
  std::vector<std::string> omissions;
  double seconds = 0;
  bool complete = false;
};

/// Called after every part with what there is so far; false ends the study.
using Checkpoint = std::function<bool(const Study& study, double fraction, const std::string& next)>;

/// Runs everything that `study.request` asks for.
void run(gpu::Device& device, Study& study, const Checkpoint& checkpoint);

std::string toCsv(const Study& study);
std::string toJson(const Study& study);
std::string toHtml(const Study& study);

}  // namespace solidcast::study
