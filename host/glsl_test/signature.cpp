#include "host/glsl_test/signature.h"

#include <cctype>
#include <set>

#include "host/error.h"

namespace solidcast::glsl_test {
namespace {

/// Names, and every other character that is no space as a token of its own.
std::vector<std::string> tokens(const std::string& text) {
  std::vector<std::string> out;
  bool inName = false;
  for (const char c : text) {
    const bool letter = std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    if (letter && inName) {
      out.back() += c;
    } else if (!std::isspace(static_cast<unsigned char>(c))) {
      out.emplace_back(1, c);
    }
    inName = letter;
  }
  return out;
}

class Parser {
 public:
  explicit Parser(const std::string& text) : text_(text), tokens_(tokens(text)) {}

  Signature signature() {
    Signature s;
    const std::string returned = next("a return type");
    if (returned != "void") s.returns = true, s.returned = type(returned);
    s.name = identifier("the function's name");
    expect("(");
    if (peek() == "void") next("void");
    while (peek() != ")") {
      if (!s.parameters.empty()) expect(",");
      s.parameters.push_back(parameter());
    }
    expect(")");
    if (peek() == ";") expect(";");
    if (!peek().empty()) fail("\"" + peek() + "\" after the closing bracket");
    std::set<std::string> names{"return"};
    for (const Parameter& p : s.parameters) {
      if (!names.insert(p.name).second) fail("two parameters \"" + p.name + "\"");
    }
    return s;
  }

  Parameter parameter() {
    Parameter p;
    const std::set<std::string> plain{"const", "precise", "highp", "mediump", "lowp"};
    for (;; ++at_) {
      const std::string word = peek();
      if (word == "out" || word == "inout") {
        p.out = true;
        p.in = word == "inout";
      } else if (word != "in" && !plain.contains(word)) {
        break;
      }
    }
    p.type = type(next("a type"));
    p.name = identifier("a parameter's name");
    if (peek() == "[") fail("parameter \"" + p.name + "\" is an array");
    return p;
  }
  void end() {
    if (!peek().empty()) fail("\"" + peek() + "\" after the name");
  }

 private:
  std::string peek() const { return at_ < tokens_.size() ? tokens_[at_] : ""; }
  std::string next(const std::string& wanted) {
    if (at_ == tokens_.size()) fail(wanted + " is missing");
    return tokens_[at_++];
  }
  std::string identifier(const std::string& wanted) {
    const std::string word = next(wanted);
    if (!std::isalpha(static_cast<unsigned char>(word[0])) && word[0] != '_') {
      fail(wanted + " is missing before \"" + word + "\"");
    }
    return word;
  }
  void expect(const std::string& token) {
    const std::string found = peek();
    if (found != token) fail("expected \"" + token + "\"" + (found.empty() ? "" : ", found \"" + found + "\""));
    ++at_;
  }
  Type type(const std::string& word) {
    if (const auto found = typeNamed(word)) return *found;
    fail("type \"" + word +
         "\" cannot be passed from C++ (float, double, int, uint, bool and their vectors can); write a GLSL function "
         "around yours that takes it apart");
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Exit::usage, "signature \"" + text_ + "\": " + what);
  }

  std::string text_;
  std::vector<std::string> tokens_;
  std::size_t at_ = 0;
};

}  // namespace

std::string Signature::text() const {
  std::string out = (returns ? glsl_test::name(returned) : "void") + " " + name + "(";
  for (const Parameter& p : parameters) {
    if (&p != &parameters.front()) out += ", ";
    out += (p.out ? p.in ? "inout " : "out " : "") + glsl_test::name(p.type) + " " + p.name;
  }
  return out + ")";
}

Signature parseSignature(const std::string& text) { return Parser(text).signature(); }

Parameter parseArray(const std::string& text) {
  Parser parser(text);
  Parameter p = parser.parameter();
  parser.end();
  return p;
}

}  // namespace solidcast::glsl_test
