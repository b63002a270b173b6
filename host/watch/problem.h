// What is wrong with an edit, ready to be shown: the file and line that a message names, and that line's text.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace solidcast::watch {

struct Problem {
  std::string file;          // "" where the message names none
  int line = 0, column = 0;  // from 1; 0: unknown
  std::string message;       // without the place
  std::string source;        // text of the line
  bool operator==(const Problem&) const = default;
};

/// Takes the messages of Error apart, one a line: "file:line:column: text", "file:line: error: text", and for scene files
/// "file: /json/path: text", whose line is looked up.
std::vector<Problem> problemsOf(const std::string& messages);

/// "file:line:column: error: message", and below it the line with a mark under the column.
std::string asText(const Problem& problem);

/// The line (from 1) on which the value at a JSON pointer begins; comments are skipped. None: there is no such value.
std::optional<int> lineOf(std::string_view json, std::string_view pointer);

}  // namespace solidcast::watch
