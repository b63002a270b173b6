// A validator for the part of JSON Schema draft 7 that scenes/scene.schema.json uses; a keyword it does not know is an
// error, so that the schema cannot outgrow it unnoticed.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace solidcast {

/// "" when `value` is valid, else the JSON pointer of the first violation and the keyword that it violates.
std::string violation(const nlohmann::json& schema, const nlohmann::json& value);

}  // namespace solidcast
