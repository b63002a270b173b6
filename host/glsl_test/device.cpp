#include "host/glsl_test/device.h"

#include <cstdlib>
#include <memory>
#include <string_view>

#include "host/error.h"

namespace solidcast::glsl_test {

gpu::Device& device() {
  static std::unique_ptr<gpu::Device> made;
  if (!made) {
    const char* select = std::getenv("SOLIDCAST_DEVICE");
    made = std::make_unique<gpu::Device>(
        gpu::Device::Options{.select = select ? select : "", .validation = gpu::Validation::automatic});
  }
  return *made;
}

void Test::SetUp() {
  const char* without = std::getenv("SOLIDCAST_NO_DEVICE");
  try {
    messages_ = device().validationMessages();
  } catch (const Error& error) {
    if (without && std::string_view(without) == "skip" && error.code() == Exit::noDevice) GTEST_SKIP() << error.what();
    FAIL() << error.what() << "\n(SOLIDCAST_NO_DEVICE=skip skips the tests that need one)";
  }
}

void Test::TearDown() {
  if (messages_ < 0) return;
  EXPECT_EQ(device().validationMessages(), messages_) << "validation messages, see standard error";
}

}  // namespace solidcast::glsl_test
