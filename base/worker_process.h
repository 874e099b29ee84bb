// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

// This header runs programs that may crash, apart from this process. Readers of files use it.

namespace delquad {

/// End of a program.
struct ProgramEnd {
  int exit_code;        ///< -1: by a signal, or unknown
  std::string printed;  ///< standard output and standard error
};
/// Runs a program of PATH without input, apart from this process as a WorkerProcess, for at most `seconds` of
/// processor time. Throws InputError if it cannot start, and Cancelled or TimeIsUp.
ProgramEnd run_to_end(const std::vector<std::string>& words, unsigned seconds);

/// A process of a program that reads files by a library, which may crash or hang on damaged files. It has no
/// standard output or error and no files of this process. Signals of the terminal do not reach it. It ends
/// with this object, and when this process dies. It does not change this process: no fork, no signal handler.
/// Throws InputError if it cannot start.
class WorkerProcess {
 public:
  explicit WorkerProcess(const std::filesystem::path& program);
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Sends the request and calls `on_reply` with each reply's kind and text, until the last reply or the end
  /// of the process. Throws Cancelled or TimeIsUp.
  void ask(const std::string& request, const std::function<void(char, const std::string&)>& on_reply);

 private:
  friend ProgramEnd run_to_end(const std::vector<std::string>&, unsigned);
  /// `streams` are standard streams of the process that become the socket; others become the null device.
  WorkerProcess(std::vector<std::string> words, const std::vector<int>& streams);
  /// Returns whether more may come.
  bool read_some(std::string& buffer) const;
  bool has_ended();

  int socket_ = -1;
  int pid_ = -1;
  int status_ = -1;
};

/// Returns whether a reply is the last: its kind is no small letter.
inline bool is_last(char kind) { return kind < 'a'; }

/// Runs a worker: it calls `answer` with the only request from the socket, and ends with its parent, the
/// process of this number. `why_not` returns the message of an exception, sent as kMessage.
[[noreturn]] void run_worker(int socket, int parent, const std::function<void(const std::string&)>& answer,
                             const std::function<std::string()>& why_not);
constexpr char kMessage = 'M';
/// Limits this process to so many seconds of processor time in all, and lets it write no core dump.
void limit_to(unsigned seconds);
/// Sends a whole reply from the worker, on any thread. The worker ends after the last reply, or without a
/// listener.
void send_reply(int socket, char kind, const std::string& text);

}  // namespace delquad
