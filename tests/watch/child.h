// A solidcast that goes on running while the test saves files, and what it says on standard error.
#pragma once
#include <sys/types.h>

#include <chrono>
#include <string>
#include <vector>

namespace solidcast::watch_test {

class Child {
 public:
  /// Starts the built program in `folder`.
  Child(const std::vector<std::string>& arguments, const std::string& folder);
  ~Child();  // kills what still runs
  Child(const Child&) = delete;

  /// Reads until a line contains `part`; that line, or "" after the time. Lines before it are skipped.
  std::string waitFor(const std::string& part, std::chrono::milliseconds most = std::chrono::seconds(30));
  /// All that was said so far.
  const std::string& said() const { return said_; }
  void signal(int number) const;
  /// Exit code once it has ended; -N: by signal N; -1000: it has not within the time.
  int end(std::chrono::milliseconds most = std::chrono::seconds(10));
  /// Resident memory now, in KiB.
  long kilobytes() const;

 private:
  bool readMore(std::chrono::steady_clock::time_point until);

  pid_t process_ = -1;
  int errors_ = -1;
  std::string said_;
  std::size_t looked_ = 0;  // up to here waitFor() has looked
};

}  // namespace solidcast::watch_test
