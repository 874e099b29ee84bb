// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/resource.h>
#include <sys/stat.h>
#include <csignal>

#include "tests/support/files.h"

namespace delquad {
namespace {

/// No file may grow beyond so many bytes: what a full disk does to a program, without a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit = {bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

void write_long(std::ostream& out) {
  for (int i = 0; i < 100'000; ++i) out << "0123456789";
}

TEST(AtomicFile, ReplacesWhatWasThere) {
  const Folder folder;
  write_text(folder / "a.txt", "before");
  write_file_atomically(folder / "a.txt", [](std::ostream& out) { out << "after"; });
  EXPECT_EQ(read_text(folder / "a.txt"), "after");
  EXPECT_EQ(folder.names(), Strings{"a.txt"});
}

TEST(AtomicFile, KeepsTheOldFileWhenTheDiskIsFull) {
  const Folder folder;
  write_text(folder / "a.txt", "before");
  {
    const FileSizeLimit limit(1000);
    expect_input_error([&] { write_file_atomically(folder / "a.txt", write_long); }, {"a.txt", "too large"});
    // Small enough to fail only when the stream is closed.
    expect_input_error(
        [&] {
          write_file_atomically(folder / "b.txt", [](std::ostream& out) { out << std::string(1500, 'x'); });
        },
        {"b.txt", "too large"});
  }
  EXPECT_EQ(read_text(folder / "a.txt"), "before");
  EXPECT_EQ(folder.names(), Strings{"a.txt"});
}

TEST(AtomicFile, GoesThroughLinksThatPointNowhere) {
  const Folder folder;
  fs::create_symlink("b.txt", folder / "a.txt");
  fs::create_symlink(folder / "c.txt", folder / "b.txt");
  write_file_atomically(folder / "a.txt", [](std::ostream& out) { out << "text"; });
  EXPECT_TRUE(fs::is_symlink(folder / "a.txt"));
  EXPECT_EQ(read_text(folder / "c.txt"), "text");
  fs::create_symlink("e.txt", folder / "d.txt");
  fs::create_symlink("d.txt", folder / "e.txt");
  expect_input_error([&] { write_file_atomically(folder / "d.txt", write_long); }, {"d.txt", "links"});
}

TEST(AtomicFile, LeavesNothingWhenTheWriterThrows) {
  const Folder folder;
  const auto throwing = [](std::ostream& out) {
    write_long(out);
    throw std::runtime_error("interrupted");
  };
  EXPECT_THROW(write_file_atomically(folder / "a.txt", throwing), std::runtime_error);
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, NamesThePathAndTheReason) {
  const Folder folder;
  const auto write = [](std::ostream& out) { out << "text"; };
  write_text(folder / "file", "");
  expect_input_error([&] { write_file_atomically(folder / "no/such/a.txt", write); },
                     {"no/such/a.txt", "No such file or directory"});
  expect_input_error([&] { write_file_atomically(folder / "file/a.txt", write); },
                     {"file/a.txt", "Not a directory"});
  expect_input_error([&] { write_file_atomically(folder.path(), write); }, {"folder"});
  expect_input_error([&] { write_file_atomically(folder / std::string(300, 'x'), write); },
                     {"File name too long"});
  EXPECT_EQ(folder.names(), Strings{"file"});
}

TEST(AtomicFile, WritesIntoDevicesAndThroughLinks) {
  expect_input_error([] { write_file_atomically("/dev/full", write_long); },
                     {"/dev/full", "No space left on device"});
  write_file_atomically("/dev/null", write_long);
  struct stat status {};
  ASSERT_EQ(stat("/dev/null", &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode)) << "the device is still one";

  const Folder folder;
  write_text(folder / "target", "before");
  fs::create_symlink("target", folder / "link");
  write_file_atomically(folder / "link", [](std::ostream& out) { out << "after"; });
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_text(folder / "target"), "after");
}

TEST(AtomicFile, WritesIntoTheWorkingFolder) {
  const Folder folder;
  const auto before = fs::current_path();
  fs::current_path(folder.path());
  write_file_atomically("a.txt", [](std::ostream& out) { out << "text"; });
  fs::current_path(before);
  EXPECT_EQ(folder.names(), Strings{"a.txt"});
}

TEST(AtomicFiles, StandOrFallTogether) {
  const Folder folder;
  write_text(folder / "a.txt", "before");
  const auto write = [](const char* text) { return [text](std::ostream& out) { out << text; }; };
  const auto throws = [](std::ostream&) { throw InputError("no second"); };
  expect_input_error(
      [&] {
        write_files_atomically({{folder / "a.txt", write("after")}, {folder / "b.txt", throws}});
      },
      {"no second"});
  EXPECT_EQ(read_text(folder / "a.txt"), "before");
  EXPECT_EQ(folder.names(), Strings{"a.txt"});
  write_files_atomically({{folder / "a.txt", write("after")}, {folder / "b.txt", write("too")}});
  EXPECT_EQ(read_text(folder / "a.txt"), "after");
  EXPECT_EQ(read_text(folder / "b.txt"), "too");
  EXPECT_EQ(folder.names().size(), 2u);
}

}  // namespace
}  // namespace delquad
