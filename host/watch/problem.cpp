#include "host/watch/problem.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace solidcast::watch {
namespace {

constexpr std::size_t kLongestLine = 200;  // of a shown source line, in bytes

bool isFile(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

std::string contents(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string sourceLine(const std::string& file, int line) {
  std::ifstream in(file, std::ios::binary);
  std::string text;
  for (int i = 0; i < line && std::getline(in, text);) ++i;
  if (!in) return "";
  if (text.ends_with('\r')) text.pop_back();
  // Only whole UTF-8 characters stay.
  std::size_t most = std::min(text.size(), kLongestLine);
  while (most < text.size() && most > 0 && (text[most] & 0xc0) == 0x80) --most;
  text.resize(most);
  for (char& letter : text)
    if (static_cast<unsigned char>(letter) < ' ') letter = ' ';
  return text;
}

/// A number at `at`, followed by ':'; `at` is moved behind it.
int numberAndColon(const std::string& text, std::size_t& at) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data() + at, text.data() + text.size(), value);
  const std::size_t next = static_cast<std::size_t>(end - text.data());
  if (error != std::errc() || next == at || next >= text.size() || text[next] != ':') return 0;
  at = next + 1;
  return value;
}

/// The longest beginning of the message that is followed by ':' and names a file. A path may hold ':' itself.
std::size_t endOfFile(const std::string& message) {
  for (std::size_t colon = message.rfind(':'); colon != std::string::npos && colon > 0;
       colon = message.rfind(':', colon - 1))
    if (isFile(message.substr(0, colon))) return colon;
  return std::string::npos;
}

Problem problemOf(const std::string& message) {
  Problem problem;
  const std::size_t end = endOfFile(message);
  if (end == std::string::npos) {
    problem.message = message;
    return problem;
  }
  problem.file = message.substr(0, end);
  std::size_t at = end + 1;
  problem.line = numberAndColon(message, at);
  if (problem.line > 0) problem.column = numberAndColon(message, at);
  problem.message = message.substr(std::min(message.find_first_not_of(' ', at), message.size()));
  if (problem.message.starts_with("error: ")) problem.message.erase(0, 7);
  if (problem.line == 0 && problem.message.starts_with('/')) {
    const std::string pointer = problem.message.substr(0, problem.message.find(": "));
    problem.line = lineOf(contents(problem.file), pointer == "/" ? "" : pointer).value_or(0);
  }
  if (problem.line > 0) problem.source = sourceLine(problem.file, problem.line);
  return problem;
}

/// Goes over JSON text as far as needed to find a value; what is not JSON ends the search.
class Finder {
 public:
  explicit Finder(std::string_view text) : text_(text) {}

  /// Moves to the member or element of the value at hand that `part` of a pointer names.
  bool enter(const std::string& part) {
    if (!skipSpace()) return false;
    const char kind = text_[at_++];
    if (kind != '{' && kind != '[') return false;
    for (std::size_t index = 0;; ++index) {
      if (!skipSpace() || text_[at_] == '}' || text_[at_] == ']') return false;
      std::string name = std::to_string(index);
      if (kind == '{') {
        name = key();
        if (!skipSpace() || text_[at_++] != ':') return false;
      }
      if (name == part) return skipSpace();
      skipValue();
      if (!skipSpace() || text_[at_++] != ',') return false;
    }
  }

  bool skipSpace() {
    for (; at_ < text_.size(); ++at_) {
      if (std::isspace(static_cast<unsigned char>(text_[at_]))) continue;
      const bool line = text_.substr(at_, 2) == "//", block = text_.substr(at_, 2) == "/*";
      if (!line && !block) return true;
      const std::size_t end = line ? text_.find('\n', at_) : text_.find("*/", at_ + 2);
      if (end == std::string_view::npos) break;
      at_ = line ? end : end + 1;
    }
    return false;
  }

  int line() const { return 1 + static_cast<int>(std::count(text_.begin(), text_.begin() + at_, '\n')); }

 private:
  /// A string without its quotes; escapes stay as they are but for \" and \\.
  std::string key() {
    std::string text;
    if (at_ >= text_.size() || text_[at_] != '"') return text;
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      text += text_[at_];
    }
    ++at_;
    return text;
  }

  void skipValue() {
    std::size_t depth = 0;
    while (skipSpace()) {
      const char c = text_[at_];
      if (c == '"') {
        key();
      } else if (depth == 0 && (c == ',' || c == '}' || c == ']')) {
        return;
      } else {
        if (c == '{' || c == '[') ++depth;
        if (c == '}' || c == ']') --depth;
        ++at_;
      }
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<Problem> problemsOf(const std::string& messages) {
  std::vector<Problem> problems;
  std::istringstream lines(messages);
  for (std::string line; std::getline(lines, line);) {
    Problem problem = problemOf(line);
    if (std::find(problems.begin(), problems.end(), problem) == problems.end()) problems.push_back(std::move(problem));
  }
  return problems;
}

std::string asText(const Problem& problem) {
  std::string text = problem.file;
  for (const int number : {problem.line, problem.column})
    if (number > 0) text += ":" + std::to_string(number);
  text += (text.empty() ? "error: " : ": error: ") + problem.message + "\n";
  if (problem.source.empty()) return text;
  const std::string number = std::to_string(problem.line);
  text += "  " + number + " | " + problem.source + "\n";
  if (problem.column > 0 && static_cast<std::size_t>(problem.column) <= problem.source.size() + 1)
    text.append(2 + number.size(), ' ').append(" | ").append(problem.column - 1, ' ').append("^\n");
  return text;
}

std::optional<int> lineOf(std::string_view json, std::string_view pointer) {
  Finder finder(json);
  while (!pointer.empty()) {
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    std::string part;
    for (std::size_t i = 1; i < end; ++i) {
      const bool escaped = pointer[i] == '~' && i + 1 < end;
      part += !escaped ? pointer[i] : pointer[i + 1] == '1' ? '/' : '~';
      i += escaped;
    }
    if (!finder.enter(part)) return std::nullopt;
    pointer.remove_prefix(end);
  }
  return finder.skipSpace() ? std::optional(finder.line()) : std::nullopt;
}

}  // namespace solidcast::watch
