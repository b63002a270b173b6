// Runs the built solidcast as people do: arguments, standard input, and what comes out of it.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace solidcast::cli_test {

struct Result {
  int code = 0;            // exit code; -N when signal N ended it
  std::string out, err;    // standard output and error, whole
  long peakKilobytes = 0;  // largest resident size of the process
};

struct Call {
  std::vector<std::string> arguments;
  std::string input;                        // for standard input
  std::string inputFile;                    // instead of `input`
  std::string outputFile;                   // standard output goes there instead of into `out`
  std::string folder;                       // working folder; "" = this test's
  std::vector<std::string> environment;     // NAME=value, added
  std::size_t closeOutputAfter = SIZE_MAX;  // bytes after which the reader of standard output goes away
};

Result run(const Call& what);

/// The same with arguments only.
Result run(const std::vector<std::string>& arguments, const std::string& input = "");

/// A folder that is there for the life of the object.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  std::string path() const { return path_.string(); }
  /// Names of all that is in it, sorted.
  std::vector<std::string> names() const;

 private:
  std::filesystem::path path_;
};

void writeFile(const std::string& path, const std::string& text);
std::string readFile(const std::string& path);
std::vector<std::string> lines(const std::string& text);

/// Path of a bundled scene.
std::string bundled(const std::string& name);

/// A unit sphere, whose name is `name` with JSON's escapes, at the origin, seen from (0,0,5): 64x48 pixels.
std::string smallScene(const std::string& name = "ball");

/// Expects the exit code and, as the last line of standard error, "solidcast: error: ..." with all of `parts` in it.
/// `alone`: no other line stands there, and standard output is empty.
void expectError(const Result& result, int code, const std::vector<std::string>& parts, bool alone = true);

}  // namespace solidcast::cli_test
