// What the readers of mesh files share: a cursor over the text of a file that knows its line, and the making of triangles.
#pragma once
#include <span>
#include <string_view>

#include "host/scene/mesh.h"

namespace solidcast {

/// Words and numbers, one after another. Numbers are rounded correctly and do not depend on the locale.
class MeshText {
 public:
  MeshText(std::string_view file, std::string_view text) : file_(file), text_(text) {}

  /// Throws Fault "FILE:LINE: what".
  [[noreturn]] void refuse(const std::string& what) const;

  bool done() const { return at_ == text_.size(); }
  /// Goes over blanks (a backslash at the end of a line joins it with the next); true where the line ends.
  bool lineEnds();
  void nextLine();
  /// Goes over blanks and ends of lines.
  void skipSpace();
  /// Up to the next blank; empty where the line ends.
  std::string_view word();
  /// `what` names the number in a message.
  double real(const char* what);
  std::int64_t whole(const char* what);
  /// True, and goes on, when the next character is this one.
  bool take(char c);
  /// The next character; none at the end.
  char peek() const { return done() ? '\0' : text_[at_]; }
  std::string_view rest() const { return text_.substr(at_); }

 private:
  [[noreturn]] void refuseNumber(const char* what);
  void refuseUnlessEnded(std::size_t begin, const char* what);

  std::string_view file_;
  std::string_view text_;
  std::size_t at_ = 0;
};

/// Collects faces as fans of triangles.
class Faces {
 public:
  void add(Mesh& mesh, std::span<const std::uint32_t> corners);
  /// Counts the polygons that are not convex; for when all vertices are known.
  void finish(Mesh& mesh) const;

 private:
  struct Fan {
    std::size_t first, count;  // triangles
  };
  std::vector<Fan> fans_;  // of more than one triangle
};

Mesh readPly(const std::string& file, std::string_view text);
Mesh readObj(const std::string& file, std::string_view text);

}  // namespace solidcast
