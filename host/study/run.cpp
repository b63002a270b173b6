// The plan of a study: what is measured, in which order, and what was left out.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "host/carried/probe.h"
#include "host/catalogue/catalogue.h"
#include "host/scene/load.h"
#include "host/study/bench.h"
#include "host/study/pictures.h"
#include "host/study/sweeps.h"

namespace solidcast::study {
namespace {

constexpr std::size_t kRaysPerShape = 250;
constexpr std::size_t kSweepShapes = 25;
constexpr double kSceneWork = 2e7;  // pixels times solids that the oracle is asked about for a scene
constexpr int kScenePixels = 640 * 480;

std::string inWords(const char* type, const gpu::ArithmeticReport& r) {
  char text[256];
  std::snprintf(text, sizeof text,
                "%s: +, * off by up to %g, %g ulp; / by %g, sqrt by %g (0: correctly rounded); fma %s; denormals %s; "
                "precise %s; TwoSum %s, TwoProduct %s",
                type, r.sumUlp, r.productUlp, r.divisionUlp, r.rootUlp, r.fma.c_str(),
                r.denormalInputs && r.denormalResults ? "kept" : "flushed",
                r.precise && r.uncontracted ? "holds" : "BROKEN", r.twoSum ? "exact" : "BROKEN",
                r.twoProduct ? "exact" : "BROKEN");
  return text;
}

class Run {
 public:
  Run(gpu::Device& device, Study& study, const Checkpoint& checkpoint)
      : study_(study), checkpoint_(checkpoint), bench_(device, study.ways, study.request.runs) {
    const Request& r = study.request;
    for (const oracle::Kind kind : oracle::kKinds) {
      if (r.kind && *r.kind != kind) continue;
      if (r.families) {
        total_ += kFamilyWork * static_cast<double>(oracle::familiesOf(kind).size());
        total_ += kPixelsWork * static_cast<double>(oracle::imageFamiliesOf(kind).size());
      }
      if (r.sweeps)
        for (const Sweep& sweep : sweepsOf(kind)) total_ += kSweepWork * static_cast<double>(sweep.values.size());
    }
    if (r.catalogue) total_ += kCatalogueWork;
    total_ += kSceneWorkShare * static_cast<double>(r.scenes.size());
  }

  void all() {
    const Request& r = study_.request;
    if (!next(r.catalogue ? "catalogue" : "solids")) return;
    if (r.catalogue && !catalogue()) return;
    for (const Scene& scene : r.scenes)
      if (!sceneRows(scene)) return;
    for (const oracle::Kind kind : oracle::kKinds) {
      if (r.kind && *r.kind != kind) continue;
      if (r.sweeps)
        for (const Sweep& sweep : sweepsOf(kind))
          if (!sweepRows(sweep)) return;
      if (r.families && !(families(kind) && imageFamilies(kind))) return;
    }
    study_.complete = true;
  }

 private:
  // Shares of the time, for the progress bar alone.
  static constexpr double kFamilyWork = 1, kPixelsWork = 0.9, kSweepWork = 0.15, kCatalogueWork = 8,
                          kSceneWorkShare = 3;

  bool next(const std::string& what) {
    study_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    return checkpoint_(study_, total_ > 0 ? std::min(1.0, done_ / total_) : 1, what);
  }

  void add(Section section, const std::string& kind, const std::string& family, const PerWay& measured,
           std::optional<double> difficulty = {}) {
    for (const std::size_t way : study_.ways)
      study_.rows.push_back({section, kind, family, difficulty, way, measured[way].errors, measured[way].timing});
  }

  bool families(oracle::Kind kind) {
    const Request& r = study_.request;
    for (const std::string& family : oracle::familiesOf(kind)) {
      const auto batches = oracle::makeBatches(kind, family, r.rays, r.seed, std::min(kRaysPerShape, r.rays));
      add(Section::rays, oracle::nameOf(kind), family, bench_.rays(batches, true));
      done_ += kFamilyWork;
      if (!next(std::string(oracle::nameOf(kind)) + ", " + family)) return false;
    }
    return true;
  }

  bool imageFamilies(oracle::Kind kind) {
    const Request& r = study_.request;
    const int height = std::max(4, static_cast<int>(std::sqrt(static_cast<double>(r.rays) * 0.75)));
    for (const std::string& family : oracle::imageFamiliesOf(kind)) {
      const Scene scene = oracle::makeImage(kind, family, height * 4 / 3, height, r.seed);
      add(Section::pixels, oracle::nameOf(kind), family, bench_.picture(scene, judge(scene), nullptr));
      done_ += kPixelsWork;
      if (!next(std::string(oracle::nameOf(kind)) + ", picture " + family)) return false;
    }
    return true;
  }

  bool sweepRows(const Sweep& sweep) {
    study_.sweeps.push_back(sweep);
    const std::size_t rays = std::max<std::size_t>(kSweepShapes, study_.request.rays / 10);
    for (const double value : sweep.values) {
      const auto batches = makeSweep(sweep, value, rays, study_.request.seed, rays / kSweepShapes);
      add(Section::sweep, sweep.kind, sweep.id, bench_.rays(batches, false), value);
      done_ += kSweepWork;
      if (!next(sweep.title)) return false;
    }
    return true;
  }

  static std::string demanded(const catalogue::Allowed& allowed) {
    if (allowed.decision == catalogue::Allowed::any) return "anything";
    if (allowed.decision == catalogue::Allowed::miss) return "a miss";
    char text[48];
    std::snprintf(text, sizeof text, "within %g ulp", allowed.ulps);
    return text;
  }

  template <class Case>
  void note(const Case& c, const std::string& kind, const catalogue::Outcome& truth) {
    char text[64] = "miss";
    if (truth.hit) std::snprintf(text, sizeof text, "t = %.9g", static_cast<double>(truth.t));
    CaseNote n{c.id, kind, c.note, text, {}};
    for (std::size_t way = 0; way < kWayCount; ++way)
      n.allowed[way] = demanded(kWays[way].method == Method::naive  ? c.naive
                                : kWays[way].method == Method::fast ? c.fast
                                                                    : c.exact);
    study_.cases.push_back(n);
  }

  static Verdict verdictOf(const catalogue::Outcome& truth) {
    const bool hit = truth.hit && !oracle::beyondFloat(truth.t);
    return {hit ? truth.index : -1, truth.t, truth.marginUlps};
  }

  bool catalogue() {
    const catalogue::Catalogue cases = catalogue::carriedCatalogue();
    for (const catalogue::RayCase& c : cases.rays) {
      const std::string kind = c.solids.size() == 1 ? kindName(c.solids[0]) : "several";
      note(c, kind, c.truth);
      const auto hits = bench_.ray(catalogue::worldOf(c.solids), c.ray);
      PerWay measured;
      for (const std::size_t way : study_.ways) {
        ErrorSum sum;
        sum.add(hits[way].index, hits[way].t, verdictOf(c.truth));
        measured[way].errors = sum.result();
      }
      add(Section::catalogue, kind, c.id, measured);
    }
    done_ += kCatalogueWork / 2;
    if (!next("catalogue's pictures")) return false;
    for (const catalogue::ImageCase& c : cases.images) {
      const std::string kind = c.scene.world.solids.size() == 1 ? kindName(c.scene.world.solids[0].shape) : "several";
      note(c, kind, c.pixels[0].truth);
      std::array<ErrorSum, kWayCount> sums;
      for (const catalogue::ImageCase::Pixel& p : c.pixels) {
        const auto answers = bench_.pixel(c.scene, p.x, p.y);
        for (const std::size_t way : study_.ways)
          sums[way].add(answers[way].solid[0], answers[way].distance[0], verdictOf(p.truth));
      }
      PerWay measured;
      for (const std::size_t way : study_.ways) measured[way].errors = sums[way].result();
      add(Section::catalogue, kind, c.id, measured);
    }
    study_.omissions.push_back("Catalogue: its " + std::to_string(cases.rejects.size()) +
                               " cases of scenes and rays that must be refused have no error to measure.");
    done_ += kCatalogueWork / 2;
    return next("catalogue's families") && catalogueFamilies(cases);
  }

  bool catalogueFamilies(const catalogue::Catalogue& cases) {
    for (const catalogue::FamilyCase& c : cases.families) {
      const std::size_t rays = std::min(c.rays, study_.request.rays);
      std::vector<oracle::Batch> batches;
      for (const oracle::Kind kind : oracle::kKinds)
        if (c.kind == oracle::nameOf(kind))
          batches = oracle::makeBatches(kind, c.family, rays, c.seed, std::min(kRaysPerShape, rays));
      CaseNote n{c.id, c.kind, c.note, std::to_string(rays) + " rays", {}};
      for (std::size_t way = 0; way < kWayCount; ++way)
        n.allowed[way] = kWays[way].method == Method::exact ? "within 1 ulp" : "anything";
      study_.cases.push_back(n);
      add(Section::catalogue, c.kind, c.id, batches.empty() ? cracks(c, rays) : bench_.rays(batches, false));
      if (!next("catalogue's families")) return false;
    }
    return true;
  }

  PerWay cracks(const catalogue::FamilyCase& c, std::size_t rays) {
    const oracle::CrackBatch batch = oracle::makeCracks(c.family == "vertices", rays, c.seed);
    return bench_.rays(batch.world, batch.rays);
  }

  bool sceneRows(const Scene& given) {
    Scene scene = given;
    const double solids = static_cast<double>(std::max<std::size_t>(1, scene.world.solids.size()));
    const double pixels = static_cast<double>(scene.width) * scene.height;
    const double most = std::max(3072.0, std::min<double>(kScenePixels, kSceneWork / solids));
    if (pixels > most) {
      const double part = std::sqrt(most / pixels);
      scene.width = std::max(1, static_cast<int>(scene.width * part));
      scene.height = std::max(1, static_cast<int>(scene.height * part));
      study_.omissions.push_back(scene.file + ": measured at " + std::to_string(scene.width) + " x " +
                                 std::to_string(scene.height) + " pixels instead of its own " +
                                 std::to_string(given.width) + " x " + std::to_string(given.height) +
                                 ", because every pixel is also cast in exact arithmetic.");
    }
    const std::vector<Verdict> truth = judge(scene);
    std::array<Pixels, kWayCount> answers;
    add(Section::scene, "scene", scene.file, bench_.picture(scene, truth, &answers));
    study_.pictures.push_back(bench_.look(scene));
    for (const std::size_t way : study_.ways) study_.pictures.push_back(errorPicture(scene, truth, answers[way], way));
    done_ += kSceneWorkShare;
    return next("solids");
  }

  Study& study_;
  const Checkpoint& checkpoint_;
  Bench bench_;
  double total_ = 0, done_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

const char* nameOf(Section section) {
  static const char* const names[] = {"rays", "pixels", "sweep", "catalogue", "scene"};
  return names[static_cast<int>(section)];
}

void run(gpu::Device& device, Study& study, const Checkpoint& checkpoint) {
  study.device = device.info();
  study.arithmetic32 = inWords("fp32", gpu::probeArithmetic(device, false));
  if (study.device.float64) study.arithmetic64 = inWords("fp64", gpu::probeArithmetic(device, true));
  for (std::size_t way = 0; way < kWayCount; ++way) {
    if (kWays[way].arithmetic != Arithmetic::fp64 || study.device.float64) study.ways.push_back(way);
    else study.omissions.push_back("exact in fp64: the device has no 64-bit floats in shaders.");
  }
  if (!study.device.float64) study.arithmetic64 = "fp64: the device has none";
  if (study.device.limits.timestampPeriod == 0)
    study.omissions.push_back("The device has no timestamps: times are the host's, and contain the submission.");
  const Request& r = study.request;
  if (r.sweeps || r.catalogue)
    study.omissions.push_back("Sweeps and the catalogue's cases are measured for error, not for time.");
  if (r.families)
    study.omissions.push_back(
        "A family of pixels is one picture of one solid: its numbers vary more with the seed than those of free rays, "
        "which are many solids a family.");
  study.omissions.push_back(
      "Errors are those of t and of the decisions; normals and local coordinates are not counted.");
  study.omissions.push_back(
      "Quantiles are over the hits on which method and truth agree; a wrong decision has no error of t and is counted "
      "by "
      "itself.");
  Run(device, study, checkpoint).all();
  if (!study.complete) study.omissions.push_back("The study was interrupted: what it had measured by then is here.");
}

}  // namespace solidcast::study
