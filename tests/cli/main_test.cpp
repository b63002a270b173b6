// Help, version, verbs and what main makes of errors.
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace solidcast::cli_test {
namespace {

const std::vector<std::string> kVerbs{"render", "compare", "query", "devices", "generate", "bench", "watch", "shader"};

TEST(Main, HelpNamesEveryVerbAndTheExitCodes) {
  const Result help = run({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_EQ(help.err, "");
  for (const std::string& verb : kVerbs) EXPECT_NE(help.out.find("\n  " + verb + " "), std::string::npos) << verb;
  EXPECT_NE(help.out.find("Exit codes: 0 fine; 1 images differ"), std::string::npos);
}

TEST(Main, HelpOfEveryVerbHasExamples) {
  for (const std::string& verb : kVerbs) {
    const Result help = run({verb, "--help"});
    EXPECT_EQ(help.code, 0) << verb;
    EXPECT_EQ(help.err, "") << verb;
    EXPECT_NE(help.out.find("Usage: solidcast " + verb), std::string::npos) << help.out;
    EXPECT_NE(help.out.find("solidcast " + verb, help.out.find("Example")), std::string::npos) << help.out;
    EXPECT_EQ(run({verb, "-h"}).out, help.out) << verb;
  }
}

TEST(Main, EveryRenderOptionOfTheDocumentationIsInItsHelp) {
  const Result help = run({"render", "--help"});
  for (const char* option :
       {"SCENE", "-o,--output", "--integrator casting|castingdist", "--size", "--backend gpu|cpu",
        "--precision f32|f64|f128", "--device", "--samples", "--two-sided", "--aov", "--crop",
        "--validation auto|on|off", "--stats", "--json", "--method naive|fast|exact", "--arithmetic auto|fp64|df32"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
}

TEST(Main, Version) {
  const Result version = run({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind("solidcast ", 0), 0u);
  EXPECT_EQ(lines(version.out).size(), 1u);
  EXPECT_EQ(version.err, "");
}

TEST(Main, NoVerbNamesThem) { expectError(run(std::vector<std::string>{}), 2, {"no verb", "render", "query"}); }

TEST(Main, MistypedVerbGetsTheNearest) { expectError(run({"rendr"}), 2, {"\"rendr\"", "did you mean render"}); }

TEST(Main, FarVerbGetsTheList) {
  const Result result = run({"xyzzy"});
  expectError(result, 2, {"\"xyzzy\"", "expected one of", "compare"});
  EXPECT_EQ(result.err.find("did you mean"), std::string::npos);
}

TEST(Main, MistypedOptionGetsTheNearest) {
  expectError(run({"render", "s.json", "--sise", "3x4"}), 2, {"--sise", "did you mean --size"});
  expectError(run({"query", "s.json", "--ray=x"}), 2, {"--ray", "did you mean --rays"});
}

TEST(Main, MissingArgument) {
  expectError(run({"render"}), 2, {"SCENE", "render --help"});
  expectError(run({"query", "scene.json"}), 2, {"--rays", "query --help"});
  expectError(run({"render", "s.json", "-o"}), 2, {"--output"});
}

TEST(Main, TooManyArguments) { expectError(run({"render", "a.json", "b.json"}), 2, {"b.json"}); }

TEST(Main, LostStandardOutputIsAnError) {
  Call what;
  what.arguments = {"--help"};
  what.outputFile = "/dev/full";
  expectError(run(what), 5, {"standard output"});
}

TEST(Main, UnknownWordsForChoices) {
  const std::string scene = bundled("a_solids");
  for (const char* option : {"--method", "--arithmetic", "--precision", "--validation", "--backend", "--integrator"})
    expectError(run({"render", scene, option, "tea"}), 2, {option, "\"tea\"", "expected", "|"});
}

}  // namespace
}  // namespace solidcast::cli_test
