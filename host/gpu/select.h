// Which device is meant, and what people read when there is none.
#pragma once
#include <string>
#include <vector>

#include "host/gpu/device.h"

namespace solidcast::gpu {

/// Place in `devices` of the one meant by `select`, as Device::Options says: "" is the best there is (a discrete GPU
/// first, a CPU last), "cpu" and "gpu" the best of a kind, digits an index where there is one of that index, all else
/// a part of a name in any case. Throws Exit::usage, listing the devices, when none or several fit.
std::size_t selectDevice(const std::vector<DeviceInfo>& devices, const std::string& select);

/// Pattern of driver files, as the loader's VK_LOADER_DRIVERS_DISABLE takes it, of the drivers of Mesa that can only find a
/// device under `folder` ("/dev"), where that has none; "" where it has one. Loading them takes a sixth of an instance's time.
std::string driversWithoutHardware(const std::string& folder);

/// One line: `why`, what was looked for, which driver files were seen, what to install.
std::string noDeviceMessage(const std::string& why);

}  // namespace solidcast::gpu
