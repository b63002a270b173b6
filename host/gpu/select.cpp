#include "host/gpu/select.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "host/error.h"

namespace solidcast::gpu {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// Lower is better for someone who names no device.
int rank(const DeviceInfo& device) {
  if (device.type == "discrete gpu") return 0;
  if (device.type == "integrated gpu") return 1;
  if (device.type == "virtual gpu") return 2;
  return device.type == "cpu" ? 4 : 3;
}

[[noreturn]] void refuse(const std::vector<DeviceInfo>& devices, const std::string& why) {
  std::string line = why + "; there is:";
  for (const DeviceInfo& device : devices) {
    line += (&device == &devices.front() ? " " : ", ") + std::to_string(device.index) + " = " + device.name + " (" +
            device.type + ")";
  }
  throw Error(Exit::usage, line);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);) {
    if (!part.empty()) parts.push_back(part);
  }
  return parts;
}

std::string variable(const char* name, const std::string& otherwise = "") {
  const char* value = std::getenv(name);
  return value && *value ? value : otherwise;
}

/// Driver files as the loader looks for them on Linux.
std::string driversSeen() {
  std::error_code ignored;
  for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
    const std::string value = variable(name);
    if (value.empty()) continue;
    std::string out = std::string(name) + "=" + value;
    for (const std::string& file : split(value, ':')) {
      if (!fs::exists(file, ignored)) out += "; " + file + " does not exist";
    }
    return out;
  }
  const std::string home = variable("HOME");
  std::vector<std::string> roots{variable("XDG_CONFIG_HOME", home + "/.config")};
  for (const auto& root : split(variable("XDG_CONFIG_DIRS", "/etc/xdg"), ':')) roots.push_back(root);
  roots.push_back("/etc");
  roots.push_back(variable("XDG_DATA_HOME", home + "/.local/share"));
  for (const auto& root : split(variable("XDG_DATA_DIRS", "/usr/local/share:/usr/share"), ':')) roots.push_back(root);
  std::string folders, found;
  for (const std::string& root : roots) {
    const fs::path folder = fs::path(root) / "vulkan/icd.d";
    folders += (folders.empty() ? "" : ", ") + folder.string();
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      if (entry.path().extension() == ".json") found += (found.empty() ? "" : ", ") + entry.path().string();
    }
  }
  return "looked for driver files in " + folders + "; found " + (found.empty() ? "none" : found);
}

}  // namespace

std::string driversWithoutHardware(const std::string& folder) {
  std::error_code ignored;
  for (const char* node : {"dri", "dxg", "kfd", "kgsl-3d0", "mali0"})
    if (fs::exists(fs::path(folder) / node, ignored)) return "";
  return "intel_*,radeon_*,nouveau_*,virtio_*,broadcom_*,freedreno_*,panfrost_*,asahi_*,powervr_*,dzn_*";
}

std::string noDeviceMessage(const std::string& why) {
  return "no Vulkan device: " + why + " (" + driversSeen() +
         "); software Vulkan comes with Debian's packages libvulkan1 and mesa-vulkan-drivers";
}

std::size_t selectDevice(const std::vector<DeviceInfo>& devices, const std::string& select) {
  const std::string wish = lower(select);
  const bool number = !wish.empty() && wish.find_first_not_of("0123456789") == std::string::npos;
  if (number && wish.size() < 10 && std::stoul(wish) < devices.size()) return std::stoul(wish);

  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const bool cpu = devices[i].type == "cpu", other = devices[i].type == "other";
    const bool meant = wish.empty() || (wish == "cpu" && cpu) || (wish == "gpu" && !cpu && !other);
    if (meant || (wish != "cpu" && wish != "gpu" && lower(devices[i].name).find(wish) != std::string::npos)) {
      candidates.push_back(i);
    }
  }
  if (candidates.empty()) refuse(devices, "no device \"" + select + "\"");
  const bool kind = wish.empty() || wish == "cpu" || wish == "gpu";
  if (!kind && candidates.size() > 1) {
    refuse(devices, "device \"" + select + "\" fits " + std::to_string(candidates.size()) + " devices");
  }
  return *std::min_element(candidates.begin(), candidates.end(),
                           [&](std::size_t a, std::size_t b) { return rank(devices[a]) < rank(devices[b]); });
}

}  // namespace solidcast::gpu
