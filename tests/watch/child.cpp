#include "tests/watch/child.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <thread>

namespace solidcast::watch_test {

Child::Child(const std::vector<std::string>& arguments, const std::string& folder) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
  std::vector<std::string> words{SOLIDCAST_BINARY_DIR "/solidcast"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  process_ = ::fork();
  if (process_ == 0) {
    if (::chdir(folder.c_str()) != 0) ::_exit(126);
    ::dup2(ends[1], STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ::close(ends[1]);
  errors_ = ends[0];
}

Child::~Child() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ::close(errors_);
}

bool Child::readMore(std::chrono::steady_clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - std::chrono::steady_clock::now()).count();
  pollfd source{errors_, POLLIN, 0};
  if (left <= 0 || ::poll(&source, 1, static_cast<int>(left)) <= 0) return false;
  char block[4096];
  const ssize_t got = ::read(errors_, block, sizeof block);
  if (got > 0) said_.append(block, static_cast<std::size_t>(got));
  return got > 0;
}

std::string Child::waitFor(const std::string& part, std::chrono::milliseconds most) {
  const auto until = std::chrono::steady_clock::now() + most;
  for (;;) {
    for (std::size_t end; (end = said_.find('\n', looked_)) != std::string::npos;) {
      const std::string line = said_.substr(looked_, end - looked_);
      looked_ = end + 1;
      if (line.find(part) != std::string::npos) return line;
    }
    if (!readMore(until)) return "";
  }
}

void Child::signal(int number) const { ::kill(process_, number); }

int Child::end(std::chrono::milliseconds most) {
  const auto until = std::chrono::steady_clock::now() + most;
  while (readMore(until)) {}
  for (int status = 0; std::chrono::steady_clock::now() < until;
       std::this_thread::sleep_for(std::chrono::milliseconds(5)))
    if (::waitpid(process_, &status, WNOHANG) == process_) {
      process_ = -1;
      return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }
  return -1000;
}

long Child::kilobytes() const {
  std::ifstream status("/proc/" + std::to_string(process_) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
  return 0;
}

}  // namespace solidcast::watch_test
