#include <iterator>
#include <utility>

#include "host/scene/read.h"

namespace solidcast {
namespace {

/// Runs a rule whose places count from the object at `where`.
template <class Rule>
void within(const std::string& where, const Rule& rule) {
  try {
    rule();
  } catch (Fault& fault) { throw Fault{where + fault.where, fault.text}; }
}

void readImage(const Fields& fields, Scene& scene) {
  fields.onlyKeys({"width", "height"});
  const double width = fields.number("width"), height = fields.number("height");
  within(fields.where(), [&] { checkImageSize(width, height); });
  scene.width = static_cast<int>(width);
  scene.height = static_cast<int>(height);
}

Camera readCameraFields(const Fields& fields) {
  const std::string type = fields.choice("type", "camera", {"perspective", "orthographic", "environment"});
  if (type == "orthographic") {
    fields.onlyKeys({"type", "center", "forward", "up", "scale_x", "scale_y"});
    return OrthographicCamera{fields.triple("center"), fields.triple("forward"), fields.triple("up"),
                              fields.number("scale_x"), fields.number("scale_y")};
  }
  fields.onlyKeys({"type", "center", "forward", "up", "vertical_angle", "horizontal_angle"});
  const Triple center = fields.triple("center"), forward = fields.triple("forward"), up = fields.triple("up");
  const double vertical = fields.number("vertical_angle"), horizontal = fields.number("horizontal_angle");
  if (type == "perspective") return PerspectiveCamera{center, forward, up, vertical, horizontal};
  return EnvironmentCamera{center, forward, up, vertical, horizontal};
}

Integrator readIntegrator(const Fields& fields) {
  const std::string type = fields.choice("type", "integrator", {"casting", "castingdist", "custom"});
  if (type == "casting") {
    fields.onlyKeys({"type"});
    return RayCastingIntegrator{};
  }
  if (type == "custom") {
    fields.onlyKeys({"type", "glsl", "parameters"});
    return CustomIntegrator{readCustomCode(fields)};
  }
  fields.onlyKeys({"type", "near_color", "near_dist", "far_color", "far_dist"});
  const RayCastingDistIntegrator integrator{fields.triple("near_color"), fields.number("near_dist"),
                                            fields.triple("far_color"), fields.number("far_dist")};
  within(fields.where(), [&] { checkIntegrator(integrator); });
  return integrator;
}

/// One integrator, or a list of them: the first is the scene's choice, the others can be asked for by type.
void readIntegrators(const Json& value, const std::string& where, Scene& scene) {
  const bool single = !value.is_array();
  if (!single && value.empty()) throw Fault{where, "the list is empty, expected at least one integrator"};
  constexpr const char* types[] = {"casting", "castingdist", "custom"};
  bool seen[std::size(types)] = {};
  for (std::size_t i = 0; i < (single ? 1 : value.size()); ++i) {
    const std::string place = single ? where : where + numbered("/", i);
    const Integrator integrator = readIntegrator(Fields(single ? value : value[i], place));
    if (std::exchange(seen[integrator.index()], true))
      throw Fault{
          place, std::string("a second integrator of type ") + types[integrator.index()] + ", expected each type once"};
    if (const auto* dist = std::get_if<RayCastingDistIntegrator>(&integrator)) scene.distParameters = *dist;
    if (const auto* custom = std::get_if<CustomIntegrator>(&integrator)) scene.customIntegrator = *custom;
    if (i == 0) scene.integrator = integrator;
  }
}

}  // namespace

Camera readCamera(const Fields& fields, std::vector<Fault>& warnings) {
  const Camera camera = readCameraFields(fields);
  std::vector<Fault> found;
  within(fields.where(), [&] { checkCamera(camera, found); });
  for (Fault& warning : found) warnings.push_back({fields.where() + warning.where, std::move(warning.text)});
  return camera;
}

void readView(const Fields& fields, Scene& scene, std::vector<Fault>& warnings) {
  fields.onlyKeys({"$schema", "image", "camera", "integrator", "two_sided", "solids"});
  if (fields.has("$schema")) fields.text("$schema");
  readImage(Fields(fields.need("image", "width and height"), fields.where("image")), scene);
  scene.camera = readCamera(Fields(fields.need("camera", "a camera"), fields.where("camera")), warnings);
  if (fields.has("integrator"))
    readIntegrators(fields.need("integrator", "an integrator"), fields.where("integrator"), scene);
  if (fields.has("two_sided")) scene.twoSided = fields.flag("two_sided");
}

}  // namespace solidcast
