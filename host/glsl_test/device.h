// The device that GLSL tests run on, made once a program.
#pragma once
#include <gtest/gtest.h>

#include "../gpu/device.h"

namespace solidcast::glsl_test {

/// The device that the environment variable SOLIDCAST_DEVICE selects (as gpu::Device::Options::select; the best one
/// where it is not set). Throws Exit::noDevice where there is none, each time.
gpu::Device& device();

/// A fixture whose tests fail where there is no device. A user who has none and wants the other tests' result says so
/// with SOLIDCAST_NO_DEVICE=skip: then they are skipped and listed as skipped. With validation layers on, a message of
/// theirs fails the test.
class Test : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

 private:
  int messages_ = -1;
};

}  // namespace solidcast::glsl_test
