#include "host/glsl_test/source.h"

#include <cctype>
#include <sstream>

namespace solidcast::glsl_test {
namespace {

const std::string signaturePlace = "signature";  // of generated lines that can only fail by the signature

std::string number(std::size_t i) { return std::to_string(i); }

/// bool has no layout in memory: it travels as uint.
std::string storedScalar(Type type) { return type.base == Base::boolean ? "uint" : name({type.base, 1}); }

std::string buffer(std::size_t binding, bool readOnly, const std::string& scalar, const std::string& array) {
  return "layout(set = 0, binding = " + number(binding) + ", std430) " + (readOnly ? "readonly" : "writeonly") +
         " buffer Block_" + array + " { " + scalar + " " + array + "[]; };\n";
}

/// `array[at + 0], array[at + 1]...` made into the type.
std::string loaded(Type type, const std::string& array, const std::string& index) {
  std::string parts;
  for (int i = 0; i < type.width; ++i) {
    const std::string part =
        array + "[" + index + " * " + std::to_string(type.width) + "u + " + std::to_string(i) + "u]";
    parts += (i == 0 ? "" : ", ") + (type.base == Base::boolean ? part + " != 0u" : part);
  }
  return name(type) + "(" + parts + ")";
}

std::string stored(Type type, const std::string& array, const std::string& variable) {
  std::string out;
  for (int i = 0; i < type.width; ++i) {
    const std::string part = variable + (type.width == 1 ? "" : "[" + std::to_string(i) + "]");
    out += "  " + array + "[glslTestIndex * " + std::to_string(type.width) + "u + " + std::to_string(i) +
           "u] = " + (type.base == Base::boolean ? "uint(" + part + ")" : part) + ";\n";
  }
  return out;
}

}  // namespace

std::string shaderAround(const std::string& snippet, const std::string& name_, const Signature& signature,
                         const std::vector<Parameter>& arrays) {
  std::string head = "#version 460\n#extension GL_GOOGLE_include_directive : require\n";
  std::size_t binding = 0;
  for (const Parameter& array : arrays) {
    // What the snippet sees as name[i]: vec3 and the like are put together from scalars.
    const std::string block = "glslTestArray_" + array.name;
    head += buffer(binding++, true, storedScalar(array.type), block);
    head += name(array.type) + " glslTestGet_" + array.name + "(uint i) { return " + loaded(array.type, block, "i") +
            "; }\n";
    head += "#define " + array.name + "(i) glslTestGet_" + array.name + "(uint(i))\n";
  }
  std::string buffers, loads, stores, arguments;
  for (std::size_t i = 0; i < signature.parameters.size(); ++i) {
    const Parameter& p = signature.parameters[i];
    const std::string variable = "glslTestArgument" + number(i), in = "glslTestIn" + number(i),
                      out = "glslTestOut" + number(i);
    loads += "  " + name(p.type) + " " + variable;
    if (p.in) {
      buffers += buffer(binding++, true, storedScalar(p.type), in);
      loads += " = " + loaded(p.type, in, "((glslTestShared & " + number(1u << i) + "u) != 0u ? 0u : glslTestIndex)");
    }
    loads += ";\n";
    if (p.out) {
      buffers += buffer(binding++, false, storedScalar(p.type), out);
      stores += stored(p.type, out, variable);
    }
    arguments += (i == 0 ? "" : ", ") + variable;
  }
  std::string call = signature.name + "(" + arguments + ");\n";
  if (signature.returns) {
    buffers += buffer(binding++, false, storedScalar(signature.returned), "glslTestReturned");
    stores += stored(signature.returned, "glslTestReturned", "glslTestResult");
    call = name(signature.returned) + " glslTestResult = " + call;
  }
  const auto line = [](const std::string& place) { return "#line 1 \"" + place + "\"\n"; };
  return head + line(name_) + snippet + "\n" + line(signaturePlace) + signature.text() + ";\n" +
         "layout(local_size_x = 64) in;\n"
         "layout(push_constant) uniform GlslTest { uint glslTestCount, glslTestShared; };\n" +
         buffers +
         "void main() {\n"
         "  uint glslTestIndex = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + "
         "gl_LocalInvocationID.x;\n"
         "  if (glslTestIndex >= glslTestCount) return;\n" +
         loads + "  " + call + stores + "}\n";
}

std::string explained(const std::string& message, const std::string& snippet, const std::string& name,
                      const Signature& signature) {
  const bool missing = message.find("No function definition") != std::string::npos;
  if (!missing && !message.starts_with(signaturePlace + ":")) return message;
  std::string out = name + ": error: no function `" + signature.text() + "`";
  std::istringstream lines(snippet);
  std::size_t row = 0;
  std::string found;
  for (std::string line; std::getline(lines, line);) {
    ++row;
    const std::size_t at = line.find(signature.name + "(");
    const bool whole = at != std::string::npos && at > 0 && !std::isalnum(static_cast<unsigned char>(line[at - 1])) &&
                       line[at - 1] != '_';
    if (!whole || line.find_first_not_of(" \t") >= at) continue;
    if (line.substr(0, at).find_first_of("=(;+-*/,") != std::string::npos) continue;  // a call
    const std::size_t end = line.find(')', at), begin = line.find_first_not_of(" \t");
    found += "\n" + name + ":" + number(row) + ": there is `" +
             line.substr(begin, end == std::string::npos ? end : end + 1 - begin) + "`";
  }
  if (!found.empty()) return out + found + (missing ? "" : "\n" + message);
  return out + (missing ? "; the snippet defines none of that name (an included file may, with another signature)"
                        : "\n" + message);
}

}  // namespace solidcast::glsl_test
