// Users' own GLSL in a scene file: which file, and the numbers that it is given. The file is not opened here: whether it
// is good GLSL only a compiler can say.
#include <algorithm>
#include <cctype>

#include "host/scene/read.h"

namespace solidcast {
namespace {

/// Parameters become members of a GLSL struct. The uniform buffer that holds them need not be large.
constexpr std::size_t kMostParameters = 64;

void checkGlslName(const std::string& name, const std::string& where) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; };
  const auto good = [&](char c) { return letter(c) || std::isdigit(static_cast<unsigned char>(c)); };
  if (name.empty() || !letter(name[0]) || !std::all_of(name.begin(), name.end(), good) || name.starts_with("gl_") ||
      name.find("__") != std::string::npos)
    throw Fault{where, inQuotes(name) +
                           " is no name in GLSL, expected letters, digits and single underscores, no "
                           "digit first, no gl_ first"};
}

}  // namespace

CustomCode readCustomCode(const Fields& fields) {
  CustomCode code{fields.text("glsl"), {}};
  if (code.file.empty()) throw Fault{fields.where("glsl"), "the name is empty, expected a file of GLSL"};
  if (!fields.has("parameters")) return code;
  const Json& json = fields.need("parameters", "an object of numbers and triples");
  const Fields parameters(json, fields.where("parameters"));
  if (json.size() > kMostParameters)
    throw Fault{parameters.where(),
                std::to_string(json.size()) + " parameters, expected at most " + std::to_string(kMostParameters)};
  for (const auto& [name, value] : json.items()) {  // by name: nlohmann's objects are sorted
    checkGlslName(name, parameters.where(name));
    if (value.is_array()) code.parameters.push_back({name, parameters.triple(name)});
    else code.parameters.push_back({name, parameters.number(name)});
  }
  return code;
}

CustomSolid readCustomSolid(const Fields& fields) {
  fields.onlyKeys({"type", "name", "glsl", "parameters", "bounds"});
  CustomSolid solid{readName(fields), readCustomCode(fields), {}};
  if (!fields.has("bounds")) return solid;
  const Fields bounds(fields.need("bounds", "min and max"), fields.where("bounds"));
  bounds.onlyKeys({"min", "max"});
  const Triple low = bounds.triple("min"), high = bounds.triple("max");
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (low[axis] > high[axis])
      throw Fault{bounds.where("max") + numbered("/", axis),
                  shortest(high[axis]) + " is below min, expected at least " + shortest(low[axis])};
  solid.bounds = {low, high};
  return solid;
}

}  // namespace solidcast
