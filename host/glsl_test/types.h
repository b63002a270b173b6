// GLSL's scalar and vector types beside their C++ elements: float is float, vec3 is std::array<float, 3>, and so on.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace solidcast::glsl_test {

enum class Base { f32, f64, i32, u32, boolean };

struct Type {
  Base base = Base::f32;
  int width = 1;  // 1: scalar; 2 to 4: vector
  bool operator==(const Type&) const = default;
  std::size_t componentBytes() const { return base == Base::f64 ? 8 : 4; }
  std::size_t bytes() const { return componentBytes() * static_cast<std::size_t>(width); }
};

/// "dvec3"; the scalar it is made of is name({base, 1}).
std::string name(Type type);
/// Nothing for what is no scalar or vector type of GLSL.
std::optional<Type> typeNamed(std::string_view name);

template <class T>
struct ElementOf;  // undefined: T has no counterpart in GLSL
template <>
struct ElementOf<float> {
  static constexpr Type type{Base::f32, 1};
};
template <>
struct ElementOf<double> {
  static constexpr Type type{Base::f64, 1};
};
template <>
struct ElementOf<std::int32_t> {
  static constexpr Type type{Base::i32, 1};
};
template <>
struct ElementOf<std::uint32_t> {
  static constexpr Type type{Base::u32, 1};
};
template <>
struct ElementOf<bool> {
  static constexpr Type type{Base::boolean, 1};
};
template <class T, std::size_t N>
requires(N >= 2 && N <= 4) struct ElementOf<std::array<T, N>> {
  static constexpr Type type{ElementOf<T>::type.base, static_cast<int>(N)};
};
template <class T>
concept Element = requires {
  ElementOf<T>::type;
};

/// An array of inputs, or one value for every element. Made from what the test has at hand; the contents are copied.
class Values {
 public:
  template <Element T>
  Values(const std::vector<T>& elements) : type_(ElementOf<T>::type), count_(elements.size()) {
    for (const T& element : elements) append(element);
  }
  template <Element T>
  Values(std::span<const T> elements) : type_(ElementOf<T>::type), count_(elements.size()) {
    for (const T& element : elements) append(element);
  }
  template <Element T>
  Values(const T& everywhere) : type_(ElementOf<T>::type), count_(1), shared_(true) {
    append(everywhere);
  }
  /// Bytes as they lie in memory, components tightly packed (a vec3 takes 12 bytes).
  Values(Type type, std::span<const std::byte> bytes)
      : type_(type), count_(bytes.size() / type.bytes()), bytes_(bytes.begin(), bytes.end()) {}

  Type type() const { return type_; }
  std::size_t count() const { return count_; }
  bool shared() const { return shared_; }  // one value for every element
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  template <class T>
  void append(const T& element) {
    if constexpr (std::is_same_v<T, bool>) {
      append(std::uint32_t{element});
    } else if constexpr (std::is_arithmetic_v<T>) {
      const std::size_t end = bytes_.size();
      bytes_.resize(end + sizeof element);
      std::memcpy(bytes_.data() + end, &element, sizeof element);
    } else {
      for (const auto& component : element) append(component);
    }
  }

  Type type_;
  std::size_t count_ = 0;
  bool shared_ = false;
  std::vector<std::byte> bytes_;
};

/// One element as people read it: "0x1.8p+1 (3)", "(1, 2, 3)"; floats in hex with every bit.
std::string text(Type type, const std::byte* element);

/// Component `i` of packed values, exactly.
__float128 component(Type type, const std::byte* element, int i);

}  // namespace solidcast::glsl_test
