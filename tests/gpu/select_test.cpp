// Which device is taken, and what is said when there is none.
#include "host/gpu/select.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "host/carried/carried.h"
#include "host/carried/probe.h"
#include "tests/gpu/fixture.h"

namespace solidcast::gpu {
namespace {

std::vector<DeviceInfo> machine() {
  std::vector<DeviceInfo> devices(4);
  const std::pair<const char*, const char*> all[] = {{"llvmpipe (LLVM 15)", "cpu"},
                                                     {"Graphics 770", "integrated gpu"},
                                                     {"RTX 4090", "discrete gpu"},
                                                     {"SwiftShader Device", "cpu"}};
  for (int i = 0; i < 4; ++i) {
    devices[i].index = i;
    devices[i].name = all[i].first;
    devices[i].type = all[i].second;
  }
  return devices;
}

TEST(SelectTest, TakesGpusBeforeCpus) {
  EXPECT_EQ(selectDevice(machine(), ""), 2u);
  std::vector<DeviceInfo> devices = machine();
  devices.erase(devices.begin() + 2);
  EXPECT_EQ(selectDevice(devices, ""), 1u);
  EXPECT_EQ(selectDevice({devices[0]}, ""), 0u);
}

TEST(SelectTest, KindsNumbersAndNames) {
  EXPECT_EQ(selectDevice(machine(), "cpu"), 0u);
  EXPECT_EQ(selectDevice(machine(), "GPU"), 2u);
  EXPECT_EQ(selectDevice(machine(), "3"), 3u);
  EXPECT_EQ(selectDevice(machine(), "swift"), 3u);
  EXPECT_EQ(selectDevice(machine(), "4090"), 2u);  // no such index, but part of one name
  EXPECT_EQ(selectDevice(machine(), "770"), 1u);
}

TEST(SelectTest, RefusesWithTheListOfDevices) {
  const std::string list =
      "; there is: 0 = llvmpipe (LLVM 15) (cpu), 1 = Graphics 770 (integrated gpu), 2 = RTX 4090 (discrete gpu), "
      "3 = SwiftShader Device (cpu)";
  EXPECT_EQ(errorOf(Exit::usage, [] { selectDevice(machine(), "radeon"); }), "no device \"radeon\"" + list);
  EXPECT_EQ(errorOf(Exit::usage, [] { selectDevice(machine(), "17"); }), "no device \"17\"" + list);
  EXPECT_EQ(errorOf(Exit::usage, [] { selectDevice(machine(), "-1"); }), "no device \"-1\"" + list);
  EXPECT_EQ(errorOf(Exit::usage, [] { selectDevice(machine(), "99999999999999999999"); }),
            "no device \"99999999999999999999\"" + list);
  EXPECT_EQ(errorOf(Exit::usage, [] { selectDevice(machine(), "e"); }), "device \"e\" fits 2 devices" + list);
  EXPECT_EQ(errorOf(Exit::usage, [] { selectDevice({machine()[0]}, "gpu"); }),
            "no device \"gpu\"; there is: 0 = llvmpipe (LLVM 15) (cpu)");
}

TEST(SelectTest, DriversOfHardwareAreLeftOutWhereThereIsNone) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("devices" + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  EXPECT_NE(driversWithoutHardware(folder).find("radeon_*"), std::string::npos);
  EXPECT_EQ(driversWithoutHardware(folder).find("lvp"), std::string::npos);  // software needs no hardware
  std::filesystem::create_directory(folder / "dri");
  EXPECT_EQ(driversWithoutHardware(folder), "");
  std::filesystem::remove_all(folder);
}

TEST(SelectTest, UnknownDeviceOnThisMachine) {
  const auto message = errorOf(Exit::usage, [] { Device({.select = "voodoo"}); });
  EXPECT_TRUE(message.starts_with("no device \"voodoo\"; there is: 0 = ")) << message;
}

TEST(NoDeviceTest, SaysWhatWasLookedForAndWhatToInstall) {
  const ScopedEnvironment nothing{{"VK_ICD_FILENAMES", "/nonexistent/icd.json"}, {"VK_DRIVER_FILES", nullptr}};
  for (const auto& message : {errorOf(Exit::noDevice, [] { listDevices(); }),
                              errorOf(Exit::noDevice, [] { Device({.validation = Validation::off}); })}) {
    EXPECT_TRUE(contains(message, "no Vulkan device")) << message;
    EXPECT_TRUE(contains(message, "VK_ICD_FILENAMES=/nonexistent/icd.json")) << message;
    EXPECT_TRUE(contains(message, "/nonexistent/icd.json does not exist")) << message;
    EXPECT_TRUE(contains(message, "mesa-vulkan-drivers")) << message;
  }
}

TEST(NoDeviceTest, NamesTheFoldersAndDriverFilesSeen) {
  const ScopedEnvironment plain{{"VK_ICD_FILENAMES", nullptr}, {"VK_DRIVER_FILES", nullptr}};
  const std::string message = noDeviceMessage("for the test");
  EXPECT_TRUE(contains(message, "looked for driver files in ")) << message;
  EXPECT_TRUE(contains(message, "/usr/share/vulkan/icd.d")) << message;
  EXPECT_TRUE(contains(message, "lvp_icd")) << message;
}

// --- SwiftShader: a device without float64 --------------------------------------------------------

/// The ICD file that tools/swiftshader prints.
std::string swiftShader() {
  const std::string command = "'" SOLIDCAST_SOURCE_DIR "/tools/swiftshader' '" SOLIDCAST_BINARY_DIR "/swiftshader'";
  std::string path;
  FILE* out = popen(command.c_str(), "r");
  for (int c; out && (c = std::fgetc(out)) != EOF;) {
    if (c != '\n') path += char(c);
  }
  EXPECT_EQ(out ? pclose(out) : -1, 0) << command;
  return path;
}

TEST(SwiftShaderTest, Float64IsRefusedByNameAndFloat32Runs) {
  const std::string icd = swiftShader();
  const ScopedEnvironment drivers{{"VK_ICD_FILENAMES", icd.c_str()}, {"VK_DRIVER_FILES", icd.c_str()}};
  Device device({.select = "swiftshader", .validation = Validation::on});
  EXPECT_FALSE(device.info().float64);
  EXPECT_EQ(device.info().limits.maxWorkGroupInvocations, 256u);
  const auto message = errorOf(Exit::noDevice, [&] { device.makePipeline(carriedModule("probe_f64")); });
  EXPECT_EQ(message, "the shader needs Float64, which " + device.info().name + " does not offer");

  const ArithmeticReport report = probeArithmetic(device, false);
  EXPECT_TRUE(report.exactOperations());
  EXPECT_TRUE(report.precise && report.uncontracted && report.twoSum && report.twoProduct);
  EXPECT_EQ(report.fma, "not fused");
  EXPECT_EQ(loopIterations(device, 1'000'000), 1'000'000u);
  EXPECT_EQ(device.validationMessages(), 0);
}

}  // namespace
}  // namespace solidcast::gpu
