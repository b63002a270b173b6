#include "host/cast/program.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "host/carried/carried.h"
#include "host/error.h"

namespace solidcast {
namespace {

const char* methodLabel(const Program& p) {
  if (p.method == Method::naive) return "naive";
  if (p.method == Method::fast) return "fast";
  return p.real == RealType::f64 ? "exact64" : p.real == RealType::df32 ? "exactdf" : "exact32";
}

}  // namespace

std::string Program::moduleName() const {
  static const char* cameras[] = {"perspective", "environment", "orthographic"};
  std::string name = job == Job::pixels ? "pixels_" : job == Job::rays ? "rays_" : "lists_";
  name += methodLabel(*this);
  if (job != Job::rays) name += std::string("_") + cameras[camera];
  if (storage) name += index ? "_index" : "_storage";
  if (turn > 0) name += "_turn" + std::to_string(turn);
  else if (address) name += "_address";
  if (job == Job::pixels && hits) name += "_hits";
  return name;
}

gpu::Defines Program::defines() const {
  gpu::Defines d = {{"METHOD", std::to_string(static_cast<int>(method))},
                    {"ARITHMETIC", std::to_string(static_cast<int>(real))}};
  if (job == Job::lists) d.emplace_back("STORAGE", storage ? "3" : "2");
  else d.emplace_back("STORAGE", storage ? "1" : "0"), d.emplace_back("INDEX", index ? "1" : "0");
  if (job != Job::rays) d.emplace_back("CAMERA", std::to_string(camera));
  if (job == Job::pixels) {
    d.emplace_back("HITS", hits ? "1" : "0");
    d.emplace_back("ADDRESS", address ? "1" : "0");
    d.emplace_back("TURN", std::to_string(turn));
  }
  return d;
}

int cameraNumber(const Camera& camera) {
  return std::holds_alternative<PerspectiveCamera>(camera)   ? 0
         : std::holds_alternative<EnvironmentCamera>(camera) ? 1
                                                             : 2;
}

std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

gpu::Specialisation recordConstants(const Program& program, const Records& search, const Records& world) {
  gpu::Specialisation s;
  for (std::uint32_t kind = 0; kind < kindCount; ++kind) {
    s[kind] = program.storage ? std::min(search.count[kind], 1u) : search.count[kind];
    s[kindInWorld + kind] = world.count[kind] > 0;
  }
  auto atLeastOne = [](std::size_t n) { return static_cast<std::uint32_t>(std::max<std::size_t>(n, 1)); };
  s[recordRaws] = atLeastOne(search.raws);
  s[worldRaws] = atLeastOne(world.raws);
  s[boxFacePlane] = search.boxOnFace;
  s[someGraze] = search.grazing;
  s[someTie] = search.ties;
  s[someFarSphere] = search.farSphere;
  return s;
}

RealType chooseReal(const gpu::DeviceInfo& device, const CastOptions& options, Job job, int camera, std::string& why) {
  if (options.method != Method::exact) {
    why = options.method == Method::naive ? "method naive: textbook formulas in fp32"
                                          : "method fast: eye-relative inverse distances in fp32";
    return RealType::f32;
  }
  if (options.arithmetic == Arithmetic::fp64 && !device.float64)
    throw Error(Exit::noDevice, "--arithmetic fp64: device \"" + device.name +
                                    "\" has no 64-bit floats in shaders; expected auto or df32");
  bool fp64 = device.float64 && options.arithmetic != Arithmetic::df32;
  std::string reason = options.arithmetic != Arithmetic::automatic ? "as asked"
                       : fp64                                      ? "the device has it"
                                                                   : "the device has no fp64";
  if (fp64) {
    why = "method exact in fp64 (" + reason + "), doubtful rays again in binary128 on the host";
    return RealType::f64;
  }
  if (job == Job::pixels && camera != 2) {
    why = "method exact in double-float fp32 (" + reason + "), doubtful rays again in binary128 on the host";
    return RealType::df32;
  }
  why = "method exact by fp32 decisions (" + reason + "), hits and doubtful rays in binary128 on the host";
  return RealType::f32;
}

float doubtOf(const Program& program) {
  if (program.eye()) return static_cast<float>(32 * unitRoundoff(program.real));
  return program.method == Method::exact && program.real == RealType::f32 ? 0x1p-9f : 0x1p-20f;
}

gpu::CompiledModule programModule(const Program& program, const CastOptions& options) {
  if (options.shaderFolder.empty()) {
    auto words = gpu::carriedModule(program.moduleName());
    return {{words.begin(), words.end()}, {}};
  }
  std::filesystem::path folder = options.shaderFolder;
  return gpu::compile(folder / (program.job == Job::pixels ? "pixels.comp"
                                : program.job == Job::rays ? "rays.comp"
                                                           : "lists.comp"),
                      program.defines(), {folder});
}

gpu::CompiledModule stageModule(const std::string& name, int camera, const CastOptions& options) {
  if (options.shaderFolder.empty()) {
    auto words = gpu::carriedModule(name);
    return {{words.begin(), words.end()}, {}};
  }
  const std::filesystem::path folder = options.shaderFolder;
  const std::string file = name.substr(0, name.find('_')) + ".comp";
  return gpu::compile(folder / "custom" / file, {{"CAMERA", std::to_string(camera)}}, {folder});
}

std::vector<std::string> leftOutLines(const Program& program, const World& world, const Channels& channels) {
  std::vector<std::string> lines;
  const auto there = solidsOfKinds(world);
  for (int kind = 0; kind < kindCount; ++kind)
    if (!there[static_cast<std::size_t>(kind)])
      lines.push_back(std::string(kindLabel(kind)) + ": no code, no records (the scene has none)");
  if (program.job != Job::rays) {
    if (!channels.normal && !channels.local && !channels.position)
      lines.push_back("normals, local coordinates, hit points: no code, no buffers (not asked for)");
    if (!channels.radiance && !channels.rgb8) lines.push_back("integrators: no code (no radiance asked for)");
    if (!channels.radiance) lines.push_back("float radiance: no buffer (not asked for)");
    if (!channels.distance && !channels.solid) lines.push_back("distance, solid: no buffers (not asked for)");
    if (program.camera != 1) lines.push_back("table of angles: no buffer (only an environment camera needs it)");
  }
  if (program.eye()) lines.push_back("world records: none (the forms for this eye are all it needs)");
  if (program.method != Method::exact) lines.push_back("second pass: none (only exact has one)");
  if (!program.storage && program.job != Job::lists)
    lines.push_back("search in portions: none (all records fit a uniform buffer)");
  return lines;
}

std::vector<SearchPortion> portions(const Records& records, std::uint32_t limit) {
  std::vector<SearchPortion> all;
  SearchPortion now;
  std::uint32_t room = limit;
  for (std::size_t kind = 0; kind < kindCount; ++kind) {
    std::uint32_t done = 0;
    now.firstRow[kind] = records.firstRow[kind];
    while (done < records.count[kind]) {
      std::uint32_t take = std::min(room, records.count[kind] - done);
      now.count[kind] = take;
      now.firstRow[kind] = records.firstRow[kind] + done * records.rowsPer[kind];
      done += take, room -= take;
      if (room == 0) {
        all.push_back(now);
        now = {};
        room = limit;
      }
    }
  }
  if (all.empty() || room < limit) all.push_back(now);
  return all;
}

gpu::Buffer filledBuffer(gpu::Device& device, std::span<const std::byte> bytes, gpu::BufferUse use) {
  gpu::Buffer buffer = device.makeBuffer(std::max<std::size_t>(bytes.size(), 16), use);
  std::copy(bytes.begin(), bytes.end(), buffer.bytes().begin());
  return buffer;
}

}  // namespace solidcast
