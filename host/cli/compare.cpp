// `solidcast compare`: two image files, or the GPU against the CPU reference on one scene.
#include "host/image/compare.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "host/cli/clock.h"
#include "host/cli/options.h"
#include "host/cli/pixel.h"
#include "host/cli/progress.h"
#include "host/cli/verbs.h"
#include "host/error.h"
#include "host/image/difference_picture.h"

namespace solidcast::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kSceneShare = 0.0002;  // of the pixels, by default
constexpr double kSceneLevel = 1;

constexpr char kCompareFooter[] =
    R"(With two files (PNG, PFM, Radiance HDR, told apart by their content) the images are compared; no Vulkan is touched.
With one scene, it is cast on the GPU (A) and by the CPU reference (B).
A pixel differs when any of its channels differs by more than --max-level: levels of 1/255 for 8-bit images, the
numbers themselves as soon as one image holds floats. The budget is kept when at most --max-differing pixels do.
Budgets without options: files must be equal (--max-differing 0 --max-level 0); of a scene 0.02 % of the pixels may
differ by more than 1 level.
The difference picture shows A, B and a heat map with a legend.
Exit codes: 0 within the budget, 1 not, 2 to 5 as in solidcast --help.

Examples:
  solidcast compare gpu.png cpu.png
  solidcast compare gpu.pfm cpu.pfm --max-level 1e-6 -o difference.png
  solidcast compare a.png b.png --max-differing 60 --max-level 1 --json | jq .worst
  solidcast compare scenes/a_solids.json
  solidcast compare scenes/a_solids.json --integrator castingdist --precision f128 --max-differing 0
  solidcast compare scenes/a_solids.json --method naive --size 1920x1080 -o difference.png
  solidcast compare scenes/a_solids.json --method naive --pixel 320,240)";

struct Compare {
  std::vector<std::string> inputs;
  std::string output;
  std::optional<std::int64_t> differing;
  std::optional<double> level;
  PixelOption pixel;
  bool json = false;
  ImageOptions image;
  CastingOptions casting;
};

/// What both ways of comparing end with.
struct Result {
  Image a, b;
  std::string nameA, nameB;
  Census census;
  Json facts = Json::object();  // about the way it was made, in front of the census
};

/// A whole image and its hits, put together from bands.
struct Cast {
  explicit Cast(int width, int height) : image{width, height, 3, std::vector<std::uint8_t>()} {}

  void add(const Band& band) {
    auto& rgb8 = std::get<0>(image.values);
    rgb8.insert(rgb8.end(), band.rgb8.begin(), band.rgb8.end());
    distance.insert(distance.end(), band.distance.begin(), band.distance.end());
    solid.insert(solid.end(), band.solid.begin(), band.solid.end());
  }
  HitChannels hits() const { return {distance, solid}; }

  Image image;
  std::vector<float> distance;
  std::vector<std::int32_t> solid;
};

/// JSON has no infinity: it becomes the text "inf".
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(brief(value)); }

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(number(value));
  return list;
}

Json asJson(const Census& census) {
  const std::string unit = census.unit == Unit::levels ? "levels" : "values";
  Json json{{"width_px", census.width},
            {"height_px", census.height},
            {"pixels", census.pixels},
            {"equal_pixels", census.equal},
            {"within_tolerance_pixels", census.within},
            {"beyond_tolerance_pixels", census.beyond},
            {"nan_pixels_a", census.nanA},
            {"nan_pixels_b", census.nanB},
            {"inf_pixels_a", census.infA},
            {"inf_pixels_b", census.infB},
            {"unit", unit},
            {"max_error_" + unit, number(census.maxError)},
            {"mean_error_" + unit, number(census.meanError)},
            {"psnr_db", number(census.psnr)},
            {"psnr_peak_" + unit, number(census.peak)}};
  json["worst"] = nullptr;
  if (census.worst.x >= 0)
    json["worst"] = {{"x_px", census.worst.x},
                     {"y_px", census.worst.y},
                     {"a", numbers(census.worst.a)},
                     {"b", numbers(census.worst.b)},
                     {"difference_" + unit, number(census.worst.difference)}};
  if (census.hasHits) {
    const HitCensus& hits = census.hits;
    json["hit_miss_flips_pixels"] = hits.hitMissFlips;
    json["solid_flips_pixels"] = hits.solidFlips;
    json["same_solid_pixels"] = hits.bothHit;
    json["t_max_ulp"] = hits.maxUlp;
    json["t_p99_ulp"] = hits.p99Ulp;
    json["t_worst_px"] = hits.worstX < 0 ? Json() : Json{hits.worstX, hits.worstY};
  }
  json["budget"] = {{"max_differing_pixels", census.budget.differing}, {"max_level_" + unit, census.budget.level}};
  json["would_pass"] = {{"max_level_" + unit, number(census.passingLevel)}, {"max_differing_pixels", census.beyond}};
  json["pass"] = census.pass();
  return json;
}

Result compareFiles(const Compare& compare, std::optional<DifferencePicture>& picture) {
  Result result;
  result.nameA = compare.inputs[0];
  result.nameB = compare.inputs[1];
  result.a = readImage(result.nameA);
  result.b = readImage(result.nameB);
  if (!compare.output.empty()) picture.emplace(compare.output, result.a.width, result.a.height);
  result.census = compareImages(result.a, result.b, {compare.differing.value_or(0), compare.level.value_or(0)});
  result.facts = {{"a", result.nameA}, {"b", result.nameB}};
  return result;
}

Result compareScene(const Compare& compare, std::optional<DifferencePicture>& picture) {
  Scene scene = loadWithWarnings(compare.inputs[0]);
  apply(compare.image, scene);
  keepToTheReference(scene);
  Channels channels;
  channels.rgb8 = channels.distance = channels.solid = true;
  const RenderJob job = makeJob(compare.image, scene, channels);
  const int width = job.crop.width > 0 ? job.crop.width : job.width;
  const int height = job.crop.width > 0 ? job.crop.height : job.height;
  const std::int64_t pixels = std::int64_t{width} * height;
  if (pixels > kMostPixels)
    throw Error(Exit::usage, "compare holds whole images: " + std::to_string(width) + "x" + std::to_string(height) +
                                 " is more than " + std::to_string(kMostPixels) + " pixels; compare parts with --crop");
  if (!compare.output.empty()) picture.emplace(compare.output, width, height);

  const std::unique_ptr<gpu::Device> device = openDevice(compare.casting);
  note(cpuName(compare.casting.precision));
  Cast gpu(width, height), cpu(width, height);
  CastStats stats;
  const double start = sinceProcessStart();
  renderGpu(
      *device, scene, job, compare.casting.cast, [&](Band& band) { gpu.add(band); }, stats);
  const double between = sinceProcessStart();
  {
    Progress bar;
    std::mutex mutex;  // rows end on several threads
    reference::render(
        scene, job, compare.casting.precision, [&](Band& band) { cpu.add(band); }, 0,
        [&](int done, int total) {
          const std::lock_guard lock(mutex);
          bar.show(static_cast<double>(done) / total);
        });
  }
  const double end = sinceProcessStart();

  Result result;
  result.a = std::move(gpu.image);
  result.b = std::move(cpu.image);
  result.nameA = "GPU, " + device->info().name;
  result.nameB = cpuName(compare.casting.precision);
  const auto share = static_cast<std::int64_t>(kSceneShare * static_cast<double>(pixels));
  result.census =
      compareImages(result.a, result.b, {compare.differing.value_or(share), compare.level.value_or(kSceneLevel)});
  result.census.hits = compareHits(gpu.hits(), cpu.hits(), width);
  result.census.hasHits = true;
  result.facts = {{"scene", scene.file},
                  {"device", device->info().name},
                  {"precision", precisionName(compare.casting.precision)},
                  {"samples", job.samples},
                  {"dispatch_ms", stats.dispatch_ms},
                  {"gpu_ms", between - start},
                  {"reference_ms", end - between}};
  return result;
}

/// One image alone would only be read as a scene, and the message about JSON would puzzle.
void checkInputs(const Compare& compare) {
  const std::string& first = compare.inputs.front();
  for (const char* ending : {".png", ".pfm", ".hdr"})
    if (compare.inputs.size() == 1 && first.ends_with(ending))
      throw Error(Exit::usage, first + ": one image alone, expected a second one to compare it with, or a scene file");
  if (compare.output == "-")
    throw Error(Exit::usage, "--output: standard output takes the census, expected the name of a file");
}

/// Options that only a scene has a use for are refused for files, not ignored.
void checkFileOptions(const CLI::App& verb) {
  for (const char* option : {"--integrator", "--size", "--samples", "--two-sided", "--crop", "--device", "--method",
                             "--arithmetic", "--precision", "--shaders", "--validation"})
    if (verb.count(option) > 0)
      throw Error(Exit::usage,
                  std::string(option) + ": has no meaning for two image files, expected one scene with it");
}

void run(const CLI::App& verb, const Compare& compare) {
  if (compare.level && !(*compare.level >= 0)) throw Error(Exit::usage, "--max-level: expected a number from 0 up");
  if (compare.differing && *compare.differing < 0)
    throw Error(Exit::usage, "--max-differing: expected a whole number from 0 up");
  checkInputs(compare);
  if (compare.pixel && compare.inputs.size() == 2)
    throw Error(Exit::usage, "--pixel: has no meaning for two image files, expected one scene with it");
  if (compare.pixel)
    return explain(verb, {"--output", "--max-differing", "--max-level", "--crop", "--samples"}, compare.inputs[0],
                   *compare.pixel, compare.image, compare.casting, compare.json);
  std::optional<DifferencePicture> picture;
  const bool files = compare.inputs.size() == 2;
  if (files) checkFileOptions(verb);
  Result result = files ? compareFiles(compare, picture) : compareScene(compare, picture);
  if (picture) picture->write(result.a, result.b, result.census, result.nameA, result.nameB);

  if (compare.json) {
    Json json = result.facts;
    json.update(asJson(result.census));
    json["whole_ms"] = sinceProcessStart();
    std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  } else {
    std::cout << "A  " << result.nameA << "\nB  " << result.nameB << '\n' << censusText(result.census) << '\n';
  }
  if (!result.census.pass())
    throw Error(Exit::differs, std::to_string(result.census.beyond) + " of " + std::to_string(result.census.pixels) +
                                   " pixels differ by more than " +
                                   withUnit(result.census.budget.level, result.census.unit) + ", allowed are " +
                                   std::to_string(result.census.budget.differing));
}

}  // namespace

void addCompare(CLI::App& app) {
  auto compare = std::make_shared<Compare>();
  CLI::App* verb = app.add_subcommand("compare", "compare two images, or the GPU with the CPU reference on a scene");
  verb->footer(kCompareFooter);
  verb->add_option("INPUT", compare->inputs, "a scene file, or two image files")
      ->required()
      ->expected(1, 2)
      ->type_name("SCENE | A B");
  verb->add_option("-o,--output", compare->output, "write a difference picture (PNG)")->type_name("FILE");
  verb->add_option("--max-differing", compare->differing, "pixels that may differ by more than --max-level")
      ->type_name("N");
  verb->add_option("--max-level", compare->level, "difference of a channel that does not count")->type_name("L");
  addImageOptions(*verb, compare->image);
  addCastingOptions(*verb, compare->casting);
  addPixel(*verb, compare->pixel);
  verb->add_flag("--json", compare->json,
                 "print the census, or of --pixel the explanation, as JSON on standard output");
  verb->callback([verb, compare] { run(*verb, *compare); });
}

}  // namespace solidcast::cli
