// The signature of a GLSL function as its tester writes it: "float f(float a, out vec3 b)".
#pragma once
#include <string>
#include <vector>

#include "types.h"

namespace solidcast::glsl_test {

struct Parameter {
  std::string name;
  Type type;
  bool in = true, out = false;
};

struct Signature {
  std::string name;
  std::vector<Parameter> parameters;
  bool returns = false;
  Type returned;

  std::string text() const;  // tidied, as messages show it
};

/// Throws Exit::usage for what is no signature, and for types without a counterpart (arrays, matrices, structs: write
/// a small GLSL function around yours that takes them apart).
Signature parseSignature(const std::string& text);

/// "vec4 rows" of Options::arrays.
Parameter parseArray(const std::string& text);

}  // namespace solidcast::glsl_test
