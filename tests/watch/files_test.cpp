// The watcher of files: every way in which editors save.
#include "host/watch/files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <thread>

#include "tests/cli/program.h"

namespace solidcast::watch {
namespace {

using cli_test::Folder;
using cli_test::writeFile;
namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

class Files : public ::testing::Test {
 protected:
  Files() {
    EXPECT_EQ(::pipe(stop_), 0);
    writeFile(a, "1");
    writeFile(b, "1");
    start();
  }
  ~Files() override {
    ::close(stop_[0]);
    ::close(stop_[1]);
  }
  void start(const Paths& more = {}) {
    Paths all{a, b};
    all.insert(all.end(), more.begin(), more.end());
    watcher.watch(all, fs::file_time_type::clock::now() + std::chrono::hours(1));
  }
  /// What changed within the time.
  Paths changes(std::chrono::milliseconds most = std::chrono::seconds(5)) {
    std::jthread bell([this, most](std::stop_token stopped) {
      const auto until = std::chrono::steady_clock::now() + most;
      while (!stopped.stop_requested() && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      if (stopped.stop_requested()) return;
      EXPECT_EQ(::write(stop_[1], "x", 1), 1);
    });
    return watcher.wait(std::span<const int>(&stop_[0], 1));
  }
  void expectQuiet() {
    EXPECT_EQ(changes(std::chrono::milliseconds(60)), Paths{});
    char bell;
    EXPECT_EQ(::read(stop_[0], &bell, 1), 1);
  }

  Folder folder;
  const std::string a = folder / "a.json", b = folder / "b.glsl";
  FileWatcher watcher;
  int stop_[2];
};

TEST_F(Files, WrittenInPlace) {
  writeFile(a, "22");
  EXPECT_EQ(changes(), Paths{a});
}

TEST_F(Files, SameContentIsASaveToo) {
  writeFile(a, "1");
  EXPECT_EQ(changes(), Paths{a});
}

TEST_F(Files, RenamedOver) {
  writeFile(folder / "a.json~", "22");
  fs::rename(folder / "a.json~", a);
  EXPECT_EQ(changes(), Paths{a});
}

TEST_F(Files, MovedAwayAndWrittenAnew) {
  fs::rename(a, folder / "a.json~");
  writeFile(a, "22");
  EXPECT_EQ(changes(), Paths{a});
}

TEST_F(Files, RemovedForAMomentIsOneChange) {
  fs::remove(a);
  std::jthread late([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(40));
    writeFile(a, "22");
  });
  EXPECT_EQ(changes(), Paths{a});
  EXPECT_TRUE(fs::exists(a));
  expectQuiet();
}

TEST_F(Files, RemovedForGood) {
  fs::remove(a);
  EXPECT_EQ(changes(), Paths{a});
}

TEST_F(Files, SeveralAtOnceAreOneChange) {
  writeFile(a, "22");
  writeFile(b, "22");
  EXPECT_EQ(changes(), (Paths{a, b}));
}

TEST_F(Files, OthersDoNotMatter) {
  writeFile(folder / "c", "1");
  fs::create_directory(folder / "d");
  fs::remove(folder / "c");
  expectQuiet();
}

TEST_F(Files, OpenForWritingIsWaitedFor) {
  FILE* file = std::fopen(a.c_str(), "w");
  std::fputs("2", file);
  std::fflush(file);
  std::jthread late([file] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    std::fputs("2", file);
    std::fclose(file);
  });
  EXPECT_EQ(changes(), Paths{a});
  EXPECT_EQ(fs::file_size(a), 2u);
}

TEST_F(Files, ThroughALink) {
  Folder elsewhere;
  writeFile(elsewhere / "real", "1");
  fs::create_symlink(elsewhere / "real", folder / "link");
  start({folder / "link"});
  writeFile(elsewhere / "real", "22");
  EXPECT_EQ(changes(), Paths{folder / "link"});
  writeFile(elsewhere / "other", "333");
  fs::remove(folder / "link");
  fs::create_symlink(elsewhere / "other", folder / "link");
  EXPECT_EQ(changes(), Paths{folder / "link"});
  writeFile(elsewhere / "other", "4444");
  EXPECT_EQ(changes(), Paths{folder / "link"});
}

TEST_F(Files, InAFolderThatIsYetToCome) {
  const std::string late = folder / "x/y/late.glsl";
  start({late});
  fs::create_directories(folder / "x/y");
  expectQuiet();
  writeFile(late, "1");
  EXPECT_EQ(changes(), Paths{late});
}

TEST_F(Files, FolderMovedAwayAndBack) {
  fs::create_directory(folder / "x");
  writeFile(folder / "x/c", "1");
  start({folder / "x/c"});
  fs::rename(folder / "x", folder / "z");
  EXPECT_EQ(changes(), Paths{folder / "x/c"});
  fs::rename(folder / "z", folder / "x");
  EXPECT_EQ(changes(), Paths{folder / "x/c"});
  writeFile(folder / "x/c", "22");
  EXPECT_EQ(changes(), Paths{folder / "x/c"});
}

TEST_F(Files, NewOneThatWasWrittenSinceItWasRead) {
  const auto before = fs::file_time_type::clock::now();
  writeFile(folder / "c", "1");
  watcher.watch({a, b, folder / "c"}, before);
  EXPECT_EQ(changes(), Paths{folder / "c"});
  writeFile(folder / "d", "1");
  fs::last_write_time(folder / "d", before - std::chrono::seconds(1));
  watcher.watch({a, b, folder / "c", folder / "d"}, before);
  expectQuiet();
}

TEST_F(Files, NoLongerWatched) {
  watcher.watch({b}, fs::file_time_type::clock::now());
  writeFile(a, "22");
  expectQuiet();
}

TEST_F(Files, QuietSeesTheNextSave) {
  EXPECT_TRUE(watcher.quiet());
  writeFile(a, "22");
  EXPECT_FALSE(watcher.quiet());
  EXPECT_EQ(changes(), Paths{a});
}

}  // namespace
}  // namespace solidcast::watch
