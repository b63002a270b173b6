#include "host/image/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

#include "host/error.h"

namespace solidcast {
namespace {

namespace fs = std::filesystem;

/// Adds the time until its end to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(double& sum) : sum_(sum), start_(Clock::now()) {}
  ~Stopwatch() { sum_ += std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  double& sum_;
  Clock::time_point start_;
};

/// Writes all of it, in pieces where the system takes no more at once; 0 or an errno.
int writeAll(int file, const char* data, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t written = ::write(file, data, bytes);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    data += written;
    bytes -= static_cast<std::size_t>(written);
  }
  return 0;
}

/// Names of unfinished outputs where a signal handler can read them: no heap, no locks. An output that finds no room
/// here is only not tidied away after a signal.
struct Unfinished {
  std::atomic<const void*> owner = nullptr;
  std::atomic<bool> ready = false;
  std::array<char, 4096> name{};
};
std::array<Unfinished, 32> unfinished;

void remember(const void* owner, const std::string& name) {
  if (name.size() >= unfinished[0].name.size()) return;
  for (Unfinished& slot : unfinished) {
    const void* none = nullptr;
    if (!slot.owner.compare_exchange_strong(none, owner)) continue;
    std::memcpy(slot.name.data(), name.c_str(), name.size() + 1);
    slot.ready = true;
    return;
  }
}

void forget(const void* owner) {
  for (Unfinished& slot : unfinished)
    if (slot.owner == owner) slot.ready = false, slot.owner = nullptr;
}

}  // namespace

void removeUnfinishedOutputs() noexcept {
  for (const Unfinished& slot : unfinished)
    if (slot.ready) ::unlink(slot.name.data());
}

std::string systemMessage(int error) { return std::generic_category().message(error); }

OutputFile::OutputFile(std::string path, bool seeks) : path_(std::move(path)) {
  if (path_.empty()) throw Error(Exit::output, "the output's name is empty");
  struct stat status {};
  if (path_ == "-") {
    file_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
    if (file_ < 0) fail(systemMessage(errno));
  } else if (::stat(path_.c_str(), &status) == 0 && !S_ISREG(status.st_mode)) {
    if (S_ISDIR(status.st_mode)) fail("is a folder, expected the name of a file");
    file_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (file_ < 0) fail(systemMessage(errno));
  } else {
    openBeside();
    return;
  }
  if (seeks) openSpool();
}

OutputFile::~OutputFile() {
  if (file_ >= 0) ::close(file_);
  if (spool_ >= 0) ::close(spool_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
  forget(this);
}

void OutputFile::fail(const std::string& what) const {
  throw Error(Exit::output, (path_ == "-" ? "standard output" : path_) + ": cannot write: " + what);
}

void OutputFile::openBeside() {
  // A link stays a link: what it points to is replaced.
  std::error_code error;
  const fs::path followed = fs::weakly_canonical(path_, error);
  target_ = error ? path_ : followed.string();

  struct stat existing {};
  const bool exists = ::stat(target_.c_str(), &existing) == 0;
  if (exists && ::access(target_.c_str(), W_OK) != 0) fail(systemMessage(errno));
  if (fs::path(path_).filename().empty()) fail("is a folder, expected the name of a file");

  const fs::path folder = fs::path(target_).parent_path();
  const std::string stem = (folder / (".solidcast-" + std::to_string(::getpid()) + "-")).string();
  for (int number = 0; file_ < 0; ++number) {
    temporary_ = stem + std::to_string(number) + ".part";
    file_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file_ >= 0 || errno == EEXIST) continue;
    const int reason = errno;
    temporary_.clear();
    if (reason == ENOENT) fail("the folder " + folder.string() + " does not exist");
    fail(systemMessage(reason) + " (folder " + folder.string() + ")");
  }
  remember(this, temporary_);
  if (exists) static_cast<void>(::fchmod(file_, existing.st_mode & 07777));  // not ours to change, if it can't be kept
}

void OutputFile::openSpool() {
  std::error_code error;
  const fs::path folder = fs::temp_directory_path(error);
  std::string name = ((error ? fs::path("/tmp") : folder) / "solidcast-XXXXXX").string();
  spool_ = ::mkstemp(name.data());
  if (spool_ < 0) fail("no room to put it together in " + name + ": " + systemMessage(errno));
  ::unlink(name.c_str());
}

void OutputFile::append(const void* data, std::size_t bytes) {
  const Stopwatch watch(milliseconds_);
  if (const int error = writeAll(spool_ >= 0 ? spool_ : file_, static_cast<const char*>(data), bytes))
    fail(systemMessage(error));
}

void OutputFile::writeAt(std::uint64_t offset, const void* data, std::size_t bytes) {
  const Stopwatch watch(milliseconds_);
  const int file = spool_ >= 0 ? spool_ : file_;
  if (::lseek(file, static_cast<off_t>(offset), SEEK_SET) < 0) fail(systemMessage(errno));
  if (const int error = writeAll(file, static_cast<const char*>(data), bytes)) fail(systemMessage(error));
}

void OutputFile::copySpool() {
  if (::lseek(spool_, 0, SEEK_SET) < 0) fail(systemMessage(errno));
  std::vector<char> block(std::size_t{1} << 20);
  for (;;) {
    const ssize_t got = ::read(spool_, block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) fail(systemMessage(errno));
    if (got == 0) return;
    if (const int error = writeAll(file_, block.data(), static_cast<std::size_t>(got))) fail(systemMessage(error));
  }
}

void OutputFile::finish() {
  const Stopwatch watch(milliseconds_);
  if (spool_ >= 0) copySpool();
  const int closed = ::close(file_);
  file_ = -1;
  if (closed != 0) fail(systemMessage(errno));
  if (temporary_.empty()) return;
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(systemMessage(errno));
  temporary_.clear();
  forget(this);
}

}  // namespace solidcast
