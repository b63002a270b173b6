#include "host/bench/scenes.h"

#include <charconv>
#include <filesystem>
#include <string_view>

#include "host/error.h"
#include "host/scene/load.h"
#include "host/scene/random.h"

namespace solidcast::bench {

struct CarriedText {
  const char* name;
  std::string_view text;
};
extern const CarriedText kCarriedTexts[];  // made by the build from scenes/*.json
extern const std::size_t kCarriedTextCount;

namespace {

constexpr std::string_view kRandom = "random:";
constexpr std::uint32_t kMostSolids = 10'000'000;

template <class T>
bool number(std::string_view text, T& out) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc{} && end == text.data() + text.size();
}

Scene randomNamed(const std::string& name) {
  std::vector<std::string> parts;
  for (std::size_t at = kRandom.size(); at <= name.size();) {
    const std::size_t end = std::min(name.find(':', at), name.size());
    parts.push_back(name.substr(at, end - at));
    at = end + 1;
  }
  std::uint32_t count = 0;
  std::uint64_t seed = 1;
  const bool read = (parts.size() == 2 || parts.size() == 3) && number(parts[1], count) && count <= kMostSolids &&
                    (parts.size() == 2 || number(parts[2], seed));
  if (!read)
    throw Error(Exit::usage, "SCENE: \"" + name +
                                 "\" is no random scene, expected random:KIND:COUNT[:SEED] with up to " +
                                 std::to_string(kMostSolids) + " solids, e.g. random:sphere:100000:1");
  Scene scene = randomScene(parts[0], count, seed);
  scene.file = name;
  return scene;
}

}  // namespace

std::vector<std::string> carriedScenes() {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kCarriedTextCount; ++i) names.emplace_back(kCarriedTexts[i].name);
  return names;
}

Scene sceneNamed(const std::string& name, std::vector<std::string>& warnings) {
  if (name.starts_with(kRandom)) return randomNamed(name);
  if (!std::filesystem::exists(name))
    for (std::size_t i = 0; i < kCarriedTextCount; ++i)
      if (name == kCarriedTexts[i].name) return parseScene(std::string(kCarriedTexts[i].text), name, warnings);
  return loadScene(name, warnings);
}

}  // namespace solidcast::bench
