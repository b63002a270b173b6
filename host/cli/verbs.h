// One verb of the command line = one file: addVerb() declares its options and its callback. Callbacks throw Error;
// main turns that into one line and the exit code.
#pragma once

namespace CLI {
class App;
}

namespace solidcast::cli {

void addRender(CLI::App& app);
void addCompare(CLI::App& app);
void addQuery(CLI::App& app);
void addDevices(CLI::App& app);
void addGenerate(CLI::App& app);
void addStudy(CLI::App& app);
void addBench(CLI::App& app);
void addWatch(CLI::App& app);
void addShader(CLI::App& app);

}  // namespace solidcast::cli
