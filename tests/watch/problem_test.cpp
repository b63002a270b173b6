// Messages taken apart, and the lines that they mean.
#include "host/watch/problem.h"

#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace solidcast::watch {
namespace {

using cli_test::Folder;
using cli_test::writeFile;

constexpr char kScene[] = R"({
  // a comment, with "solids": [ in it
  "image": {"width": 3, "a}b": [1, 2]}, /* { */
  "solids": [
    {"type": "sphere"},
    {"type": "disc",
     "rad/ius": [1,
       2]}
  ]
})";

TEST(LineOf, FindsValues) {
  EXPECT_EQ(lineOf(kScene, ""), 1);
  EXPECT_EQ(lineOf(kScene, "/image"), 3);
  EXPECT_EQ(lineOf(kScene, "/image/a}b/1"), 3);
  EXPECT_EQ(lineOf(kScene, "/solids/0/type"), 5);
  EXPECT_EQ(lineOf(kScene, "/solids/1"), 6);
  EXPECT_EQ(lineOf(kScene, "/solids/1/rad~1ius/1"), 8);
}

TEST(LineOf, FindsNothingInWhatIsNotThere) {
  for (const char* pointer : {"/camera", "/solids/2", "/solids/0/type/x", "/image/width/0", "/", "/solids/-1"})
    EXPECT_EQ(lineOf(kScene, pointer), std::nullopt) << pointer;
  for (const char* text : {"", "{", "{\"a", "{\"a\":", "[1,", "// x", "/*", "{\"a\" 1}"})
    EXPECT_EQ(lineOf(text, "/a/0"), std::nullopt) << text;
}

TEST(Problem, OfAShader) {
  Folder folder;
  const std::string file = folder / "a:7: b.glsl";
  writeFile(file, "one\ntwo\r\nthree");
  const auto all = problemsOf(file + ":2: error: 'x': undeclared\n" + file + ":3: error: y\n" + file + ":3: error: y");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0], (Problem{file, 2, 0, "'x': undeclared", "two"}));
  EXPECT_EQ(all[1].line, 3);
  EXPECT_EQ(asText(all[0]), file + ":2: error: 'x': undeclared\n  2 | two\n");
}

TEST(Problem, OfASceneByPlaceAndByPointer) {
  Folder folder;
  const std::string file = folder / "s.json";
  writeFile(file, kScene);
  EXPECT_EQ(asText(problemsOf(file + ":5:6: bad").at(0)),
            file + ":5:6: error: bad\n  5 |     {\"type\": \"sphere\"},\n    |      ^\n");
  const Problem problem = problemsOf(file + ": /solids/1/rad~1ius: too: long").at(0);
  EXPECT_EQ(problem, (Problem{file, 7, 0, "/solids/1/rad~1ius: too: long", "     \"rad/ius\": [1,"}));
}

TEST(Problem, WithoutAPlace) {
  EXPECT_EQ(asText(problemsOf("out of luck: 3").at(0)), "error: out of luck: 3\n");
  Folder folder;
  writeFile(folder / "s.json", "");
  EXPECT_EQ(asText(problemsOf((folder / "s.json") + ": empty").at(0)), (folder / "s.json") + ": error: empty\n");
}

TEST(Problem, LongLinesAreCut) {
  Folder folder;
  std::string line;
  for (int i = 0; i < 500; ++i) line += "\u00e9";
  writeFile(folder / "x", line);
  const std::string source = problemsOf((folder / "x") + ":1: error: y").at(0).source;
  EXPECT_EQ(source.size(), 200u);
  EXPECT_EQ(line.find(source), 0u);
}

}  // namespace
}  // namespace solidcast::watch
