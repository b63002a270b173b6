#include "tests/watch/browser.h"

#include <fcntl.h>
#include <httplib.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "tests/cli/program.h"

namespace solidcast::watch_test {

using Json = nlohmann::json;

struct Browser::Driver {
  pid_t process = -1;
  cli_test::Folder folder;  // the browser's profile
  std::unique_ptr<httplib::Client> http;
  std::string session;

  Driver() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    process = ::fork();
    if (process == 0) {
      ::setpgid(0, 0);
      ::dup2(ends[1], STDOUT_FILENO);
      ::execlp("chromedriver", "chromedriver", "--port=0", nullptr);
      ::_exit(127);
    }
    ::close(ends[1]);
    // It says "... was started successfully on port 12345." and nothing that matters after that.
    std::string said;
    char block[512];
    const std::string before = "successfully on port ";
    for (ssize_t got; said.find(before) == std::string::npos || said.back() != '\n';) {
      if ((got = ::read(ends[0], block, sizeof block)) <= 0)
        throw std::runtime_error("chromedriver (Debian package chromium-driver) did not start: " + said);
      said.append(block, static_cast<std::size_t>(got));
    }
    ::close(ends[0]);
    http = std::make_unique<httplib::Client>("127.0.0.1", std::stoi(said.substr(said.find(before) + before.size())));
    http->set_read_timeout(60, 0);
  }
  ~Driver() {
    if (!session.empty()) http->Delete("/session/" + session);
    ::kill(-process, SIGTERM);
    ::waitpid(process, nullptr, 0);
  }
};

Browser::Browser() : driver_(std::make_unique<Driver>()) {
  const Json options{{"args",
                      {"--headless=new", "--no-sandbox", "--disable-gpu", "--window-size=1400,1000",
                       "--hide-scrollbars", "--user-data-dir=" + driver_->folder.path()}}};
  const Json wanted{{"capabilities", {{"alwaysMatch", {{"goog:chromeOptions", options}}}}}};
  driver_->session = ask("/session", wanted).at("sessionId");
}
Browser::~Browser() = default;

Json Browser::ask(const std::string& path, const Json& what) {
  const std::string whole = driver_->session.empty() ? path : "/session/" + driver_->session + path;
  const auto answer =
      what.is_null() ? driver_->http->Get(whole) : driver_->http->Post(whole, what.dump(), "application/json");
  if (!answer || answer->status != 200)
    throw std::runtime_error("browser: " + path + ": " + (answer ? answer->body : "no answer"));
  return Json::parse(answer->body).at("value");
}

void Browser::open(const std::string& url) { ask("/url", {{"url", url}}); }

std::string Browser::value(const std::string& expression) {
  return ask("/execute/sync", {{"script", "return " + expression}, {"args", Json::array()}}).dump();
}

bool Browser::becomes(const std::string& expression, std::chrono::milliseconds most) {
  const auto until = std::chrono::steady_clock::now() + most;
  for (;; std::this_thread::sleep_for(std::chrono::milliseconds(20))) {
    if (value("!!(" + expression + ")") == "true") return true;
    if (std::chrono::steady_clock::now() > until) return false;
  }
}

void Browser::pointer(const std::string& selector, int dx, int dy) {
  const Json found = ask("/element", {{"using", "css selector"}, {"value", selector}});
  const auto to = [&found](int x, int y) {
    return Json{{"type", "pointerMove"}, {"duration", 30}, {"origin", found}, {"x", x}, {"y", y}};
  };
  Json steps{to(0, 0), {{"type", "pointerDown"}, {"button", 0}}};
  if (dx != 0 || dy != 0) {
    steps.push_back(to(dx / 2, dy / 2));
    steps.push_back(to(dx, dy));
  }
  steps.push_back({{"type", "pointerUp"}, {"button", 0}});
  ask("/actions", {{"actions", {{{"type", "pointer"}, {"id", "mouse"}, {"actions", steps}}}}});
}

void Browser::key(const std::string& key) {
  const Json steps{{{"type", "keyDown"}, {"value", key}}, {{"type", "keyUp"}, {"value", key}}};
  ask("/actions", {{"actions", {{{"type", "key"}, {"id", "keys"}, {"actions", steps}}}}});
}

void Browser::screenshot(const std::string& file) {
  const std::string text = ask("/screenshot", nullptr);
  static const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0, count = 0;
  for (const char letter : text) {
    const std::size_t value = letters.find(letter);
    if (value == std::string::npos) break;
    bits = bits << 6 | static_cast<unsigned>(value);
    if ((count += 6) >= 8) bytes += static_cast<char>(bits >> (count -= 8));
  }
  cli_test::writeFile(file, bytes);
}

}  // namespace solidcast::watch_test
