// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/worker_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <thread>
#include <utility>

#include "base/context.h"
#include "base/process.h"
#include "delquad/error.h"

namespace delquad {

namespace {

/// Milliseconds between checks for cancellation or a dead process.
constexpr int kPollMilliseconds = 20;
constexpr std::size_t kLengthBytes = sizeof(std::uint64_t), kHead = 1 + kLengthBytes;

[[noreturn]] void refuse(const std::string& what, int error) {
  throw InputError(
      fmt::format("no process can be started to read files: {}: {}", what, std::strerror(error)));
}

std::string framed(char first, const std::string& text) {
  std::string frame(kHead, first);
  const std::uint64_t length = text.size();
  std::memcpy(frame.data() + 1, &length, kLengthBytes);
  return frame + text;
}

/// Returns the length in a head.
std::size_t length_in(const std::string& frame) {
  std::uint64_t length = 0;
  std::memcpy(&length, frame.data() + 1, kLengthBytes);
  return length;
}

/// Returns both ends, neither of them a standard stream, so that the child can replace these.
std::pair<int, int> connected_pair() {
  constexpr int kFirst = 10;
  int ends[2], above[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) refuse("no pair of sockets", errno);
  for (int i = 0; i < 2; ++i) above[i] = fcntl(ends[i], F_DUPFD_CLOEXEC, kFirst);
  const int error = errno;
  for (const int end : ends) close(end);
  if (above[0] >= 0 && above[1] >= 0) return {above[0], above[1]};
  for (const int end : above)
    if (end >= 0) close(end);
  refuse("no pair of sockets", error);
}

/// Attributes of a worker's start. Some standard streams are the socket, and it has no other files. No signal
/// is ignored or blocked, and it is its own process group.
class Spawning {
 public:
  Spawning(int socket, const std::vector<int>& streams) {
    posix_spawn_file_actions_init(&files_);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      if (std::ranges::find(streams, stream) != streams.end())
        posix_spawn_file_actions_adddup2(&files_, socket, stream);
      else
        posix_spawn_file_actions_addopen(&files_, stream, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_addclosefrom_np(&files_, STDERR_FILENO + 1);
    posix_spawnattr_init(&attributes_);
    sigset_t all, none;
    sigfillset(&all);
    sigemptyset(&none);
    posix_spawnattr_setsigdefault(&attributes_, &all);
    posix_spawnattr_setsigmask(&attributes_, &none);
    posix_spawnattr_setpgroup(&attributes_, 0);
    posix_spawnattr_setflags(&attributes_,
                             POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
  }
  ~Spawning() {
    posix_spawn_file_actions_destroy(&files_);
    posix_spawnattr_destroy(&attributes_);
  }
  Spawning(const Spawning&) = delete;
  Spawning& operator=(const Spawning&) = delete;

  /// Returns an error number; 0: none.
  int start(std::vector<std::string>& words, pid_t& pid) const {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    return posix_spawnp(&pid, arguments[0], &files_, &attributes_, arguments.data(), environ);
  }

 private:
  posix_spawn_file_actions_t files_;
  posix_spawnattr_t attributes_;
};

/// Takes complete replies from the front of the buffer. Returns whether the last one was among them.
bool handle_replies(std::string& buffer, const std::function<void(char, const std::string&)>& on_reply) {
  std::size_t at = 0;
  bool last = false;
  while (!last && buffer.size() - at >= kHead) {
    const std::string head = buffer.substr(at, kHead);
    const std::size_t length = length_in(head);
    if (buffer.size() - at - kHead < length) {
      buffer.reserve(at + kHead + length);
      break;
    }
    on_reply(head[0], buffer.substr(at + kHead, length));
    last = is_last(head[0]);
    at += kHead + length;
  }
  buffer.erase(0, at);
  return last;
}

/// Ends the worker when nobody listens, so that it cannot run forever.
void end_with_listener(int parent, int socket) {
  end_with_parent(parent, SIGKILL);
  std::thread([socket] {
    pollfd entry{socket, POLLRDHUP, 0};
    while (poll(&entry, 1, -1) <= 0) {
    }
    _exit(1);
  }).detach();
}

std::string receive_request(int socket) {
  const auto read_exactly = [socket](std::size_t size) {
    std::string bytes(size, '\0');
    for (std::size_t got = 0; got < size;) {
      const ssize_t n = recv(socket, bytes.data() + got, size - got, 0);
      if (n == 0 || (n < 0 && errno != EINTR)) _exit(1);
      if (n > 0) got += static_cast<std::size_t>(n);
    }
    return bytes;
  };
  return read_exactly(length_in(read_exactly(kHead)));
}

}  // namespace

// The worker ends with its parent, which may be another process by the time it asks for that.
WorkerProcess::WorkerProcess(const std::filesystem::path& program)
    : WorkerProcess({program.string(), std::to_string(process_number())}, {STDIN_FILENO}) {}

WorkerProcess::WorkerProcess(std::vector<std::string> words, const std::vector<int>& streams) {
  const auto [ours, its] = connected_pair();
  const int error = Spawning(its, streams).start(words, pid_);
  close(its);
  socket_ = ours;
  if (error == 0) return;
  close(ours);
  refuse(words[0], error);
}

WorkerProcess::~WorkerProcess() {
  close(socket_);
  if (!has_ended()) {
    kill(pid_, SIGKILL);
    wait_for_end(pid_);
  }
}

/// Returns whether it has ended. An embedding program may wait for all its children; then this one is no
/// longer found.
bool WorkerProcess::has_ended() {
  if (pid_ < 0) return true;
  const pid_t ended = waitpid(pid_, &status_, WNOHANG);
  if (ended == pid_ || (ended < 0 && errno == ECHILD)) pid_ = -1;
  return pid_ < 0;
}

bool WorkerProcess::read_some(std::string& buffer) const {
  constexpr std::size_t kPiece = 1 << 20;
  const std::size_t before = buffer.size();
  buffer.resize(before + kPiece);
  const ssize_t n = recv(socket_, buffer.data() + before, kPiece, MSG_DONTWAIT);
  const bool more = n > 0 || (n < 0 && (errno == EINTR || errno == EAGAIN));
  buffer.resize(before + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
  return more;
}

void WorkerProcess::ask(const std::string& request,
                        const std::function<void(char, const std::string&)>& on_reply) {
  const std::string message = framed('?', request);
  std::string buffer;
  for (std::size_t sent = 0;;) {
    check_cancelled();
    pollfd entry{socket_, static_cast<short>(sent < message.size() ? POLLIN | POLLOUT : POLLIN), 0};
    const int ready = poll(&entry, 1, kPollMilliseconds);
    if (ready < 0 && errno != EINTR) refuse("poll", errno);
    if ((entry.revents & POLLOUT) != 0) {
      const ssize_t n =
          send(socket_, message.data() + sent, message.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (n > 0) sent += static_cast<std::size_t>(n);
    }
    // A process forked meanwhile may keep the other end open.
    const bool ended = ready == 0 && has_ended();
    const bool more = (ready <= 0 && !ended) || (entry.revents & ~POLLOUT) == 0 || read_some(buffer);
    if (handle_replies(buffer, on_reply) || !more || ended) return;
  }
}

ProgramEnd run_to_end(const std::vector<std::string>& words, unsigned seconds) {
  WorkerProcess program(words, {STDOUT_FILENO, STDERR_FILENO});
  const rlimit time{seconds, seconds};
  prlimit(program.pid_, RLIMIT_CPU, &time, nullptr);
  ProgramEnd end{-1, ""};
  for (bool more = true; more;) {
    check_cancelled();
    pollfd entry{program.socket_, POLLIN, 0};
    more = poll(&entry, 1, kPollMilliseconds) > 0 ? program.read_some(end.printed) : !program.has_ended();
  }
  if (!program.has_ended()) program.status_ = wait_for_end(std::exchange(program.pid_, -1));
  if (WIFEXITED(program.status_)) end.exit_code = WEXITSTATUS(program.status_);
  return end;
}

void send_reply(int socket, char kind, const std::string& text) {
  static std::mutex one_by_one;
  const std::lock_guard lock(one_by_one);
  const std::string frame = framed(kind, text);
  for (std::size_t sent = 0; sent < frame.size();) {
    const ssize_t n = send(socket, frame.data() + sent, frame.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno != EINTR) _exit(1);
    if (n > 0) sent += static_cast<std::size_t>(n);
  }
  if (is_last(kind)) _exit(0);
}

void limit_to(unsigned seconds) {
  const rlimit time{seconds, seconds}, no_core{0, 0};
  setrlimit(RLIMIT_CPU, &time);
  setrlimit(RLIMIT_CORE, &no_core);
}

void run_worker(int socket, int parent, const std::function<void(const std::string&)>& answer,
                const std::function<std::string()>& why_not) {
  end_with_listener(parent, socket);
  try {
    answer(receive_request(socket));
  } catch (...) {
    send_reply(socket, kMessage, why_not());
  }
  _exit(1);
}

}  // namespace delquad
