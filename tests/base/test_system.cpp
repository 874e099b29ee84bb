// SPDX-License-Identifier: GPL-3.0-or-later
#include <cerrno>
#include <csignal>
#include "base/process.h"
#include "base/system.h"
#include "tests/support/meshing.h"

namespace delquad {
namespace {

namespace fs = std::filesystem;

void somewhere_here() {}

TEST(System, KnowsItsOwnFile) {
  const fs::path program = running_program();
  EXPECT_TRUE(can_be_run(program)) << program;
  EXPECT_TRUE(fs::equivalent(file_of(&somewhere_here), program)) << file_of(&somewhere_here);
  EXPECT_FALSE(fs::equivalent(file_of(&std::abort), program)) << "that is the C library's";
  EXPECT_FALSE(can_be_run(program.parent_path())) << "a folder";
}

TEST(System, LibrariesThatCannotBeLoadedAreNamed) {
  const std::string missing = "libdelquad-missing.so";
  expect_input_error([&] { symbol_of_library(missing, "delquad_format"); },
                     {library_file(missing).c_str(), "cannot be loaded", "No such file"});
  const std::string foreign = file_of(&library_file).filename().string();  // the library that this code is in
  expect_input_error([&] { symbol_of_library(foreign, "delquad_format"); },
                     {foreign.c_str(), "delquad_format"});
}

TEST(System, TemporaryFoldersArePrivateAndGo) {
  fs::path first;
  {
    const delquad::TemporaryFolder folder, other;
    first = folder.path();
    EXPECT_NE(first, other.path());
    EXPECT_EQ(fs::status(first).permissions(), fs::perms::owner_all);
    const delquad::TemporaryFolder inner(first / ".work");
    EXPECT_EQ(inner.path().parent_path(), first);
    std::ofstream(inner.path() / "file") << "text";
    errno = ENOSPC;
  }
  EXPECT_EQ(errno, ENOSPC) << "it tells why a stream failed";
  EXPECT_FALSE(fs::exists(first));
  EXPECT_THROW(delquad::TemporaryFolder("/nowhere/at/all"), InputError);
}

/// Needs a kilobyte of the stack for each level.
int levels(int left) {
  volatile char room[1024] = {};
  room[left % 1024] = 1;
  return left == 0 ? 0 : levels(left - 1) + room[left % 1024];
}

TEST(System, StacksAreAsLargeAsAsked) {
  constexpr int kLevels = 100'000;  // more than the usual 8 MiB
  int found = 0;
  call_on_stack(std::size_t{512} << 20, [&] { found = levels(kLevels); });
  EXPECT_EQ(found, kLevels);
  EXPECT_THROW(call_on_stack(std::size_t{1} << 20, [] { throw std::out_of_range(""); }), std::out_of_range);
}

TEST(System, AThreadsClockCountsItsWorkAlone) {
  const ThreadClock clock = clock_of_this_thread();
  const long long before = nanoseconds_of(clock);
  call_on_stack(std::size_t{1} << 20, [&] {
    const long long start = nanoseconds_of_this_thread();
    while (nanoseconds_of_this_thread() - start < 50'000'000) {
    }
  });
  EXPECT_LT(nanoseconds_of(clock) - before, 40'000'000);
}

TEST(Process, AChildTellsItsResultOrThatItEnded) {
  const std::string long_text(1 << 20, 'x');
  EXPECT_EQ(call_in_child([&] { return long_text; }), long_text);
  EXPECT_EQ(call_in_child([] { return "two\nlines"; }), "two\nlines");
  EXPECT_EQ(call_in_child([]() -> std::string { std::_Exit(0); }), std::nullopt);
  EXPECT_EQ(call_in_child([]() -> std::string {
              std::raise(SIGKILL);
              return "";
            }),
            std::nullopt);
}

}  // namespace
}  // namespace delquad
