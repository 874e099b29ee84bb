#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>

#include "geometry/cad/cad_request.h"

namespace delquad::cad {

/// The program that works on CAD files: what DELQUAD_CAD_WORKER names, else what set_cad_worker() was given,
/// else delquad-cad beside the running program, or where it was installed. Throws InputError, naming the
/// places, when it is not there.
std::filesystem::path find_worker();

/// A process of that program, which has neither standard output nor error nor any file of this one's, and
/// which a signal of the terminal does not reach. It ends with this object, and when this process dies.
/// Nothing of this process is changed: no fork, no signal handler. Throws InputError when it cannot be
/// started.
class WorkerProcess {
 public:
  WorkerProcess();
  ~WorkerProcess();
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// Sends the request and calls `hear` with each reply, until the last one has come or the process has
  /// ended. Throws Cancelled.
  void ask(const CadRequest& request, const std::function<void(Reply, const std::string&)>& hear);

 private:
  /// Whether more may come.
  bool read_some(std::string& buffer) const;
  bool has_ended();

  int socket_ = -1;
  pid_t pid_ = -1;
};

/// In the worker: sends a reply, as a whole, from any thread; without a listener the worker ends.
void send_reply(int socket, Reply reply, const std::string& text);
/// In the worker: the request that comes first.
CadRequest receive_request(int socket);

}  // namespace delquad::cad
