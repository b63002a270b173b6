// `solidcast devices`: what Vulkan devices there are, and how far their arithmetic can be trusted.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "host/carried/probe.h"
#include "host/cli/verbs.h"
#include "host/gpu/device.h"

namespace solidcast::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t longLoop = 1'000'000;  // iterations; known drivers cut at 65,535 or not at all

Json toJson(const gpu::ArithmeticReport& report) {
  return {{"cases", report.cases},
          {"fma", report.fma},
          {"division_max_ulp", report.divisionUlp},
          {"sqrt_max_ulp", report.rootUlp},
          {"sum_max_ulp", report.sumUlp},
          {"product_max_ulp", report.productUlp},
          {"denormal_inputs_kept", report.denormalInputs},
          {"denormal_results_kept", report.denormalResults},
          {"precise_holds", report.precise && report.uncontracted},
          {"two_sum_exact", report.twoSum},
          {"two_product_exact", report.twoProduct}};
}

Json toJson(const gpu::DeviceInfo& info) {
  const gpu::DeviceLimits& limits = info.limits;
  return {{"index", info.index},
          {"name", info.name},
          {"type", info.type},
          {"driver", info.driver},
          {"driver_info", info.driverInfo},
          {"api_version", info.apiVersion},
          {"float64", info.float64},
          {"int64", info.int64},
          {"buffer_addresses", info.bufferAddresses},
          {"limits",
           {{"max_storage_buffer_bytes", limits.maxStorageBufferRange},
            {"max_uniform_buffer_bytes", limits.maxUniformBufferRange},
            {"max_allocation_bytes", limits.maxMemoryAllocationSize},
            {"heap_bytes", limits.heapSize},
            {"max_workgroup_invocations", limits.maxWorkGroupInvocations},
            {"max_workgroup_size", limits.maxWorkGroupSize},
            {"max_workgroups", limits.maxWorkGroupCount},
            {"subgroup_size", limits.subgroupSize},
            {"timestamp_ns", limits.timestampPeriod}}}};
}

std::string bytesText(std::uint64_t bytes) {
  const char* const units[] = {"bytes", "KiB", "MiB", "GiB", "TiB"};
  double value = double(bytes);
  int unit = 0;
  for (; value >= 1024 && unit < 4; ++unit) value /= 1024;
  char text[32];
  std::snprintf(text, sizeof text, "%.4g %s", value, units[unit]);
  return text;
}

std::string ulpText(const char* operation, double ulp) {
  if (ulp == 0) return std::string(operation) + " exact";
  char text[64];
  std::snprintf(text, sizeof text, "%s off by up to %g ulp", operation, ulp);
  return text;
}

void printArithmetic(const char* type, const gpu::ArithmeticReport& report) {
  const char* const denormals = report.denormalInputs && report.denormalResults ? "kept"
                                : report.denormalInputs                         ? "flushed in results"
                                : report.denormalResults                        ? "flushed in operands"
                                                                                : "flushed";
  std::cout << "   " << type << "  " << ulpText("+", report.sumUlp) << ", " << ulpText("*", report.productUlp) << ", "
            << ulpText("/", report.divisionUlp) << ", " << ulpText("sqrt", report.rootUlp) << "; fma " << report.fma
            << "; denormals " << denormals << "; precise "
            << (report.precise && report.uncontracted ? "holds" : "BROKEN") << "; TwoSum "
            << (report.twoSum ? "exact" : "BROKEN") << ", TwoProd " << (report.twoProduct ? "exact" : "BROKEN") << "\n";
}

void print(const gpu::DeviceInfo& info) {
  const gpu::DeviceLimits& limits = info.limits;
  std::cout << info.index << "  " << info.name << "\n"
            << "   " << info.type << ", " << info.driver << (info.driverInfo.empty() ? "" : ", ") << info.driverInfo
            << ", Vulkan " << info.apiVersion << "\n"
            << "   storage buffer " << bytesText(limits.maxStorageBufferRange) << ", uniform buffer "
            << bytesText(limits.maxUniformBufferRange) << ", allocation " << bytesText(limits.maxMemoryAllocationSize)
            << ", memory " << bytesText(limits.heapSize) << "\n"
            << "   workgroup " << limits.maxWorkGroupInvocations << " invocations, " << limits.maxWorkGroupCount[0]
            << " x " << limits.maxWorkGroupCount[1] << " x " << limits.maxWorkGroupCount[2] << " workgroups, subgroup "
            << limits.subgroupSize << ", timestamps "
            << (limits.timestampPeriod > 0 ? std::to_string(limits.timestampPeriod) + " ns" : "none") << "\n"
            << "   float64 " << (info.float64 ? "yes" : "no") << ", int64 " << (info.int64 ? "yes" : "no")
            << ", buffer addresses " << (info.bufferAddresses ? "yes" : "no") << "\n";
}

void listAll(bool asJson) {
  Json list = Json::array();
  for (const gpu::DeviceInfo& info : gpu::listDevices()) {
    gpu::Device device({.select = std::to_string(info.index)});
    const gpu::ArithmeticReport single = gpu::probeArithmetic(device, false);
    gpu::ArithmeticReport twice;
    if (info.float64) twice = gpu::probeArithmetic(device, true);
    const std::uint32_t iterations = gpu::loopIterations(device, longLoop);
    if (asJson) {
      Json entry = toJson(info);
      entry["arithmetic"]["float32"] = toJson(single);
      if (info.float64) entry["arithmetic"]["float64"] = toJson(twice);
      entry["loop_cut_at"] = iterations < longLoop ? Json(iterations) : Json(nullptr);
      list.push_back(std::move(entry));
    } else {
      print(info);
      printArithmetic("fp32", single);
      if (info.float64) printArithmetic("fp64", twice);
      if (iterations < longLoop) std::cout << "   loops are cut off in silence after " << iterations << " iterations\n";
    }
  }
  if (asJson) std::cout << list.dump(2) << "\n";
}

}  // namespace

void addDevices(CLI::App& app) {
  CLI::App* verb = app.add_subcommand("devices", "List Vulkan devices, their limits and a probe of their arithmetic");
  verb->footer(
      "The probe runs every operation on 65,536 operands of all sizes and compares with the CPU, bit by bit.\n"
      "Exits with 3 when there is no device, and says what was looked for.\n\n"
      "Examples:\n"
      "  solidcast devices\n"
      "  solidcast devices --json | jq '.[].name'");
  auto asJson = std::make_shared<bool>(false);
  verb->add_flag("--json", *asJson, "One JSON array on standard output instead of text");
  verb->callback([asJson] { listAll(*asJson); });
}

}  // namespace solidcast::cli
