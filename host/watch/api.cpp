#include "host/watch/api.h"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/image/writer.h"
#include "host/scene/camera_path.h"
#include "host/watch/state_json.h"
#include "host/watch/steer.h"

namespace solidcast::watch {

struct CarriedText {
  const char* name;
  std::string_view text;
};
extern const CarriedText kCarriedTexts[];  // made by the build from host/watch/page
extern const std::size_t kCarriedTextCount;

namespace {

using Json = nlohmann::json;

constexpr std::chrono::seconds kLongest{10};  // that a question for news is kept waiting
constexpr int kMostWaiting = 12;              // viewers at once; further ones get an answer at once
constexpr double kMostDegrees = 360, kMostPan = 4, kMostZoom = 16;

struct Carried {
  const char *path, *text, *type;
};
constexpr std::array<Carried, 3> kCarried{{{"/", "page", "text/html; charset=utf-8"},
                                           {"/style.css", "style", "text/css; charset=utf-8"},
                                           {"/script.js", "script", "text/javascript; charset=utf-8"}}};
constexpr const char* kJson = "application/json";

std::string carriedText(std::string_view name) {
  for (std::size_t i = 0; i < kCarriedTextCount; ++i)
    if (name == kCarriedTexts[i].name) return std::string(kCarriedTexts[i].text);
  return "";
}

Answer problem(int status, const std::string& what) { return {status, kJson, Json{{"error", what}}.dump() + "\n"}; }

/// A whole number from the question; nullopt where it is missing or none.
std::optional<std::int64_t> number(const Question& question, const std::string& name) {
  const auto found = question.parameters.find(name);
  if (found == question.parameters.end()) return std::nullopt;
  std::int64_t value = 0;
  const std::string& text = found->second;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

/// Two finite numbers of at most `most` in size. Throws Error(Exit::usage).
std::array<double, 2> pairOf(const Json& value, double most) {
  std::array<double, 2> numbers{};
  bool good = value.is_array() && value.size() == 2;
  for (std::size_t i = 0; good && i < 2; ++i) {
    good = value[i].is_number();
    if (good) numbers[i] = value[i].get<double>();
    good = good && std::abs(numbers[i]) <= most;
  }
  if (!good) throw Error(Exit::usage, "expected two numbers of at most " + std::to_string(static_cast<int>(most)));
  return numbers;
}

/// {"orbit": [right, up]} in degrees, {"pan": [right, up]} in parts of the image, {"zoom": factor}, or {"reset": true}.
std::optional<Camera> moved(const Scene& scene, const Json& move) {
  if (!move.is_object() || move.size() != 1) throw Error(Exit::usage, "expected one of orbit, pan, zoom, reset");
  Triple pivot = pointLookedAt(scene);
  if (const auto* camera = std::get_if<EnvironmentCamera>(&scene.camera)) pivot = camera->center;
  const auto& [name, value] = *move.items().begin();
  if (name == "orbit") {
    const auto [right, up] = pairOf(value, kMostDegrees);
    return orbited(scene.camera, pivot, right, up);
  }
  if (name == "pan") {
    const auto [right, up] = pairOf(value, kMostPan);
    return panned(scene.camera, pivot, right, up);
  }
  if (name == "zoom") {
    const double factor = value.is_number() ? value.get<double>() : 0;
    if (!(factor >= 1 / kMostZoom && factor <= kMostZoom)) throw Error(Exit::usage, "zoom: expected 1/16 to 16");
    return zoomed(scene.camera, pivot, factor);
  }
  if (name == "reset" && value == true) return std::nullopt;
  throw Error(Exit::usage, "expected one of orbit, pan, zoom, reset");
}

/// {"method": ..., "integrator": ...}, either or both; "" is the scene's own integrator.
View changed(View view, const Json& change) {
  if (!change.is_object() || change.empty()) throw Error(Exit::usage, "expected method or integrator");
  for (const auto& [name, value] : change.items()) {
    const std::string text = value.is_string() ? value.get<std::string>() : "?";
    const std::optional<Method> method = methodByName(text);
    if (name == "method" && method) view.method = *method;
    else if (name == "integrator" && (text.empty() || text == "casting" || text == "castingdist"))
      view.integrator = text;
    else throw Error(Exit::usage, "expected method naive, fast, exact, or integrator casting, castingdist");
  }
  return view;
}

std::string shown(const Session& session) {
  return Json{{"frame", session.frame() ? session.frame()->number : 0}}.dump() + "\n";
}

}  // namespace

bool Api::knows(const std::string& path, bool post) {
  if (post) return path == "/camera" || path == "/view";
  for (const Carried& carried : kCarried)
    if (path == carried.path) return true;
  for (const char* known : {"/state", "/camera", "/gpu.png", "/cpu.png", "/difference.png", "/pixel"})
    if (path == known) return true;
  return false;
}

Answer Api::answer(const Question& question) {
  for (const Carried& carried : kCarried)
    if (question.path == carried.path) return {200, carried.type, carriedText(carried.text)};
  if (question.path == "/state") return state(question);
  if (question.path == "/pixel") return pixel(question);
  if (question.path == "/view") return change(question);
  if (question.path == "/camera" && question.post) return steer(question);
  if (question.path == "/camera") {
    const News news = board_.news();
    if (!news.frame) return problem(404, "there is no image yet");
    return {200, kJson, cameraJson(*news.frame) + "\n"};
  }
  return picture(question);
}

/// ?after=VERSION waits for something newer; ?compare=1 asks for the reference's picture.
Answer Api::state(const Question& question) {
  if (number(question, "compare") == 1) board_.wantComparison();
  const std::optional<std::int64_t> after = number(question, "after");
  {
    const std::lock_guard lock(mutex_);
    if (!after || waiting_ >= kMostWaiting) return {200, kJson, stateJson(board_.news())};
    ++waiting_;
  }
  const News news = board_.newer(*after, kLongest);
  const std::lock_guard lock(mutex_);
  --waiting_;
  return {200, kJson, stateJson(news)};
}

Answer Api::picture(const Question& question) {
  const News news = board_.news();
  if (question.path == "/gpu.png" && news.frame) {
    const std::lock_guard lock(mutex_);
    if (encodedFrame_ != news.frame->number) encoded_ = pngOf(news.frame->rgb8, news.frame->width, news.frame->height);
    encodedFrame_ = news.frame->number;
    return {200, "image/png", encoded_};
  }
  const Comparison* comparison = news.comparison.get();
  if (question.path != "/gpu.png" && comparison != nullptr && comparison->fault.empty())
    return {
        200, "image/png",
        pngOf(question.path == "/cpu.png" ? comparison->cpu : comparison->heat, comparison->width, comparison->height)};
  return problem(404, "there is no such image yet");
}

Answer Api::asked(std::function<std::string(Session&)> wish) {
  const std::optional<Reply> reply = board_.ask(std::move(wish));
  if (!reply) return problem(503, "the watch is busy, try again");
  return reply->good ? Answer{200, kJson, reply->text} : problem(400, reply->text);
}

Answer Api::steer(const Question& question) {
  Json move = Json::parse(question.body, nullptr, false);
  return asked([move](Session& session) {
    if (!session.frame()) throw Error(Exit::usage, "there is no image yet");
    View view = session.view();
    view.camera = moved(*session.frame()->scene, move);
    session.show(view);
    return shown(session);
  });
}

Answer Api::change(const Question& question) {
  Json change = Json::parse(question.body, nullptr, false);
  return asked([change](Session& session) {
    session.show(changed(session.view(), change));
    return shown(session);
  });
}

Answer Api::pixel(const Question& question) {
  const auto x = number(question, "x"), y = number(question, "y");
  if (!x || !y) return problem(400, "expected x and y, whole numbers of pixels");
  return asked([x, y](Session& session) {
    const auto frame = session.frame();
    if (!frame || *x < 0 || *y < 0 || *x >= frame->width || *y >= frame->height)
      throw Error(Exit::usage, "expected a pixel of the image");
    return pixelJson(session, *frame, static_cast<int>(*x), static_cast<int>(*y));
  });
}

}  // namespace solidcast::watch
