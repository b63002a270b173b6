// Headless Chromium, driven through WebDriver (W3C) by its chromedriver (Debian package chromium-driver).
#pragma once
#include <sys/types.h>

#include <chrono>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace solidcast::watch_test {

class Browser {
 public:
  Browser();
  ~Browser();
  Browser(const Browser&) = delete;

  void open(const std::string& url);
  /// The value of a JavaScript expression, as JSON text.
  std::string value(const std::string& expression);
  /// Waits until an expression is true.
  bool becomes(const std::string& expression, std::chrono::milliseconds most = std::chrono::seconds(20));
  /// A click, or a drag by (dx, dy), that begins in the middle of what a CSS selector finds.
  void pointer(const std::string& selector, int dx = 0, int dy = 0);
  void key(const std::string& key);
  /// PNG of what is seen.
  void screenshot(const std::string& file);

 private:
  struct Driver;
  nlohmann::json ask(const std::string& path, const nlohmann::json& what);
  std::unique_ptr<Driver> driver_;
};

}  // namespace solidcast::watch_test
