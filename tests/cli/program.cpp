#include "tests/cli/program.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace solidcast::cli_test {
namespace {

struct Pipe {
  int reading = -1, writing = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    reading = ends[0];
    writing = ends[1];
  }
};

void closeEnd(int& end) {
  if (end >= 0) ::close(end);
  end = -1;
}

[[noreturn]] void child(const Call& what, int input, int output, int error) {
  std::vector<std::string> words{SOLIDCAST_BINARY_DIR "/solidcast"};
  words.insert(words.end(), what.arguments.begin(), what.arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  for (const std::string& setting : what.environment) ::putenv(const_cast<char*>(setting.c_str()));
  if (!what.folder.empty() && ::chdir(what.folder.c_str()) != 0) ::_exit(126);
  if (!what.inputFile.empty()) input = ::open(what.inputFile.c_str(), O_RDONLY);
  if (!what.outputFile.empty()) output = ::open(what.outputFile.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  ::dup2(input, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(error, STDERR_FILENO);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

/// Reads what there is; false at the end.
bool drain(int from, std::string& into) {
  char block[65536];
  const ssize_t got = ::read(from, block, sizeof block);
  if (got > 0) into.append(block, got);
  return got > 0;
}

}  // namespace

Result run(const Call& what) {
  ::signal(SIGPIPE, SIG_IGN);  // a program that ends early must not end the test
  Pipe input, output, error;
  const pid_t process = ::fork();
  if (process == 0) {
    ::signal(SIGPIPE, SIG_DFL);
    child(what, input.reading, output.writing, error.writing);
  }
  closeEnd(input.reading);
  closeEnd(output.writing);
  closeEnd(error.writing);
  ::fcntl(input.writing, F_SETFL, O_NONBLOCK);

  Result result;
  std::size_t sent = 0;
  if (what.input.empty()) closeEnd(input.writing);
  while (output.reading >= 0 || error.reading >= 0) {
    pollfd watched[] = {{output.reading, POLLIN, 0}, {error.reading, POLLIN, 0}, {input.writing, POLLOUT, 0}};
    ::poll(watched, 3, -1);
    if (watched[0].revents != 0 && !drain(output.reading, result.out)) closeEnd(output.reading);
    if (result.out.size() > what.closeOutputAfter) closeEnd(output.reading);
    if (watched[1].revents != 0 && !drain(error.reading, result.err)) closeEnd(error.reading);
    if (watched[2].revents != 0) {
      const ssize_t written = ::write(input.writing, what.input.data() + sent, what.input.size() - sent);
      if (written > 0) sent += written;
      if (sent == what.input.size() || (written < 0 && errno != EAGAIN)) closeEnd(input.writing);
    }
  }
  closeEnd(input.writing);
  int status = 0;
  rusage usage{};
  ::wait4(process, &status, 0, &usage);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  result.peakKilobytes = usage.ru_maxrss;
  return result;
}

Result run(const std::vector<std::string>& arguments, const std::string& input) {
  Call what;
  what.arguments = arguments;
  what.input = input;
  return run(what);
}

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "solidcast test XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp");
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> list;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) list.push_back(entry.path().filename().string());
  std::sort(list.begin(), list.end());
  return list;
}

void writeFile(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

std::string readFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> list;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) list.push_back(line);
  return list;
}

std::string bundled(const std::string& name) { return SOLIDCAST_SOURCE_DIR "/scenes/" + name + ".json"; }

std::string smallScene(const std::string& name) {
  return R"({"image": {"width": 64, "height": 48},
 "camera": {"type": "perspective", "center": [0, 0, 5], "forward": [0, 0, -1], "up": [0, 1, 0],
            "vertical_angle": 30, "horizontal_angle": 40},
 "solids": [{"type": "sphere", "name": ")" +
         name + R"(", "center": [0, 0, 0], "radius": 1}]})";
}

void expectError(const Result& result, int code, const std::vector<std::string>& parts, bool alone) {
  EXPECT_EQ(result.code, code) << result.err;
  const std::vector<std::string> said = lines(result.err);
  ASSERT_FALSE(said.empty());
  EXPECT_EQ(said.back().rfind("solidcast: error: ", 0), 0u) << result.err;
  for (const std::string& part : parts)
    EXPECT_NE(said.back().find(part), std::string::npos) << part << " in " << result.err;
  if (!alone) return;
  EXPECT_EQ(said.size(), 1u) << result.err;
  EXPECT_EQ(result.out, "");
}

}  // namespace solidcast::cli_test
