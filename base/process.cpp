// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace delquad {

int process_number() { return getpid(); }

Pipe::Pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  read_end = ends[0];
  write_end = ends[1];
}

void end_with_parent(int parent, int signal_number) {
  prctl(PR_SET_PDEATHSIG, signal_number);
  if (getppid() != parent) _exit(1);
}

int wait_for_end(int child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return status;
}

std::optional<std::string> call_in_child(const std::function<std::string()>& work, unsigned seconds) {
  constexpr char kDone = '\n';  // a line that only the child can end
  const Pipe pipe;
  const int parent = getpid(), child = fork();
  if (child == 0) {
    end_with_parent(parent, SIGKILL);
    const rlimit time{seconds, seconds}, no_core{0, 0};
    if (seconds > 0) setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &no_core);
    const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    const std::string output = work() + kDone;
    _exit(write(pipe.write_end, output.data(), output.size()) < 0);
  }
  const int error = errno;
  close(pipe.write_end);
  std::string output;
  std::array<char, 4096> block;
  ssize_t n = 0;
  while ((n = read(pipe.read_end, block.data(), block.size())) > 0 || (n < 0 && errno == EINTR))
    output.append(block.data(), static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  close(pipe.read_end);
  if (child < 0) throw std::system_error(error, std::generic_category(), "fork");
  wait_for_end(child);
  if (!output.ends_with(kDone)) return std::nullopt;
  output.pop_back();
  return output;
}

void start_detached(std::string program, std::string argument) {
  std::array<char*, 3> arguments = {program.data(), argument.data(), nullptr};
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&silent, stream, "/dev/null", O_RDWR, 0);
  posix_spawnattr_t apart;
  posix_spawnattr_init(&apart);
  posix_spawnattr_setflags(&apart, POSIX_SPAWN_SETSID);
  pid_t child = 0;
  posix_spawnp(&child, program.c_str(), &silent, &apart, arguments.data(), environ);
  posix_spawnattr_destroy(&apart);
  posix_spawn_file_actions_destroy(&silent);
}

}  // namespace delquad
