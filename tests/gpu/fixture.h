// Tests on lavapipe with the validation layer: a single message of it fails the test.
#pragma once
#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "host/error.h"
#include "host/gpu/device.h"
#include "host/gpu/shaders.h"

namespace solidcast::gpu {

class OnLavapipe : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    device_ = std::make_unique<Device>(Device::Options{.select = "llvmpipe", .validation = Validation::on});
  }
  static void TearDownTestSuite() { device_.reset(); }
  void SetUp() override {
    ASSERT_TRUE(device().validationActive());
    before_ = device().validationMessages();
  }
  void TearDown() override { EXPECT_EQ(device().validationMessages(), before_) << "see standard error"; }

  static Device& device() { return *device_; }

  static Pipeline pipeline(const std::string& glsl, const Specialisation& specialisation = {}) {
    const CompiledModule module = compileText(glsl, "test.comp", {});
    EXPECT_EQ(validationError(module.spirv), "");
    return device().makePipeline(module.spirv, specialisation);
  }

  template <class T>
  static Buffer filled(const std::vector<T>& values, BufferUse use = BufferUse::storage) {
    Buffer buffer = device().makeBuffer(values.size() * sizeof(T), use);
    std::memcpy(buffer.bytes().data(), values.data(), values.size() * sizeof(T));
    return buffer;
  }

  template <class T>
  static std::vector<T> read(const Buffer& buffer) {
    const auto values = buffer.as<T>();
    return {values.begin(), values.end()};
  }

  static double run(const Dispatch& dispatch) { return device().run({&dispatch, 1}); }

 private:
  inline static std::unique_ptr<Device> device_;
  int before_ = 0;
};

/// The error that `action` throws, checked for its exit code and for being one line; "" when it throws none.
template <class Action>
std::string errorOf(Exit code, Action&& action, bool oneLine = true) {
  try {
    action();
  } catch (const Error& error) {
    const std::string text = error.what();
    EXPECT_EQ(int(error.code()), int(code)) << text;
    if (oneLine) { EXPECT_EQ(text.find('\n'), std::string::npos) << text; }
    return text;
  }
  ADD_FAILURE() << "no error was thrown";
  return {};
}

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Sets environment variables (nullptr: removes) and puts the old values back.
class ScopedEnvironment {
 public:
  ScopedEnvironment(std::initializer_list<std::pair<const char*, const char*>> values) {
    for (const auto& [name, value] : values) {
      const char* old = std::getenv(name);
      old_.push_back({name, old ? std::optional<std::string>(old) : std::nullopt});
      set(name, value);
    }
  }
  ~ScopedEnvironment() {
    for (const auto& [name, value] : old_) set(name, value ? value->c_str() : nullptr);
  }
  ScopedEnvironment(const ScopedEnvironment&) = delete;

 private:
  static void set(const char* name, const char* value) { value ? setenv(name, value, 1) : unsetenv(name); }
  std::vector<std::pair<const char*, std::optional<std::string>>> old_;
};

}  // namespace solidcast::gpu
