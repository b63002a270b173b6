#include "host/cast/loop_guard.h"

#include <algorithm>
#include <cctype>
#include <regex>

#include "host/error.h"

namespace solidcast {
namespace {

bool inWord(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

std::uint32_t lineAt(const std::string& text, std::size_t at) {
  return 1 + static_cast<std::uint32_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
}

/// Where the head that opens at `open` ends, and the semicolons of its own level.
struct Head {
  std::size_t close = std::string::npos;
  std::vector<std::size_t> semicolons;
};
Head headAt(const std::string& plain, std::size_t open) {
  Head head;
  int depth = 0;
  for (std::size_t i = open; i < plain.size(); ++i) {
    const char c = plain[i];
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
    if (c == ';' && depth == 1) head.semicolons.push_back(i);
    if (depth > 0) continue;
    head.close = i;
    break;
  }
  return head;
}

/// `bool more = f()` may stand where a condition does, but not behind &&.
bool declares(const std::string& condition) {
  static const std::regex pattern(R"(^\s*[A-Za-z_]\w*\s+[A-Za-z_]\w*\s*=[^=][\s\S]*)");
  return std::regex_match(condition, pattern);
}

}  // namespace

std::string withoutComments(const std::string& glsl) {
  std::string plain = glsl;
  for (std::size_t i = 0; i + 1 < plain.size(); ++i) {
    if (plain[i] != '/' || (plain[i + 1] != '/' && plain[i + 1] != '*')) continue;
    const bool line = plain[i + 1] == '/';
    std::size_t end = line ? plain.find('\n', i) : plain.find("*/", i + 2);
    if (end == std::string::npos) end = plain.size();
    else if (!line) end += 2;
    for (; i < end; ++i)
      if (plain[i] != '\n') plain[i] = ' ';
    --i;
  }
  return plain;
}

std::string LoopGuard::guarded(const gpu::SourceText& source) {
  auto known = std::find(files_.begin(), files_.end(), source.name);
  if (known == files_.end()) known = files_.insert(files_.end(), source.name);
  const auto file = static_cast<std::uint32_t>(known - files_.begin());
  if (file >> fileBits)
    throw Error(Exit::shader, source.name + ":1: error: one file more than " + std::to_string(1u << fileBits) +
                                  " included, expected fewer");
  const std::string plain = withoutComments(source.text);
  struct Insert {
    std::size_t at;
    std::string text;
  };
  std::vector<Insert> inserts;
  for (std::size_t i = 0; i < plain.size();) {
    if (!inWord(plain[i])) {
      ++i;
      continue;
    }
    const std::size_t begin = i;
    while (i < plain.size() && inWord(plain[i])) ++i;
    const std::string word = plain.substr(begin, i - begin);
    if (word != "for" && word != "while") continue;
    const std::uint32_t line = lineAt(plain, begin);
    const auto refuse = [&](const std::string& what) {
      throw Error(Exit::shader, source.name + ":" + std::to_string(line) + ": error: " + what);
    };
    const std::size_t open = plain.find_first_not_of(" \t\r\n\\", i);
    if (open == std::string::npos || plain[open] != '(') refuse("'" + word + "' without a head, expected (");
    const Head head = headAt(plain, open);
    if (head.close == std::string::npos) refuse("the head of this '" + word + "' does not end, expected )");
    if (head.semicolons.size() != (word == "for" ? 2u : 0u))
      refuse("the head of this '" + word + "' has " + std::to_string(head.semicolons.size()) +
             " semicolons, expected " + (word == "for" ? "2" : "none"));
    const std::size_t from = word == "for" ? head.semicolons[0] + 1 : open + 1;
    const std::size_t to = word == "for" ? head.semicolons[1] : head.close;
    const std::string condition = plain.substr(from, to - from);
    if (declares(condition)) refuse("a loop's condition declares a variable, expected an expression");
    const std::string call =
        "solidcast_guard(" + std::to_string(file << lineBits | std::min(line, (1u << lineBits) - 1)) + "u)";
    if (condition.find_first_not_of(" \t\r\n\\") == std::string::npos) {
      inserts.push_back({from, call});
    } else {
      inserts.push_back({from, call + " && ("});
      inserts.push_back({to, ")"});
    }
  }
  // Heads do not nest in each other's conditions, but a body between them may hold any: in order of the text.
  std::stable_sort(inserts.begin(), inserts.end(), [](const Insert& a, const Insert& b) { return a.at < b.at; });
  std::string out;
  std::size_t done = 0;
  for (const Insert& insert : inserts) {
    out.append(source.text, done, insert.at - done).append(insert.text);
    done = insert.at;
  }
  return out.append(source.text, done);
}

std::string LoopGuard::place(std::uint32_t number) const {
  number &= (1u << (lineBits + fileBits)) - 1;
  return files_.at(number >> lineBits) + ":" + std::to_string(number & ((1u << lineBits) - 1));
}

}  // namespace solidcast
