#include "cad/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <mutex>

#include "mesh/error.h"

namespace delquad::cad {

namespace {

/// Writes the result and ends the child; who comes second waits for that end.
[[noreturn]] void answer(const std::string& result, int to) {
  static std::mutex first;
  const std::lock_guard lock(first);
  for (std::size_t sent = 0; sent < result.size();) {
    const ssize_t n = write(to, result.data() + sent, result.size() - sent);
    if (n < 0 && errno != EINTR) _exit(1);
    if (n > 0) sent += static_cast<std::size_t>(n);
  }
  _exit(0);
}

/// The rest of the child's life.
[[noreturn]] void live(const std::function<std::string(const Answer&)>& work, unsigned seconds, int to,
                       pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody else would end it when its parent is killed
  if (getppid() != parent) _exit(1);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  const rlimit time{seconds, seconds}, no_core{0, 0};
  setrlimit(RLIMIT_CPU, &time);
  setrlimit(RLIMIT_CORE, &no_core);
  answer(work([to](const std::string& result) { answer(result, to); }), to);
}

std::string read_all(int from) {
  std::string all;
  std::array<char, 1 << 16> buffer;
  for (;;) {
    const ssize_t n = read(from, buffer.data(), buffer.size());
    if (n == 0 || (n < 0 && errno != EINTR)) return all;
    if (n > 0) all.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

}  // namespace

std::optional<std::string> run_apart(const std::function<std::string(const Answer&)>& work, unsigned seconds,
                                     std::vector<FaceAtWork>* left) {
  std::array<int, 2> ends;
  if (pipe2(ends.data(), O_CLOEXEC) != 0) throw InputError("no pipe to a process that reads the file");
  const pid_t parent = getpid(), child = fork();
  if (child == 0) live(work, seconds, ends[1], parent);
  close(ends[1]);
  std::string result = child > 0 ? read_all(ends[0]) : "";
  close(ends[0]);
  if (child < 0) throw InputError("no process can be started to read the file");
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return std::nullopt;
  if (left != nullptr) *left = faces_at_work();
  forget_activities(child);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return result;
}

}  // namespace delquad::cad
