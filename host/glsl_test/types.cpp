#include "host/glsl_test/types.h"

#include <cstdio>

namespace solidcast::glsl_test {
namespace {

struct Row {
  Base base;
  const char *scalar, *vector;
};
constexpr Row rows[] = {{Base::f32, "float", "vec"},
                        {Base::f64, "double", "dvec"},
                        {Base::i32, "int", "ivec"},
                        {Base::u32, "uint", "uvec"},
                        {Base::boolean, "bool", "bvec"}};

template <class T>
T at(const std::byte* element, int i) {
  T value;
  std::memcpy(&value, element + static_cast<std::size_t>(i) * sizeof(T), sizeof(T));
  return value;
}

std::string scalarText(Type type, const std::byte* element, int i) {
  char out[80];
  switch (type.base) {
    case Base::f32:
      std::snprintf(out, sizeof out, "%a (%.9g)", double(at<float>(element, i)), double(at<float>(element, i)));
      return out;
    case Base::f64:
      std::snprintf(out, sizeof out, "%a (%.17g)", at<double>(element, i), at<double>(element, i));
      return out;
    case Base::i32:
      return std::to_string(at<std::int32_t>(element, i));
    case Base::u32:
      return std::to_string(at<std::uint32_t>(element, i));
    case Base::boolean:
      break;
  }
  return at<std::uint32_t>(element, i) != 0 ? "true" : "false";
}

}  // namespace

std::string name(Type type) {
  for (const Row& row : rows) {
    if (row.base == type.base) return type.width == 1 ? row.scalar : std::string(row.vector) + char('0' + type.width);
  }
  return "?";
}

std::optional<Type> typeNamed(std::string_view given) {
  for (const Row& row : rows) {
    for (int width = 1; width <= 4; ++width) {
      if (name({row.base, width}) == given) return Type{row.base, width};
    }
  }
  return std::nullopt;
}

std::string text(Type type, const std::byte* element) {
  if (type.width == 1) return scalarText(type, element, 0);
  std::string out = "(";
  for (int i = 0; i < type.width; ++i) out += (i == 0 ? "" : ", ") + scalarText(type, element, i);
  return out + ")";
}

__float128 component(Type type, const std::byte* element, int i) {
  switch (type.base) {
    case Base::f32:
      return at<float>(element, i);
    case Base::f64:
      return at<double>(element, i);
    case Base::i32:
      return at<std::int32_t>(element, i);
    case Base::u32:
    case Base::boolean:
      break;
  }
  return at<std::uint32_t>(element, i);
}

}  // namespace solidcast::glsl_test
