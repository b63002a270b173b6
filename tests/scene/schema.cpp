#include "tests/scene/schema.h"

#include <cmath>
#include <stdexcept>

namespace solidcast {
namespace {

using Json = nlohmann::json;

bool hasType(const std::string& type, const Json& value) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "number") return value.is_number();
  if (type == "integer") return value.is_number() && value.get<double>() == std::floor(value.get<double>());
  throw std::logic_error("schema type " + type);
}

class Validator {
 public:
  explicit Validator(const Json& root) : root_(root) {}

  std::string check(const Json& schema, const Json& value, const std::string& at) const {
    if (schema.contains("$ref"))
      return check(root_.at(Json::json_pointer(schema.at("$ref").get<std::string>().substr(1))), value, at);
    for (const auto& [keyword, rule] : schema.items()) {
      const std::string found = checkKeyword(keyword, rule, schema, value, at);
      if (!found.empty()) return found;
    }
    return "";
  }

 private:
  std::string checkKeyword(const std::string& keyword, const Json& rule, const Json& schema, const Json& value,
                           const std::string& at) const {
    const std::string fails = at + " " + keyword;
    const auto unless = [&](bool fine) { return fine ? std::string() : fails; };
    const auto number = [&] { return value.is_number() ? value.get<double>() : std::nan(""); };
    if (keyword == "$schema" || keyword == "title" || keyword == "description" || keyword == "definitions") return "";
    if (keyword == "type") return unless(hasType(rule, value));
    if (keyword == "const") return unless(value == rule);
    if (keyword == "enum") return unless(std::find(rule.begin(), rule.end(), value) != rule.end());
    if (keyword == "minimum") return unless(!(number() < rule.get<double>()));
    if (keyword == "maximum") return unless(!(number() > rule.get<double>()));
    if (keyword == "exclusiveMinimum") return unless(!(number() <= rule.get<double>()));
    if (keyword == "exclusiveMaximum") return unless(!(number() >= rule.get<double>()));
    if (keyword == "minItems") return unless(!value.is_array() || value.size() >= rule.get<std::size_t>());
    if (keyword == "maxItems") return unless(!value.is_array() || value.size() <= rule.get<std::size_t>());
    if (keyword == "minLength")
      return unless(!value.is_string() || value.get_ref<const std::string&>().size() >= rule.get<std::size_t>());
    if (keyword == "oneOf") {
      int matches = 0;
      for (const Json& option : rule) matches += check(option, value, at).empty();
      return unless(matches == 1);
    }
    if (keyword == "required") {
      for (const Json& key : rule)
        if (value.is_object() && !value.contains(key.get<std::string>())) return fails + " " + key.get<std::string>();
      return "";
    }
    if (keyword == "additionalProperties") {
      if (!value.is_object()) return "";
      const Json known = schema.value("properties", Json::object());
      for (const auto& [key, member] : value.items()) {
        if (known.contains(key)) continue;
        if (rule == Json(false)) return at + "/" + key + " " + keyword;
        const std::string found = check(rule, member, at + "/" + key);
        if (!found.empty()) return found;
      }
      return "";
    }
    if (keyword == "properties") {
      if (!value.is_object()) return "";
      for (const auto& [key, member] : value.items()) {
        if (!rule.contains(key)) continue;
        const std::string found = check(rule.at(key), member, at + "/" + key);
        if (!found.empty()) return found;
      }
      return "";
    }
    if (keyword == "items") {
      for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
        const std::string found = check(rule, value[i], at + "/" + std::to_string(i));
        if (!found.empty()) return found;
      }
      return "";
    }
    throw std::logic_error("schema keyword " + keyword);
  }

  const Json& root_;
};

}  // namespace

std::string violation(const Json& schema, const Json& value) { return Validator(schema).check(schema, value, ""); }

}  // namespace solidcast
