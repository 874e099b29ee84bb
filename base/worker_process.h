#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace delquad {

/// How a program ended.
struct ProgramEnd {
  int exit_code;        ///< -1: by a signal, or not known
  std::string printed;  ///< to standard output and standard error
};
/// Runs a program of the PATH, for so many seconds of processor time at most, without input and as a
/// WorkerProcess apart from this one. Throws InputError when it cannot be started, and Cancelled.
ProgramEnd run_to_end(const std::vector<std::string>& words, unsigned seconds);

/// A process of a program that reads files by a library, which may crash on damaged ones, or find no end. It
/// has neither standard output nor error nor any file of this one's, and a signal of the terminal does not
/// reach it. It ends with this object, and when this process dies.
/// Nothing of this process is changed: no fork, no signal handler. Throws InputError when it cannot be
/// started.
class WorkerProcess {
 public:
  explicit WorkerProcess(const std::filesystem::path& program);
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Sends the request and calls `hear` with each reply and its kind, until the last one has come or the
  /// process has ended. Throws Cancelled.
  void ask(const std::string& request, const std::function<void(char, const std::string&)>& hear);

 private:
  friend ProgramEnd run_to_end(const std::vector<std::string>&, unsigned);
  /// `streams`: standard ones of the process that are the socket; the others are the null device.
  WorkerProcess(std::vector<std::string> words, const std::vector<int>& streams);
  /// Whether more may come.
  bool read_some(std::string& buffer) const;
  bool has_ended();

  int socket_ = -1;
  int pid_ = -1;
  int status_ = -1;
};

/// After a reply whose kind is no small letter the worker is done.
inline bool is_last(char kind) { return kind < 'a'; }

/// The life of a worker: it calls `answer` with the one request that comes through the socket, and ends when
/// its parent, the process of this number, does. `why_not` tells what was thrown, the reply kMessage.
[[noreturn]] void work_for(int socket, int parent, const std::function<void(const std::string&)>& answer,
                           const std::function<std::string()>& why_not);
constexpr char kMessage = 'M';
/// In the worker: so many seconds of processor time are left.
void limit_to(unsigned seconds);
/// In the worker: sends a reply, as a whole, from any thread; without a listener the worker ends.
void send_reply(int socket, char kind, const std::string& text);

}  // namespace delquad
