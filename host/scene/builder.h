// Takes a scene file's JSON events (nlohmann's SAX interface) and builds the scene while they come: only the object
// at hand is kept as JSON, so that a file of millions of solids needs little more memory than the World itself.
// Nesting lives on a vector, not on the stack.
#pragma once
#include <string>
#include <unordered_map>
#include <vector>

#include "host/scene/read.h"

namespace solidcast {

/// Collects names and throws at the second use of one.
class UniqueNames {
 public:
  /// `what` says whose name it is, for the message about a second one. Nameless things are free.
  void add(const std::string& name, const std::string& what, const std::string& where);

 private:
  std::unordered_map<std::string, std::string> owners_;
};

/// Throws Fault with whole JSON pointers. A syntax error ends the parse (parse_error is called, the parser returns
/// false) and is then found in `syntaxErrorAt` and `syntaxError`.
class SceneBuilder : public nlohmann::json_sax<Json> {
 public:
  /// `files`, where not null, gets the further files that the scene names.
  SceneBuilder(Scene& scene, std::vector<Fault>& warnings, std::vector<std::string>* files)
      : scene_(scene), warnings_(warnings), files_(files) {}

  std::size_t syntaxErrorAt = 0;  // bytes read when it was found
  std::string syntaxError, syntaxErrorToken;

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }  // never in JSON text
  bool start_object(std::size_t) override;
  bool key(string_t& name) override;
  bool end_object() override;
  bool start_array(std::size_t) override;
  bool end_array() override;
  bool parse_error(std::size_t position, const std::string& token, const nlohmann::detail::exception& error) override;

 private:
  enum class Role { root, solidList, solid, value };
  struct Level {
    Role role;
    Json value;               // the object or list so far; a list of solids stays empty
    std::string key;          // of the member at hand
    std::size_t index = 0;    // of the element at hand
    std::uint32_t group = 0;  // solidList: whose members these are; solid: its own group once it has "solids"
    bool isGroup = false;     // the object has had its "solids"
  };

  bool add(Json value);
  void open(Role role, Json value);
  void finishSolid(Level& solid);
  void finishMesh(const Fields& fields);
  void finishRoot(Level& root);
  std::string where() const;

  Scene& scene_;
  std::vector<Fault>& warnings_;
  std::vector<std::string>* files_;
  std::vector<Level> levels_;
  UniqueNames names_;
  int groupDepth_ = 0;
};

}  // namespace solidcast
