#include "host/cast/plan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/error.h"

namespace solidcast {
namespace {

struct Name {
  Plan plan;
  const char* text;
};
constexpr Name names[] = {{Plan::automatic, "auto"},  {Plan::baked, "baked"}, {Plan::uniform, "uniform"},
                          {Plan::storage, "storage"}, {Plan::tiles, "tiles"}, {Plan::lists, "lists"},
                          {Plan::index, "index"}};

constexpr std::uint32_t mostBaked = 64;  // solids; compiling more takes seconds
/// Wall ns that one ray and one solid take from a uniform buffer on two threads of the machine of performance-notes.md.
double solidNs(const Program& p) {
  if (p.method == Method::naive) return 0.55;
  if (p.method == Method::fast) return 0.30;
  return p.real == RealType::f64 ? 0.53 : p.real == RealType::df32 ? 10 : 0.5;
}
constexpr double freeRays = 2.5;        // orthographic cameras: times the above
constexpr double bakedPart = 0.45;      // of a ray from a uniform buffer
constexpr double storageTimes = 1.5;    // the same
constexpr double pipelineMs = 15;       // from the driver's cache, as most are
constexpr double listsPipelineMs = 30;  // the same for sixteen rays an invocation
constexpr double flattenUs = 4;         // a solid, in binary128
constexpr double indexUs = 0.5;         // a solid, on two threads
constexpr double queryNs = 1.6;         // a free ray of a query and a solid, any method, from a uniform buffer

double perSolidNs(const Program& p) {
  if (p.job == Job::rays) return queryNs;
  return solidNs(p) * (p.eye() ? 1 : freeRays);
}

std::uint32_t total(const PlanFacts& f) {
  std::uint32_t n = 0;
  for (std::uint32_t c : f.count) n += c;
  return n;
}

/// Records by addresses, with loops unrolled: how many of an invocation's rays at a time (Program::turn; 0: all sixteen of fast,
/// all eight of exact), from how many rays on that pays, what a pipeline takes, and a ray as a part of solidNs(). Seen with the
/// course's scene: 2.0 ns a ray, 1.45 and 1.2 (fast), 3.4, 2.5 and 2.0 (exact); 4 ms, 8 and 28.
struct AtATime {
  int turn;
  double from, pipeline_ms, part;
};
constexpr AtATime atATime[] = {{0, 4e7, 30, 0.62}, {4, 5e6, 9, 0.75}, {1, 0, 5, 1}};

/// What serves, where there are such modules (shaders/CMakeLists.txt).
const AtATime* byAddress(const PlanFacts& f) {
  const Program& p = f.program;
  if (!f.addresses || p.job != Job::pixels || p.method == Method::naive || p.hits || total(f) > mostWide)
    return nullptr;
  if (p.method == Method::exact && p.real != RealType::f64) return nullptr;
  return std::find_if(std::begin(atATime), std::end(atATime),
                      [&](const AtATime& a) { return f.pixels * f.pictures >= a.from; });
}

/// One free ray through an index, wall ns on two threads: steps grow with the logarithm of the number of solids, and what
/// they load leaves one cache after the other. Solids without bounds are all tried.
double indexNs(const PlanFacts& f) {
  double ns = 0;
  for (std::size_t kind = 0; kind < kindCount; ++kind) {
    const double n = f.count[kind];
    if (n > 0) ns += kind == 0 ? 4 * n : 60 + 25 * std::log2(1 + n) + 2 * std::sqrt(n);
  }
  return ns;
}

std::size_t recordBytes(const PlanFacts& f) {
  static constexpr std::size_t rows[kindCount][2] = {
#define SOLID(NUMBER, KIND, kind, Type, EYE_ROWS, WORLD_ROWS) {EYE_ROWS, WORLD_ROWS},
#include "shaders/solids.def"
#undef SOLID
  };
  std::size_t all = 0;
  for (std::size_t k = 0; k < kindCount; ++k) all += f.count[k] * rows[k][f.program.eye() ? 0 : 1];
  return all * (f.program.real == RealType::f32 ? 16 : 32);
}

std::string number(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", v);
  return text;
}

PlanCost costOf(Plan plan, const PlanFacts& f) {
  const std::uint32_t n = total(f);
  const std::size_t bytes = recordBytes(f);
  const double rays = f.pixels * f.pictures, perSolid = perSolidNs(f.program) * 1e-6;
  const double flatten = flattenUs * 1e-3 * n * (f.moving ? f.pictures : 1), each = std::max(1.0, double(n));
  PlanCost cost{plan};
  switch (plan) {
    case Plan::baked: {
      cost.prepare_ms = flatten + bakingMs(f.program.real, n) * (f.moving ? f.pictures : 1);
      cost.rays_ms = rays * perSolid * bakedPart * each;
      if (f.program.job == Job::rays) cost.impossible = "for pictures only";
      else if (!f.llvmpipe) cost.impossible = "only llvmpipe is known to keep every bit of constants";
      else if (f.program.real == RealType::df32) cost.impossible = "double-float takes seconds to compile";
      else if (n > mostBaked)
        cost.impossible = std::to_string(n) + " solids, at most " + std::to_string(mostBaked) + " are compiled";
      break;
    }
    case Plan::uniform:
      cost.prepare_ms = flatten + (byAddress(f) ? byAddress(f)->pipeline_ms : pipelineMs);
      cost.rays_ms = rays * perSolid * each * (byAddress(f) ? byAddress(f)->part : 1);
      if (bytes > f.uniformRange)
        cost.impossible =
            std::to_string(bytes) + " bytes of records, at most " + std::to_string(f.uniformRange) + " fit";
      break;
    case Plan::storage:
      cost.prepare_ms = flatten + pipelineMs;
      cost.rays_ms = rays * perSolid * storageTimes * each;
      break;
    case Plan::tiles: {
      // A scene of n solids that fill it has silhouettes of about n^(-2/3) of the picture; unbounded solids lie in all
      // tiles.
      const double bounded = n - f.count[0], listed = f.count[0] + std::min(bounded, 4 * std::cbrt(bounded));
      cost.prepare_ms = flatten + pipelineMs + f.pictures * (2 + 1e-3 * n);
      cost.rays_ms = rays * perSolid * storageTimes * (listed + 4);
      if (f.program.job == Job::rays) cost.impossible = "free rays have no screen";
      else if (!f.program.eye() && f.program.hits)
        cost.impossible = "normals of free rays need all records in one place";
      break;
    }
    case Plan::index: {
      cost.prepare_ms = flatten + pipelineMs + indexUs * 1e-3 * n;
      cost.rays_ms = rays * indexNs(f) * 1e-6;
      if (f.program.job == Job::pixels) cost.impossible = "an index is for free rays (query)";
      break;
    }
    case Plan::lists: {
      const bool fast = f.program.method == Method::fast;
      // Records of free rays are made in binary128.
      const double perRecord = f.program.eye() ? (fast ? 5e-5 : 3e-4) : flattenUs * 1e-3 / 2;
      cost.prepare_ms = (f.moving ? f.pictures : 1) * (0.3 + n * perRecord) + listsPipelineMs;
      cost.rays_ms = rays * (fast ? 8e-6 : 1.4e-5) * (f.program.eye() ? 1 : 4) +
                     f.count[0] * rays * perSolid;  // planes are in every list
      if (f.program.job == Job::rays) cost.impossible = "free rays have no screen";
      else if (f.program.method == Method::naive) cost.impossible = "naive tries all solids";
      else if (!f.program.eye() && f.program.method == Method::exact && f.program.real != RealType::f64)
        cost.impossible = "exact without fp64 and without a common origin has no lists";
      else if (f.program.hits) cost.impossible = "normals come from world records, of which lists have none";
      else if (f.program.real == RealType::df32) cost.impossible = "double-float takes seconds to compile";
      break;
    }
    case Plan::automatic:
      break;
  }
  return cost;
}

}  // namespace

double bakingMs(RealType real, std::uint32_t solids) { return 20 + (real == RealType::f64 ? 20 : 10) * double(solids); }

PlanFacts planFacts(const gpu::DeviceInfo& device, const World& world, const Program& program, double pixels,
                    const CastOptions& options) {
  PlanFacts facts;
  facts.program = program;
  facts.count = solidsOfKinds(world);
  facts.pixels = pixels;
  facts.pictures = options.pictures;
  facts.moving = options.moving;
  facts.llvmpipe = device.name.starts_with("llvmpipe");
  facts.addresses = facts.llvmpipe && device.bufferAddresses;
  facts.uniformRange = device.limits.maxUniformBufferRange;
  facts.storageRange = device.limits.maxStorageBufferRange;
  return facts;
}

PlanChoice choosePlan(const PlanFacts& facts, Plan asked) {
  std::vector<PlanCost> costs;
  for (const Name& name : names)
    if (name.plan != Plan::automatic) costs.push_back(costOf(name.plan, facts));
  auto better = [&](const PlanCost& a, const PlanCost& b) {
    if ((a.plan == asked) != (b.plan == asked)) return a.plan == asked;
    if (a.impossible.empty() != b.impossible.empty()) return a.impossible.empty();
    return a.prepare_ms + a.rays_ms < b.prepare_ms + b.rays_ms;
  };
  std::stable_sort(costs.begin(), costs.end(), better);
  const PlanCost& best = costs.front();
  if (!best.impossible.empty())
    throw Error(Exit::usage, std::string("--plan ") + planName(best.plan) + ": not possible here: " + best.impossible);
  PlanChoice choice;
  choice.plan = best.plan;
  const AtATime* addressed = best.plan == Plan::uniform ? byAddress(facts) : nullptr;
  choice.address = addressed;
  choice.turn = addressed ? addressed->turn : 0;
  choice.wide = best.plan == Plan::baked || (addressed && addressed->turn == 0);
  choice.bakingMs = bakingMs(facts.program.real, total(facts));
  choice.bakeLater = asked == Plan::automatic && best.plan == Plan::uniform && !facts.moving &&
                     costOf(Plan::baked, facts).impossible.empty();
  choice.costs = std::move(costs);
  return choice;
}

std::vector<std::string> planLines(const PlanFacts& facts, const PlanChoice& choice, Plan asked) {
  std::vector<std::string> lines;
  for (const PlanCost& cost : choice.costs) {
    std::string line = lines.empty() ? std::string(asked == Plan::automatic ? "chosen: " : "as asked: ") : "not ";
    line += planName(cost.plan);
    line += ", ";
    if (cost.impossible.empty())
      line += "expected to take " + number(cost.prepare_ms) + " ms + " + number(cost.rays_ms) + " ms for " +
              number(facts.pixels * facts.pictures) + " rays";
    else line += "not possible: " + cost.impossible;
    lines.push_back(line);
  }
  if (choice.wide) lines.push_back("many rays an invocation: so many rays repay the longer compilation");
  if (choice.turn == 1) lines.push_back("one ray at a time: so few do not repay more code");
  if (choice.turn == 4) lines.push_back("four rays at a time: so many repay more code than for one");
  if (choice.bakeLater)
    lines.push_back("baked once dispatches have taken " + number(choice.bakingMs) + " ms, should it come to that");
  return lines;
}

const char* planName(Plan plan) {
  for (const Name& name : names)
    if (name.plan == plan) return name.text;
  return "";
}

std::vector<std::string> planNames() {
  std::vector<std::string> all;
  for (const Name& name : names) all.push_back(name.text);
  return all;
}

Plan planByName(const std::string& text) {
  std::string list;
  for (const Name& name : names) {
    if (text == name.text) return name.plan;
    list += (list.empty() ? "" : ", ") + std::string(name.text);
  }
  throw Error(Exit::usage, "--plan: \"" + text + "\" is no plan, expected one of " + list);
}

}  // namespace solidcast
