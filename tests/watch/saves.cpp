#include "tests/watch/saves.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <stdexcept>

#include "host/cast/caster.h"
#include "host/image/reader.h"
#include "host/scene/load.h"

namespace solidcast::watch_test {
namespace {

namespace fs = std::filesystem;
using cli_test::readFile;
using cli_test::writeFile;

const std::string kScene = "scene.json", kMain = "shaders/pixels.comp", kSphere = "shaders/solids/sphere.glsl",
                  kIntegrator = "shaders/integrators/casting.glsl";

std::string original(const std::string& file) { return readFile(SOLIDCAST_SOURCE_DIR "/" + file); }

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::runtime_error("no \"" + what + "\" to edit");
  return text.replace(at, what.size(), by);
}

/// Another picture for every i.
std::string integrator(int i) {
  return replaced(original(kIntegrator), "hit.cosine", "hit.cosine * (1.0 - 0.005 * " + std::to_string(i + 1) + ".0)");
}

}  // namespace

Saves::Saves(gpu::Device& device, int width, int height) : device_(device), width_(width), height_(height) {
  fs::copy(SOLIDCAST_SOURCE_DIR "/shaders", folder_ / "shaders", fs::copy_options::recursive);
  writeFile(folder_ / kScene, scene(-1));
  watch_ = std::make_unique<Child>(
      std::vector<std::string>{"watch", kScene, "--shaders", "shaders", "-o", "live.png", "--device", "llvmpipe"},
      folder_.path());
  if (watch_->waitFor("live.png (").empty()) throw std::runtime_error("the watch did not begin: " + watch_->said());
}

std::string Saves::scene(int i) const {
  const std::string number = std::to_string(1000 + i);
  std::string text = replaced(readFile(cli_test::bundled("a_solids")), R"("width": 640, "height": 480)",
                              "\"width\": " + std::to_string(width_) + ", \"height\": " + std::to_string(height_));
  text = replaced(text, "\"center\": [0, 0, 10]", "\"center\": [0, 0, 10." + number + "]");
  return replaced(text, "\"radius\": 2}", "\"radius\": 1." + number + "}");
}

/// What somebody does who works at a scene and its shaders; of five saves one is a mistake, which the next one mends.
Saves::Step Saves::step(int i) const {
  const int mistake = i / 5 % 4;  // the kind of this round's
  switch (i % 5) {
    case 0:
      return {"included file", {{kIntegrator, integrator(i)}}};
    case 1:
      if (mistake == 0) return {"broken", {{kSphere, original(kSphere) + "\nint broken = 1.5;\n"}}, kSphere + ":"};
      if (mistake == 1)
        return {"broken", {{kScene, replaced(scene(i), "\"radius\": ", "\"radius\": -")}}, kScene + ":"};
      if (mistake == 2)
        return {"broken", {{kMain, replaced(original(kMain), "\"search.glsl\"", "\"nowhere.glsl\"")}}, kMain + ":"};
      return {"broken", {{kScene, scene(i).substr(0, scene(i).size() / 2)}}, kScene + ":"};
    case 2: {
      const std::string& broken = mistake == 0 ? kSphere : mistake == 2 ? kMain : kScene;
      return {"mended", {{broken, broken == kScene ? scene(i) : original(broken)}}};
    }
    case 3:
      return {"several files", {{kScene, scene(i)}, {kIntegrator, integrator(i)}}};
    default:
      return {"scene", {{kScene, scene(i)}}};
  }
}

void Saves::save(const Step& step, int i) const {
  for (const auto& [name, text] : step.files) {
    const std::string file = folder_ / name;
    if (i % 3 == 0) {
      writeFile(file, text);
    } else if (i % 3 == 1) {
      writeFile(file + ".new", text);
      fs::rename(file + ".new", file);
    } else {
      fs::rename(file, file + "~");
      writeFile(file, text);
    }
  }
}

std::vector<std::uint8_t> Saves::freshImage() const {
  std::vector<std::string> warnings;
  const Scene scene = loadScene(folder_ / kScene, warnings);
  RenderJob job;
  job.width = scene.width;
  job.height = scene.height;
  job.channels.rgb8 = true;
  CastOptions options;
  options.shaderFolder = folder_ / "shaders";
  std::vector<std::uint8_t> pixels;
  CastStats stats;
  renderGpu(
      device_, scene, job, options,
      [&pixels](Band& band) { pixels.insert(pixels.end(), band.rgb8.begin(), band.rgb8.end()); }, stats);
  return pixels;
}

SaveReport Saves::run(int count) {
  SaveReport report;
  for (int i = 0; i < count; ++i) {
    const Step next = step(i);
    const auto fail = [&](const std::string& why) {
      report.failures.push_back("save " + std::to_string(i) + " (" + next.what + "): " + why);
    };
    const std::string before = readFile(folder_ / "live.png");
    save(next, i);
    const auto saved = std::chrono::steady_clock::now();
    if (!next.fault.empty()) {
      ++report.broken;
      if (watch_->waitFor(": error: ").find(next.fault) != 0) fail("no error that names " + next.fault);
      if (readFile(folder_ / "live.png") != before) fail("the last good image is gone");
      continue;
    }
    if (watch_->waitFor("live.png (").empty()) {
      fail("no image; the watch said " + watch_->said());
      break;
    }
    const double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - saved).count();
    const bool shaders = next.files.size() > next.files.count(kScene);
    (shaders ? report.shader_ms : report.scene_ms).push_back(ms);
    ++report.good;
    report.included += next.what == "included file";
    const std::vector<std::uint8_t> fresh = freshImage();
    const Image image = readImage(folder_ / "live.png");
    if (image.isFloat() || std::get<0>(image.values) != fresh) fail("not the image of a fresh render");
    if (4 * i >= count && report.kilobytesEarly == 0) report.kilobytesEarly = watch_->kilobytes();
  }
  report.kilobytesLate = watch_->kilobytes();
  return report;
}

int Saves::end() {
  watch_->signal(SIGINT);
  return watch_->end();
}

}  // namespace solidcast::watch_test
