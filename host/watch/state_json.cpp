#include "host/watch/state_json.h"

#include <nlohmann/json.hpp>

#include "host/explain/explain.h"
#include "host/scene/write.h"

namespace solidcast::watch {
namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, 3> kMethods{"naive", "fast", "exact"};  // in the order of Method

Json frameJson(const Frame& frame) {
  const Phases& p = frame.phases;
  return {{"number", frame.number}, {"width", frame.width},
          {"height", frame.height}, {"solids", frame.scene->world.solids.size()},
          {"read_ms", p.read_ms},   {"prepare_ms", p.prepare_ms},
          {"cast_ms", p.cast_ms},   {"dispatch_ms", p.dispatch_ms},
          {"write_ms", p.write_ms}, {"pipelines_made", p.pipelines}};
}

Json comparisonJson(const Comparison& comparison) {
  if (!comparison.fault.empty()) return {{"frame", comparison.frame}, {"fault", comparison.fault}};
  return {{"frame", comparison.frame},
          {"differing_pixels", comparison.differing},
          {"largest_levels", comparison.largest},
          {"worst_pixel", {comparison.worstX, comparison.worstY}},
          {"reference_ms", comparison.milliseconds}};
}

}  // namespace

const char* methodName(Method method) { return kMethods.at(static_cast<std::size_t>(method)); }

std::optional<Method> methodByName(const std::string& name) {
  for (std::size_t i = 0; i < kMethods.size(); ++i)
    if (name == kMethods[i]) return static_cast<Method>(i);
  return std::nullopt;
}

std::string stateJson(const News& news) {
  Json state{{"version", news.version},
             {"method", methodName(news.view.method)},
             {"problems", Json::array()},
             {"warnings", news.warnings},
             {"camera_moved", news.view.camera.has_value()}};
  for (const Problem& p : news.problems)
    state["problems"].push_back(
        {{"file", p.file}, {"line", p.line}, {"column", p.column}, {"message", p.message}, {"source", p.source}});
  if (news.frame) {
    const Scene& scene = *news.frame->scene;
    state["scene"] = scene.file;
    state["frame"] = frameJson(*news.frame);
    state["integrator"] = std::holds_alternative<RayCastingIntegrator>(scene.integrator) ? "casting" : "castingdist";
    state["integrators"] = Json::array({"casting"});
    if (scene.distParameters) state["integrators"].push_back("castingdist");
  }
  if (news.comparison) state["comparison"] = comparisonJson(*news.comparison);
  return state.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string pixelJson(Session& session, const Frame& frame, int x, int y) {
  CastOptions options = session.options().cast;
  options.method = session.view().method;
  return asJson(explain::explainPixel(session.device(), *frame.scene, frame.job, options, session.options().precision,
                                      frame.job.crop.x + x, frame.job.crop.y + y));
}

std::string cameraJson(const Frame& frame) { return cameraText(frame.scene->camera); }

}  // namespace solidcast::watch
