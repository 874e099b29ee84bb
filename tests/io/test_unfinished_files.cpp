// SPDX-License-Identifier: GPL-3.0-or-later
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/files.h"

namespace delquad::testing_support {
namespace {

/// The exit code of a process that does this.
template <class Work>
int run_in_child(Work work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(UnfinishedFiles, GoWithTheProcessThatAbandonsThem) {
  const Folder folder;
  EXPECT_EQ(run_in_child([&] {
              write_file_atomically(folder / "out.msh", [&](std::ostream& out) {
                out << "half" << std::flush;
                _exit(folder.names().size() == 1 && abandon_files() ? 7 : 8);
              });
              return 9;
            }),
            7);
  EXPECT_EQ(folder.names(), Strings{});
}

TEST(UnfinishedFiles, AreFinishedOnceTheFirstStands) {
  const Folder folder;
  EXPECT_EQ(run_in_child([&] {
              write_file_atomically(folder / "out.msh", [](std::ostream& out) { out << "all"; });
              bool abandoned = true;
              write_file_atomically(folder / "out.json", [&](std::ostream& out) {
                abandoned = abandon_files();
                out << "{}";
              });
              return abandoned ? 1 : 0;
            }),
            0);
  EXPECT_EQ(folder.names(), (Strings{"out.json", "out.msh"}));
}

}  // namespace
}  // namespace delquad::testing_support
