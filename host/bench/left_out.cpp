#include "host/bench/left_out.h"

#include <list>
#include <memory>
#include <optional>
#include <variant>

#include "host/bench/race.h"
#include "host/bench/report.h"
#include "host/error.h"
#include "host/scene/build.h"

namespace solidcast::bench {
namespace {

struct Variation {
  std::string name;
  Scene scene;
  RenderJob job;
  CastOptions options;
  gpu::Device* device;
  std::unique_ptr<ImageCaster> caster = {};
  Times dispatch = {}, cpu = {}, first = {};
};

Triple along(const Triple& from, const Triple& direction, double by) {
  return {from[0] + by * direction[0], from[1] + by * direction[1], from[2] + by * direction[2]};
}

/// A solid of each kind that the scene does not have, behind a camera that does not look there: never hit, so all that
/// it adds is the code and one solid's test.
void addMissingKinds(Scene& scene) {
  bool there[std::variant_size_v<Shape>] = {};
  for (std::size_t kind = 0; kind < std::size(there); ++kind) there[kind] = scene.world.solids.count(kind) > 0;
  Triple c{}, forward{};
  std::visit([&](const auto& camera) { c = camera.center, forward = camera.forward; }, scene.camera);
  const Triple p = along(c, forward, -5), q = along(p, {1, 2, 3}, 0.1), r = along(p, {3, -1, 1}, 0.1);
  const Shape all[] = {
      AABox{p, q},
      Sphere{p, 0.1},
      Disc{p, forward, 0.1},
      Triangle{p, q, r},
      Quad{p, {0.1, 0.2, 0.3}, {0.3, -0.1, 0.1}},
      Quadric{{1, 1, 1, 0, 0, 0, -2 * p[0], -2 * p[1], -2 * p[2], p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - 0.01}}};
  for (const Shape& shape : all)
    if (!there[shape.index()]) addSolid(scene.world, shape);
}

std::string number(double value, int digits) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, value);
  return text;
}

}  // namespace

std::string leftOutText(gpu::Device& device, const std::string& deviceSelect, const Scene& scene,
                        const CastOptions& options, int rounds, const std::function<void(double)>& progress) {
  RenderJob job;
  job.width = scene.width, job.height = scene.height;
  job.twoSided = scene.twoSided;
  job.channels.rgb8 = true;
  std::list<Variation> all;  // casters keep references to what is in it
  const auto add = [&](const std::string& name) -> Variation& {
    return all.emplace_back(Variation{name, scene, job, options, &device});
  };
  add("nothing");
  if (std::holds_alternative<PerspectiveCamera>(scene.camera)) {
    addMissingKinds(add("kinds that the scene lacks, one solid of each").scene);
    if (all.back().scene == scene) all.pop_back();
  }
  if (const auto* casting = std::get_if<RayCastingIntegrator>(&scene.integrator); casting != nullptr)
    add("the other integrator (castingdist)").scene.integrator =
        scene.distParameters.value_or(RayCastingDistIntegrator{});
  add("colours as floats").job.channels.radiance = true;
  add("channel: distance").job.channels.distance = true;
  add("channel: solid").job.channels.solid = true;
  add("channel: normal").job.channels.normal = true;
  add("all channels").job.channels = {true, true, true, true, true, true, true};
  for (const auto& [name, plan] :
       {std::pair{"records in a uniform buffer, not baked", Plan::uniform},
        std::pair{"records in a storage buffer", Plan::storage}, std::pair{"tiles", Plan::tiles}})
    add(name).options.plan = plan;
  if (options.method != Method::exact)
    add("decisions watched and their errors bounded (exact)").options.method = Method::exact;
  std::optional<gpu::Device> watched;
  try {
    watched.emplace(gpu::Device::Options{deviceSelect, gpu::Validation::on});
    add("validation layer").device = &*watched;
  } catch (const Error&) {  // not installed: no such row
  }

  std::string impossible;
  for (auto one = all.begin(); one != all.end();) {
    try {
      one->caster = std::make_unique<ImageCaster>(*one->device, one->scene, one->job, one->options);
      ++one;
    } catch (const Error& error) {  // a plan that this scene cannot have
      impossible += "\nNot possible here: " + one->name + " (" + error.what() + ").\n";
      one = all.erase(one);
    }
  }
  std::size_t done = 0;
  for (int round = 0; round <= rounds; ++round)
    for (Variation& one : all) {
      Stopwatch watch;
      const double dispatch_ms = one.caster->dispatchOnly();
      const double cpu_ms = watch.lap().cpu_ms;
      ImageCaster(*one.device, one.scene, one.job, one.options).render([](Band&) {});
      const double first_ms = watch.lap().wall_ms;
      if (progress)
        progress(static_cast<double>(++done) / (static_cast<double>(rounds + 1) * static_cast<double>(all.size())));
      if (round == 0) continue;
      one.dispatch.add(dispatch_ms), one.cpu.add(cpu_ms), one.first.add(first_ms);
    }

  const Variation& lean = all.front();
  const double rays = static_cast<double>(job.width) * job.height;
  std::vector<std::vector<std::string>> rows{{"left in", "plan", "Mray/s: best (median)", "dispatch ms: best (median)",
                                              "CPU ns/ray", "times nothing", "first image ms"}};
  for (const Variation& one : all)
    rows.push_back(
        {one.name, one.caster->stats().planName,
         number(rays / one.dispatch.min() / 1e3, 1) + " (" + number(rays / one.dispatch.median() / 1e3, 1) + ")",
         number(one.dispatch.min(), 2) + " (" + number(one.dispatch.median(), 2) + ")",
         number(one.cpu.min() * 1e6 / rays, 2), number(one.cpu.min() / lean.cpu.min(), 2),
         number(one.first.median(), 1)});
  return "\n**" + scene.file + "**, " + std::to_string(job.width) + "x" + std::to_string(job.height) + ", " +
         std::to_string(rounds) + " rounds; times nothing: by CPU time\n\n" + markdown(rows) + impossible;
}

}  // namespace solidcast::bench
