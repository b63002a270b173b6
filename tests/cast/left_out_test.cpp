// What a scene does not need is not in the code that the driver gets. Every kind's search is marked with a number of its
// own in a copy of the shaders; the specialised module holds the marks of the kinds that are there, and no others.
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "host/cast/program.h"
#include "tests/cast/fixture.h"

namespace solidcast {
namespace {

namespace fs = std::filesystem;

int markOf(int kind) { return 7654321 + kind; }

/// A copy of the shaders' folder, in which X_eye and X_free of every kind begin with its mark.
class MarkedShaders {
 public:
  MarkedShaders() : folder_(fs::temp_directory_path() / ("solidcast marks " + std::to_string(getpid()))) {
    fs::copy(std::string(SOLIDCAST_SOURCE_DIR) + "/shaders", folder_, fs::copy_options::recursive);
    for (int kind = 0; kind < kindCount; ++kind) {
      const fs::path file = folder_ / "solids" / (std::string(kindLabel(kind)) + ".glsl");
      std::stringstream text;
      text << std::ifstream(file).rdbuf();
      const std::regex head("(void [a-z]+_(eye|free)\\([^{]*\\) \\{\n)");
      const std::string mark = "$1  best.s = number(" + std::to_string(markOf(kind)) + ".0);\n";
      const std::string marked = std::regex_replace(text.str(), head, mark);
      EXPECT_NE(marked, text.str()) << file;
      std::ofstream(file) << marked;
    }
  }
  ~MarkedShaders() { fs::remove_all(folder_); }
  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

std::string specialisedText(const MarkedShaders& shaders, const Program& program, const World& world) {
  CastOptions options{.method = program.method, .shaderFolder = shaders.folder().string()};
  Scene scene;
  scene.world = world;
  Records forms, records;
  if (program.eye()) forms = eyeRecords(world, eyeFrame(scene, program.real), program.real);
  if (!program.eye() || program.hits) records = worldRecords(world, {}, program.real);
  gpu::Specialisation constants = recordConstants(program, program.eye() ? forms : records, records);
  if (program.job == Job::pixels) constants[wanted] = program.hits ? 1 + 16 : 1, constants[viewRaws] = 6;
  const auto module = gpu::specialised(programModule(program, options).spirv, {constants.begin(), constants.end()});
  EXPECT_EQ(gpu::validationError(module), "");
  return gpu::disassemble(module);
}

/// Whether some instruction has the mark for an operand; the constant itself may be left lying about.
bool holds(const std::string& text, int kind) {
  const std::regex constant("(%[A-Za-z0-9_]+) = OpConstant %[a-z]+ " + std::to_string(markOf(kind)) + "\n");
  for (std::sregex_iterator it(text.begin(), text.end(), constant), end; it != end; ++it) {
    const std::string id = (*it)[1];
    for (std::size_t at = 0; (at = text.find(" " + id, at)) != std::string::npos; ++at) {
      const char after = text[at + 1 + id.size()];
      const std::size_t line = text.rfind('\n', at) + 1;
      const bool defines = text.find("OpConstant ", at) == at + 1 + id.size() + 3;
      const bool names = text.compare(text.find_first_not_of(' ', line), 6, "OpName") == 0;
      if ((after == ' ' || after == '\n') && !defines && !names) return true;
    }
  }
  return false;
}

const std::vector<Shape>& oneOfEach() {
  static const std::vector<Shape> shapes{InfinitePlane{{0, -1, 0}, {0, 1, 0}},
                                         AABox{{-1, -1, -5}, {1, 1, -4}},
                                         Sphere{{0, 0, -5}, 1},
                                         Disc{{0, 0, -5}, {0, 0.5, 1}, 1},
                                         Triangle{{-1, 0, -5}, {1, 0, -5}, {0, 1, -6}},
                                         Quad{{-1, 0, -5}, {2, 0, 0}, {0, 1, -1}},
                                         Quadric{{1, 2, 3, 0, 0, 0, 0, 0, 20, 30}}};
  return shapes;
}

TEST(LeftOut, CodeOfKindsThatAreNotThere) {
  const MarkedShaders shaders;
  for (const Job job : {Job::pixels, Job::rays}) {
    for (const Method method : {Method::fast, Method::exact}) {
      for (const bool storage : {false, true}) {
        const Program program{.job = job,
                              .method = method,
                              .real = method == Method::exact ? RealType::f64 : RealType::f32,
                              .storage = storage};
        SCOPED_TRACE(program.moduleName());
        const std::string all = specialisedText(shaders, program, worldOf(oneOfEach()));
        for (int kind = 0; kind < kindCount; ++kind) EXPECT_TRUE(holds(all, kind)) << kindLabel(kind);
        for (const Shape& shape : oneOfEach()) {
          const std::string one = specialisedText(shaders, program, worldOf({shape}));
          EXPECT_LT(one.size(), all.size());
          for (int kind = 0; kind < kindCount; ++kind)
            EXPECT_EQ(holds(one, kind), kind == kindNumber(shape))
                << kindLabel(kindNumber(shape)) << " alone, " << kindLabel(kind);
        }
      }
    }
  }
}

TEST(LeftOut, BuffersThatNothingReads) {
  const MarkedShaders shaders;
  const auto binds = [&](const Program& program, int binding) {
    return specialisedText(shaders, program, worldOf({oneOfEach()[2]}))
               .find(" Binding " + std::to_string(binding) + "\n") != std::string::npos;
  };
  const Program plain{.method = Method::fast, .real = RealType::f32};
  Program withNormals = plain;
  withNormals.hits = true;
  EXPECT_TRUE(binds(plain, 0)) << "forms for the eye";
  EXPECT_FALSE(binds(plain, 1)) << "world records";
  EXPECT_FALSE(binds(plain, 4)) << "doubts";
  EXPECT_FALSE(binds(plain, 5)) << "angles";
  EXPECT_FALSE(binds(plain, 7)) << "places";
  EXPECT_TRUE(binds(withNormals, 1));
  EXPECT_TRUE(binds(withNormals, 7));
  EXPECT_TRUE(binds({.method = Method::exact, .real = RealType::f64}, 4));
  EXPECT_TRUE(binds({.method = Method::fast, .real = RealType::f32, .camera = 1}, 5));
}

// The same as stated to people, and as a caster does it.
class LeftOutLines : public OnDevice {};
TEST_F(LeftOutLines, SayWhatIsGone) {
  Scene scene;
  scene.width = scene.height = 8;
  scene.world = worldOf({Sphere{{0, 0, -5}, 1}});
  CastStats stats;
  renderWhole(device(), scene, jobOf(scene, {.rgb8 = true}), {}, &stats);
  std::string all;
  for (const std::string& line : stats.leftOut) all += line + "\n";
  for (int kind = 0; kind < kindCount; ++kind)
    EXPECT_EQ(all.find(std::string(kindLabel(kind)) + ": no code") != std::string::npos,
              kind != kindNumber(scene.world.solids[0].shape))
        << all;
}

}  // namespace
}  // namespace solidcast
