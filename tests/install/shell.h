// Commands as a user types them, in a folder that is gone afterwards.
#pragma once
#include <filesystem>
#include <string>

namespace solidcast::install_test {

struct Result {
  int code = 0;
  std::string output;  // standard output and error together
};

/// Runs a line of sh.
Result shell(const std::string& line);

/// In single quotes, as sh wants it.
std::string quoted(const std::filesystem::path& path);

/// A new folder, removed at the end. Its name has a space in it, which every build should bear.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

std::string readFile(const std::filesystem::path& path);
void writeFile(const std::filesystem::path& path, const std::string& text);

}  // namespace solidcast::install_test
