// The compute shader that is written around a snippet.
#pragma once
#include <string>
#include <vector>

#include "host/glsl_test/signature.h"

namespace solidcast::glsl_test {

/// Bindings: the arrays first, then for each parameter its input (if in) and its output (if out), at last what is
/// returned. All are arrays of scalars, so that the host's elements lie tightly packed.
std::string shaderAround(const std::string& snippet, const std::string& name, const Signature& signature,
                         const std::vector<Parameter>& arrays);

/// glslang's message when the function with this signature is not there, or nothing like it, put plainly.
std::string explained(const std::string& message, const std::string& snippet, const std::string& name,
                      const Signature& signature);

}  // namespace solidcast::glsl_test
