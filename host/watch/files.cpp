#include "host/watch/files.h"

#include <poll.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "host/error.h"
#include "host/image/output_file.h"

namespace solidcast::watch {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::milliseconds kRest{10}, kLongRest{150};
constexpr std::chrono::milliseconds kClockStep{20};  // file times may lag behind the clock by a tick of the kernel
constexpr std::uint32_t kEvents = IN_CLOSE_WRITE | IN_MODIFY | IN_MOVED_TO | IN_MOVED_FROM | IN_CREATE | IN_DELETE |
                                  IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;

fs::path wholePath(const fs::path& file) {
  std::error_code ignored;
  const fs::path path = fs::absolute(file, ignored);
  return path.lexically_normal();
}

/// The folder, or the nearest one above it that exists.
fs::path existing(fs::path folder) {
  std::error_code ignored;
  while (!fs::is_directory(folder, ignored) && folder.has_relative_path()) folder = folder.parent_path();
  return folder;
}

}  // namespace

FileWatcher::FileWatcher() : inotify_(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC)) {
  if (inotify_ < 0)
    throw Error(Exit::usage, "watch: inotify: " + systemMessage(errno) +
                                 ", expected fewer watching programs than fs.inotify.max_user_instances");
}

FileWatcher::~FileWatcher() { ::close(inotify_); }

FileWatcher::Trace FileWatcher::traceOf(const fs::path& file) {
  struct stat found {};
  if (::stat(file.c_str(), &found) != 0) return {};
  return {found.st_dev, found.st_ino, static_cast<std::uint64_t>(found.st_size), found.st_mtim.tv_sec,
          found.st_mtim.tv_nsec};
}

void FileWatcher::watch(const std::vector<fs::path>& files, fs::file_time_type since) {
  std::map<fs::path, Trace> next;
  std::vector<fs::path> added;
  for (const fs::path& file : files) {
    const auto known = files_.find(file);
    if (known == files_.end()) added.push_back(file);
    next.emplace(file, known != files_.end() ? known->second : traceOf(file));
  }
  files_ = std::move(next);
  std::erase_if(changed_, [this](const fs::path& file) { return files_.count(file) == 0; });
  std::erase_if(open_, [this](const fs::path& file) { return files_.count(file) == 0; });
  follow();
  for (const fs::path& file : added) {
    std::error_code missing;
    const fs::file_time_type written = fs::last_write_time(file, missing);
    if ((missing || written < since - kClockStep) && traceOf(file) == files_[file]) continue;
    changed_.insert(file);
    last_ = Clock::now();
  }
}

/// Watches the folders of all files, of what links among them lead to, and of those that do not exist the one above.
void FileWatcher::follow() {
  names_.clear();
  std::set<fs::path> folders;
  for (const auto& [file, trace] : files_) {
    std::error_code missing;
    const fs::path whole = wholePath(file), target = fs::canonical(whole, missing);
    names_.emplace(whole, file);
    folders.insert(existing(whole.parent_path()));
    if (missing || target == whole) continue;
    names_.emplace(target, file);
    folders.insert(target.parent_path());
  }
  std::map<int, fs::path> watches;
  for (const fs::path& folder : folders) {
    const int watch = ::inotify_add_watch(inotify_, folder.c_str(), kEvents);
    if (watch >= 0) watches.emplace(watch, folder);
    else if (errno == ENOSPC || errno == ENOMEM)
      throw Error(Exit::usage, "watch: " + folder.string() + ": " + systemMessage(errno) +
                                   ", expected fewer watches than fs.inotify.max_user_watches");
  }
  for (const auto& [watch, folder] : folders_)
    if (watches.count(watch) == 0) ::inotify_rm_watch(inotify_, watch);
  folders_ = std::move(watches);
}

/// Something happened to a file of this name.
void FileWatcher::named(const fs::path& path, std::uint32_t what) {
  const auto [first, last] = names_.equal_range(path);
  for (auto name = first; name != last; ++name) {
    const fs::path& file = name->second;
    changed_.insert(file);
    if (what & IN_MODIFY) open_.insert(file);
    else open_.erase(file);
    last_ = Clock::now();
  }
}

/// Reads what the kernel has to tell. Events name most changes; what they cannot (a folder that came or went, a link that
/// leads elsewhere, lost events) shows when all files are looked at.
void FileWatcher::take() {
  alignas(inotify_event) std::array<char, 65536> block;
  bool any = false;
  for (ssize_t got; (got = ::read(inotify_, block.data(), block.size())) > 0;) {
    any = true;
    for (const char* at = block.data(); at < block.data() + got;) {
      const auto* event = reinterpret_cast<const inotify_event*>(at);
      const auto folder = folders_.find(event->wd);
      if (event->len > 0 && folder != folders_.end()) named(folder->second / event->name, event->mask);
      at += sizeof(inotify_event) + event->len;
    }
  }
  if (!any) return;
  follow();
  for (auto& [file, trace] : files_) {
    const Trace now = traceOf(file);
    if (now == trace) continue;
    trace = now;
    changed_.insert(file);
    last_ = Clock::now();
  }
}

std::chrono::milliseconds FileWatcher::restNeeded() const {
  const bool unfinished = !open_.empty() || std::any_of(changed_.begin(), changed_.end(), [this](const fs::path& file) {
    return files_.at(file) == Trace{};
  });
  return unfinished ? kLongRest : kRest;
}

bool FileWatcher::quiet() {
  const Clock::time_point until = Clock::now() + kRest;
  for (;;) {
    take();
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    if (!changed_.empty() || left <= 0) return changed_.empty();
    pollfd source{inotify_, POLLIN, 0};
    ::poll(&source, 1, static_cast<int>(left));
  }
}

std::vector<fs::path> FileWatcher::wait(std::span<const int> others) {
  std::vector<pollfd> sources{{inotify_, POLLIN, 0}};
  for (const int other : others) sources.push_back({other, POLLIN, 0});
  for (;;) {
    take();
    int timeout = -1;
    if (!changed_.empty()) {
      const auto left = last_ + restNeeded() - Clock::now();
      if (left <= Clock::duration::zero()) {
        open_.clear();
        const std::set<fs::path> files = std::exchange(changed_, {});
        return {files.begin(), files.end()};
      }
      timeout = static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(left).count());
    }
    const int ready = ::poll(sources.data(), sources.size(), timeout);
    if (ready < 0 && errno == EINTR) return {};
    for (std::size_t i = 1; ready > 0 && i < sources.size(); ++i)
      if (sources[i].revents != 0) return {};
  }
}

}  // namespace solidcast::watch
