#include "host/cli/pixel.h"

#include <CLI/CLI.hpp>
#include <iostream>

#include "host/error.h"
#include "host/explain/explain.h"

namespace solidcast::cli {

void addPixel(CLI::App& verb, PixelOption& pixel) {
  verb.add_option_function<std::string>(
          "--pixel", [&pixel](const std::string& text) { pixel = parsePixel("--pixel", text); },
          "no picture: explain this pixel (its centre), from the top left corner: the ray, every solid that had a say, "
          "who decides what on the GPU, the CPU and truly, and where digits were lost")
      ->type_name("X,Y");
}

void explain(const CLI::App& verb, const std::vector<const char*>& useless, const std::string& file,
             std::pair<int, int> pixel, const ImageOptions& image, const CastingOptions& casting, bool json) {
  for (const char* option : useless)
    if (verb.count(option) > 0)
      throw Error(Exit::usage, std::string(option) + ": has no meaning beside --pixel, expected one of them alone");
  Scene scene = loadWithWarnings(file);
  apply(image, scene);
  keepToTheReference(scene);
  const RenderJob job = makeJob(image, scene, {});
  const auto [x, y] = pixel;
  explain::checkPixel(job, x, y);  // before a device is opened
  const std::unique_ptr<gpu::Device> device = openDevice(casting);
  const explain::Explanation explanation =
      explain::explainPixel(*device, scene, job, casting.cast, casting.precision, x, y);
  std::cout << (json ? asJson(explanation) : asText(explanation));
}

}  // namespace solidcast::cli
