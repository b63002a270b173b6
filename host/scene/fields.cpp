#include "host/scene/fields.h"

#include <algorithm>
#include <numeric>

namespace solidcast {
namespace {

/// At most 60 bytes, not ending inside a UTF-8 character.
std::string_view beginning(std::string_view text) {
  if (text.size() <= 60) return text;
  std::size_t end = 60;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return text.substr(0, end);
}

std::size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
    }
  }
  return row.back();
}

double toNumber(const Json& value, const std::string& where) {
  if (!value.is_number()) refuse(where, "wrong type: " + typeName(value) + ", expected a number");
  const double number = value.get<double>();
  checkNumber(number, where);
  return number;
}

std::vector<double> toNumbers(const Json& value, std::size_t count, const std::string& where) {
  const std::string expected = ", expected a list of " + std::to_string(count) + " numbers";
  if (!value.is_array()) refuse(where, "wrong type: " + typeName(value) + expected);
  if (value.size() != count) refuse(where, "a list of " + std::to_string(value.size()) + expected);
  std::vector<double> numbers;
  for (std::size_t i = 0; i < count; ++i) numbers.push_back(toNumber(value[i], where + numbered("/", i)));
  return numbers;
}

Triple toTriple(const Json& value, const std::string& where) {
  const std::vector<double> numbers = toNumbers(value, 3, where);
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace

std::string inQuotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : beginning(text)) out += static_cast<unsigned char>(c) < ' ' || c == 127 ? '?' : c;
  return out + (text.size() > 60 ? "...\"" : "\"");
}

std::string pointerPart(std::string_view key) {
  std::string out = "/";
  for (const char c : beginning(key)) {
    if (c == '~') out += "~0";
    else if (c == '/') out += "~1";
    else out += static_cast<unsigned char>(c) < ' ' || c == 127 ? '?' : c;
  }
  return out;
}

std::string_view nearest(std::string_view text, const Names& names) {
  text = beginning(text);
  return *std::min_element(names.begin(), names.end(), [&](std::string_view a, std::string_view b) {
    return editDistance(text, a) < editDistance(text, b);
  });
}

std::string oneOf(std::string_view text, const Names& names) {
  std::string out = "one of ";
  for (const std::string_view name : names) out.append(name).append(name == names.back() ? "" : ", ");
  return out.append(" (the nearest is ").append(nearest(text, names)).append(")");
}

std::string typeName(const Json& value) {
  switch (value.type()) {
    case Json::value_t::null:
      return "null";
    case Json::value_t::boolean:
      return "a boolean";
    case Json::value_t::string:
      return "the text " + inQuotes(value.get_ref<const std::string&>());
    case Json::value_t::array:
      return "a list";
    case Json::value_t::object:
      return "an object";
    default:
      return "a number";
  }
}

Fields::Fields(const Json& value, std::string where) : object_(value), where_(std::move(where)) {
  if (!value.is_object()) refuse(where_, "wrong type: " + typeName(value) + ", expected an object");
}

void Fields::onlyKeys(const Names& known) const {
  for (const auto& [key, value] : object_.items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      refuse(where(key), "unknown key " + inQuotes(key) + ", expected " + oneOf(key, known));
}

const Json& Fields::need(std::string_view key, const std::string& expected) const {
  const auto found = object_.find(std::string(key));
  if (found == object_.end()) refuse(where_, "missing field " + inQuotes(key) + ", expected " + expected);
  return *found;
}

double Fields::number(std::string_view key) const { return toNumber(need(key, "a number"), where(key)); }

bool Fields::flag(std::string_view key) const {
  const Json& value = need(key, "true or false");
  if (!value.is_boolean()) refuse(where(key), "wrong type: " + typeName(value) + ", expected true or false");
  return value.get<bool>();
}

std::string Fields::text(std::string_view key) const {
  const Json& value = need(key, "a text");
  if (!value.is_string()) refuse(where(key), "wrong type: " + typeName(value) + ", expected a text");
  return value.get<std::string>();
}

std::string Fields::choice(std::string_view key, const char* what, const Names& names) const {
  const Json& value = need(key, "the name of a " + std::string(what));
  if (!value.is_string())
    refuse(where(key), "wrong type: " + typeName(value) + ", expected the name of a " + std::string(what));
  const std::string chosen = value.get<std::string>();
  if (std::find(names.begin(), names.end(), chosen) == names.end())
    refuse(where(key), std::string("unknown ") + what + " " + inQuotes(chosen) + ", expected " + oneOf(chosen, names));
  return chosen;
}

std::vector<double> Fields::numbers(std::string_view key, std::size_t count) const {
  return toNumbers(need(key, "a list of " + std::to_string(count) + " numbers"), count, where(key));
}

Triple Fields::triple(std::string_view key) const { return toTriple(need(key, "three numbers"), where(key)); }

std::array<Triple, 3> Fields::threePoints(std::string_view key) const {
  const Json& value = need(key, "three points");
  if (!value.is_array() || value.size() != 3)
    refuse(where(key),
           (value.is_array() ? "a list of " + std::to_string(value.size()) : "wrong type: " + typeName(value)) +
               ", expected three points of three numbers");
  std::array<Triple, 3> points;
  for (std::size_t i = 0; i < 3; ++i) points[i] = toTriple(value[i], where(key) + numbered("/", i));
  return points;
}

}  // namespace solidcast
