// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>

#include "delquad/mesher.h"

// This header turns Python's arguments into problems. The Python module uses it.

namespace delquad::python {

/// Python's thread, waiting for work in another thread. It runs callbacks and notices Ctrl-C, which Python
/// reports only to its main thread. The GIL is released otherwise.
class CallingThread {
 public:
  /// Runs `work` and waits for it. Call it with the GIL. Exceptions of callbacks and signals take precedence
  /// over exceptions of the work.
  void run(const std::function<void(std::stop_token)>& work);

  /// Calls `callback` from the work, in Python's thread with the GIL. Throws its exceptions.
  void call(const std::function<void()>& callback);

 private:
  using Lock = std::unique_lock<std::mutex>;
  /// Longest delay of Ctrl-C.
  static constexpr std::chrono::milliseconds kPatience{50};

  void wait(Lock& lock);
  void serve(Lock& lock);
  void look_for_signals(Lock& lock);
  void fail(std::exception_ptr failure);

  std::mutex mutex_;
  std::condition_variable changed_;
  const std::function<void()>* callback_ = nullptr;  ///< callback that the work waits for
  std::exception_ptr failure_;                       ///< first exception of a callback or signal
  std::stop_source stop_;
  bool done_ = false;
};

namespace py = pybind11;

/// A model in Python: a problem that may lack a size.
struct ModelHandle {
  MeshProblem problem;
};

/// Reads any model file of the command line. Throws InputError with file and line.
ModelHandle read_model(const std::string& path);

/// Registers models and their parts.
void define_models(py::module_& m);

/// Registers add_metric(), add_stage() and similar functions.
void define_parts(py::module_& m);
/// Registers run(), the program.
void define_program(py::module_& m);

/// Registers adapt() and its parts.
void define_adapt(py::module_& m);

/// Functions of a problem, called in Python's thread while it is meshed.
struct Callbacks {
  py::object size, metric, cross, progress;  ///< None: not given
};

/// A mesh and its report.
struct Result : Mesh {
  MeshResult rest;  ///< without the mesh and its origin
  double expected_quads = 0;
};

std::shared_ptr<Result> as_result(MeshResult result);

/// Meshes a problem, with the GIL released. `threads` and `time_limit` (seconds) are as in Context. Throws as
/// delquad::mesh().
std::shared_ptr<Result> mesh(MeshProblem problem, const Callbacks& callbacks, const std::string& word,
                             int threads, double time_limit);

}  // namespace delquad::python
