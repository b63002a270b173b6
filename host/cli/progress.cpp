#include "host/cli/progress.h"

#include <unistd.h>

#include <algorithm>
#include <string>

namespace solidcast::cli {
namespace {

constexpr int kBarWidth = 40;
constexpr char kWipe[] = "\r\033[K";

void toTerminal(const std::string& text) {
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

Progress::Progress() : terminal_(isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()), last_(start_) {}

Progress::~Progress() {
  if (drawn_) toTerminal(kWipe);
}

void Progress::show(double fraction, const std::string& what) {
  using namespace std::chrono_literals;
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - start_ < 500ms || now - last_ < 100ms) return;
  last_ = now;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int full = static_cast<int>(fraction * kBarWidth);
  std::string text = std::string(kWipe) + "[" + std::string(full, '#') + std::string(kBarWidth - full, ' ') + "] " +
                     std::to_string(static_cast<int>(fraction * 100)) + " %";
  if (fraction > 0.01) {
    const double passed = std::chrono::duration<double>(now - start_).count();
    text += ", " + std::to_string(static_cast<long>(passed / fraction * (1 - fraction) + 0.5)) + " s left";
  }
  if (!what.empty()) text += ": " + what;
  toTerminal(text);
  drawn_ = true;
}

}  // namespace solidcast::cli
