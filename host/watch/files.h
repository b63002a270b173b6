// Tells when files change, however an editor saves: in place, by renaming another file over it, by deleting it first. The
// kernel (inotify) is asked about the folders, because a watch on a file follows the old file away when it is replaced. Files
// that do not exist yet can be waited for, their folders too.
#pragma once
#include <chrono>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace solidcast::watch {

class FileWatcher {
 public:
  using Clock = std::chrono::steady_clock;

  FileWatcher();  // throws Error(Exit::usage) where the kernel gives no watches
  ~FileWatcher();
  FileWatcher(const FileWatcher&) = delete;

  /// From now on these files. One that is new here counts as changed if it was written after `since`: between the moment
  /// it was read and this call nobody watched.
  void watch(const std::vector<std::filesystem::path>& files, std::filesystem::file_time_type since);

  /// Waits until files changed and came to rest, and returns them; or returns none, as soon as one of `others` (file
  /// descriptors) can be read. At rest: nothing happened for 10 ms; where a file is missing or still open for writing, for
  /// 150 ms.
  std::vector<std::filesystem::path> wait(std::span<const int> others);

  /// Nothing happened since wait() returned, nor does in the next 10 ms: what was read then was no half of a save.
  bool quiet();

 private:
  /// What a file is by the file system; all zero: not there.
  struct Trace {
    std::uint64_t device = 0, inode = 0, bytes = 0;
    std::int64_t seconds = 0, nanoseconds = 0;
    bool operator==(const Trace&) const = default;
  };
  static Trace traceOf(const std::filesystem::path& file);

  void follow();
  void take();
  void named(const std::filesystem::path& path, std::uint32_t what);
  std::chrono::milliseconds restNeeded() const;

  int inotify_ = -1;
  std::map<std::filesystem::path, Trace> files_;
  std::map<int, std::filesystem::path> folders_;  // by watch
  std::multimap<std::filesystem::path, std::filesystem::path>
      names_;                                       // absolute, links followed or not -> as in files_
  std::set<std::filesystem::path> changed_, open_;  // as in files_
  Clock::time_point last_;                          // when something happened to them
};

}  // namespace solidcast::watch
