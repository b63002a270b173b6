// Calls a GLSL function with arrays of inputs, one element an invocation, and gives back arrays of results.
//
//   glsl_test::Function f(device, R"(float twice(float x) { return 2.0 * x; })", "float twice(float x)");
//   const glsl_test::Call call = f(std::vector<float>{1, 2, 3});
//   call.result().as<float>()  // {2, 4, 6}
//
// docs/glsl-tests.md is the tutorial. This header and those it includes are installed, so they name each other by
// relative paths, which hold in the source tree and under include/solidcast alike.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "../error.h"
#include "../gpu/device.h"
#include "../gpu/shaders.h"
#include "signature.h"
#include "types.h"

#ifndef SOLIDCAST_GLSL_FOLDER
#error "SOLIDCAST_GLSL_FOLDER is not defined: link the CMake target solidcast::glsl_test, which knows the folder"
#endif
#ifndef SOLIDCAST_GLSL_TEST_FOLDERS  // "folder", "folder", each with a comma behind it
#define SOLIDCAST_GLSL_TEST_FOLDERS
#endif

namespace solidcast::glsl_test {

struct Options {
  gpu::Defines defines{};                        // macros of the snippet
  std::vector<std::filesystem::path> folders{};  // where #include looks after the including file's own folder
  /// Arrays that the snippet reads beside its parameters, e.g. {"vec4 rows"}: there `rows(i)`, here set("rows", ...).
  std::vector<std::string> arrays{};
  gpu::Specialisation specialisation{};
  std::string name = "snippet";  // stands for the snippet in messages
  int runs = 5;                  // timed ones, after one that is not (the driver compiles in it)
  /// Where #include looks at last, as the build of the test knows it: the folders given to the CMake function
  /// solidcast_glsl_test(), then the one of solidcast's own GLSL ("solidcast/solids/sphere.glsl").
  std::vector<std::filesystem::path> buildFolders{SOLIDCAST_GLSL_TEST_FOLDERS SOLIDCAST_GLSL_FOLDER};
};

class Call;

/// One output of a call: what the function returned ("return"), or an out or inout parameter.
class Output {
 public:
  const std::string& name() const;
  Type type() const;
  std::size_t count() const;
  /// Throws Exit::usage where T is not the C++ element of the GLSL type.
  template <Element T>
  std::vector<T> as() const {
    requireType(ElementOf<T>::type);
    std::vector<T> values(count());
    for (std::size_t i = 0; i < values.size(); ++i) {
      T value;
      read(element(i), value);
      values[i] = value;
    }
    return values;
  }
  const std::byte* element(std::size_t i) const;
  /// The inputs of element i, one `name = value` a line, floats in hex.
  std::string inputsOf(std::size_t i) const;

 private:
  friend class Call;
  friend class Function;
  struct Data;
  Output(std::shared_ptr<const Data> data, std::size_t which) : data_(std::move(data)), which_(which) {}
  void requireType(Type wanted) const;
  template <class T>
  static void read(const std::byte* from, T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      std::uint32_t word;
      std::memcpy(&word, from, sizeof word);
      value = word != 0;
    } else if constexpr (std::is_arithmetic_v<T>) {
      std::memcpy(&value, from, sizeof value);
    } else {
      for (auto& c : value) {
        read(from, c);
        from += std::is_same_v<std::decay_t<decltype(c)>, bool> ? sizeof(std::uint32_t) : sizeof c;
      }
    }
  }

  std::shared_ptr<const Data> data_;
  std::size_t which_;
};

/// The results of one call over arrays, and its time.
class Call {
 public:
  Output result() const { return (*this)["return"]; }
  /// An out or inout parameter by name; throws Exit::usage for others.
  Output operator[](const std::string& name) const;
  std::size_t count() const;
  /// GPU time of one element, loads and stores of its parameters included: median, fastest and slowest of Options::runs.
  double nanoseconds() const, nanosecondsLeast() const, nanosecondsMost() const;

 private:
  friend class Function;
  explicit Call(std::shared_ptr<const Output::Data> data) : data_(std::move(data)) {}
  std::shared_ptr<const Output::Data> data_;
};

class Function {
 public:
  /// Compiles now. Throws Exit::shader for GLSL errors (`snippet:line: error: ...`), a missing function and one with
  /// another signature (with what is there), Exit::usage for a signature that is none, Exit::noDevice where the device
  /// lacks what the code needs.
  Function(gpu::Device& device, const std::string& snippet, const std::string& signature, const Options& options = {});
  ~Function();
  Function(Function&&) noexcept;

  /// Fills one of Options::arrays; it stays until it is set again.
  void set(const std::string& array, const Values& values);

  /// One argument for each in and inout parameter, in their order: arrays of one length, or single values that serve
  /// every element. Throws Exit::usage for another number, type or length of arguments.
  template <class... Arguments>
  Call operator()(const Arguments&... arguments) {
    return call({Values(arguments)...});
  }
  Call call(std::vector<Values> inputs);
  /// For functions without in parameters, and where all arguments are single values.
  Call callTimes(std::size_t count, std::vector<Values> inputs);

  const std::vector<std::uint32_t>& spirv() const;
  /// The compute shader written around the snippet.
  const std::string& source() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace solidcast::glsl_test
