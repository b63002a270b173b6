// Every file that `cmake --install` gives is in its place, by component, with DESTDIR, and names no place of the build.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/install/shell.h"

namespace solidcast::install_test {
namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

const Names program{"bin/solidcast", INSTALL_LIBRARIES "/solidcast/solidcast_http.so", "share/man/man1/solidcast.1",
                    "share/bash-completion/completions/solidcast"};

Names development() {
  Names names;
  for (const char* header : {"error", "gpu/device", "gpu/shaders", "glsl_test/compare", "glsl_test/device",
                             "glsl_test/function", "glsl_test/signature", "glsl_test/types"}) {
    names.insert("include/solidcast/" + std::string(header) + ".h");
  }
  const std::string libraries = INSTALL_LIBRARIES, package = libraries + "/cmake/solidcast/";
  names.insert({libraries + "/libsolidcast_glsl_test.a", libraries + "/libsolidcast_gpu.a"});
  names.insert({package + "solidcastConfig.cmake", package + "solidcastConfigVersion.cmake",
                package + "solidcastTargets.cmake", package + "solidcastTargets-TYPE.cmake",
                package + "solidcast_glsl_test.cmake"});
  const std::string glsl = "share/solidcast/glsl/solidcast/";
  names.insert({glsl + "numeric.glsl", glsl + "hit.glsl"});
  for (const auto& file : fs::directory_iterator(fs::path(SOLIDCAST_SOURCE_DIR) / "shaders/solids")) {
    names.insert(glsl + "solids/" + file.path().filename().string());
  }
  return names;
}

/// Files below the folder; the build type that CMake puts into one name is replaced by TYPE.
Names filesIn(const fs::path& folder) {
  Names names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    std::string name = entry.path().lexically_relative(folder).string();
    const std::string variant = "/solidcastTargets-";
    if (const std::size_t at = name.find(variant); at != std::string::npos) {
      name = name.substr(0, at) + variant + "TYPE.cmake";
    }
    names.insert(name);
  }
  return names;
}

void install(const std::string& arguments, const std::string& environment = "") {
  const Result result =
      shell(environment + " " CMAKE_PROGRAM " --install " + quoted(SOLIDCAST_BINARY_DIR) + " " + arguments);
  ASSERT_EQ(result.code, 0) << result.output;
}

TEST(LayoutTest, HasEveryFileInItsPlaceAndNoOther) {
  const Folder folder;
  install("--prefix " + quoted(folder / "all"));
  Names all = development();
  all.insert(program.begin(), program.end());
  EXPECT_EQ(filesIn(folder / "all"), all);
}

TEST(LayoutTest, TheProgramCanBeHadAlone) {
  const Folder folder;
  install("--component program --prefix " + quoted(folder / "program"));
  EXPECT_EQ(filesIn(folder / "program"), program);
  const Result help = shell(quoted(folder / "program/bin/solidcast") + " --help");
  EXPECT_EQ(help.code, 0) << help.output;
  EXPECT_NE(help.output.find("render"), std::string::npos) << help.output;
  install("--component development --prefix " + quoted(folder / "development"));
  EXPECT_EQ(filesIn(folder / "development"), development());
}

TEST(LayoutTest, DestdirIsPutBeforeThePrefixAndNamedNowhere) {
  const Folder folder;
  install("--prefix /opt/solidcast", "DESTDIR=" + quoted(folder / "stage"));
  const fs::path prefix = folder / "stage/opt/solidcast";
  Names all = development();
  all.insert(program.begin(), program.end());
  EXPECT_EQ(filesIn(prefix), all);
  for (const std::string& name : filesIn(prefix)) {
    if (name.find("TYPE") != std::string::npos || name == "bin/solidcast") continue;
    const std::string text = readFile(prefix / name);
    for (const std::string& place : {(folder / "stage").string(), std::string(SOLIDCAST_SOURCE_DIR)}) {
      EXPECT_EQ(text.find(place), std::string::npos) << name << " names " << place;
    }
  }
}

TEST(LayoutTest, AnyCompilerCanIncludeTheSolids) {
  const Folder folder;
  install("--component development --prefix " + quoted(folder / "prefix"));
  std::size_t solids = 0;
  for (const auto& file : fs::directory_iterator(folder / "prefix/share/solidcast/glsl/solidcast/solids")) {
    const std::string kind = file.path().stem().string();
    writeFile(folder / "mine.comp",
              "#version 460\n#extension GL_GOOGLE_include_directive : require\n"
              "#include \"solidcast/solids/" +
                  kind +
                  ".glsl\"\n"
                  "layout(binding = 0) buffer Rows { vec4 rows[]; };\n"
                  "real4 record(uint row) { return rows[row]; }\n"
                  "real4 worldRecord(uint row) { return rows[row]; }\n"
                  "void main() {\n"
                  "  Nearest best = Nearest(1e30, 0.0, -1.0);\n  " +
                  kind +
                  "_naive(0u, rows[8].xyz, rows[9].xyz, best);\n"
                  "  rows[10].x = best.t;\n}\n");
    const Result result = shell(GLSLANG_PROGRAM " -V -I" + quoted(folder / "prefix/share/solidcast/glsl") + " -o " +
                                quoted(folder / "mine.spv") + " " + quoted(folder / "mine.comp"));
    EXPECT_EQ(result.code, 0) << kind << "\n" << result.output;
    ++solids;
  }
  EXPECT_EQ(solids, 7u);
}

}  // namespace
}  // namespace solidcast::install_test
