// A file that appears under its name only when it is whole: written under a temporary name in the same folder and
// renamed at the end, so that a failure leaves nothing behind and an existing file untouched.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

namespace solidcast {

class OutputFile {
 public:
  /// Opens for `path`; "-" is standard output. What is no regular file (a pipe, /dev/null) is written in place.
  /// `seeks`: the content will be written out of order; where the target can't do that, it is spooled.
  /// Throws Error(Exit::output) with one line when nothing can be written there.
  OutputFile(std::string path, bool seeks);
  ~OutputFile();  // without finish(): the temporary file is removed
  OutputFile(const OutputFile&) = delete;

  /// Both throw Error(Exit::output) when the bytes do not fit (full disk, closed pipe).
  void append(const void* data, std::size_t bytes);
  void writeAt(std::uint64_t offset, const void* data, std::size_t bytes);

  /// Closes and renames. Throws Error(Exit::output).
  void finish();

  /// Time spent in system calls so far.
  double milliseconds() const { return milliseconds_; }

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void openBeside();
  void openSpool();
  void copySpool();

  std::string path_, target_, temporary_;  // as given; with links followed; empty when written in place
  int file_ = -1, spool_ = -1;
  double milliseconds_ = 0;
};

/// Removes what unfinished outputs have written so far. For signal handlers: calls nothing but unlink().
void removeUnfinishedOutputs() noexcept;

/// "No such file or directory" and the like, for an errno.
std::string systemMessage(int error);

}  // namespace solidcast
