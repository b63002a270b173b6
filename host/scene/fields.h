// Typed reading of one JSON object. Every refusal is a Fault whose place is a JSON pointer from where the object was
// handed in, and whose text says what was found and what was expected.
#pragma once
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "host/scene/rules.h"
#include "host/scene/world.h"

namespace solidcast {

using Json = nlohmann::json;
using Names = std::vector<std::string_view>;

/// Text from a scene file made fit for a message: one line, not long, in quotes.
std::string inQuotes(std::string_view text);

/// "/key" with the two characters that a JSON pointer escapes.
std::string pointerPart(std::string_view key);

/// The name that takes the fewest edits (Levenshtein) to reach; the first of equals. `names` is not empty.
std::string_view nearest(std::string_view text, const Names& names);

/// "one of a, b, c (the nearest is b)".
std::string oneOf(std::string_view text, const Names& names);

/// "a string", "a list", ...
std::string typeName(const Json& value);

class Fields {
 public:
  /// `value` must outlive the reader. Throws unless it is an object.
  Fields(const Json& value, std::string where);

  const std::string& where() const { return where_; }
  std::string where(std::string_view key) const { return where_ + pointerPart(key); }

  /// Throws at the first key that is not among `known`.
  void onlyKeys(const Names& known) const;

  bool has(std::string_view key) const { return object_.contains(std::string(key)); }
  double number(std::string_view key) const;
  bool flag(std::string_view key) const;
  std::string text(std::string_view key) const;
  /// A text that is one of `names`; `what` it names is said in the message.
  std::string choice(std::string_view key, const char* what, const Names& names) const;
  std::vector<double> numbers(std::string_view key, std::size_t count) const;
  Triple triple(std::string_view key) const;
  std::array<Triple, 3> threePoints(std::string_view key) const;
  /// Throws with `expected` when the field is missing.
  const Json& need(std::string_view key, const std::string& expected) const;

 private:
  const Json& object_;
  std::string where_;
};

}  // namespace solidcast
