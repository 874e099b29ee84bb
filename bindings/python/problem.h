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

namespace delquad::python {

/// Python's thread, which waits for work that is done in another one: meanwhile it runs callbacks, and sees
/// Ctrl-C, which Python shows to its main thread only. The GIL is released but for that.
class CallingThread {
 public:
  /// Runs `work` and returns when it is done. To be called with the GIL. What callbacks throw and a signal's
  /// exception count before what the work then throws.
  void run(const std::function<void(std::stop_token)>& work);

  /// From the work: calls `callback` in Python's thread, with the GIL, and throws what it throws.
  void call(const std::function<void()>& callback);

 private:
  using Lock = std::unique_lock<std::mutex>;
  /// How long Ctrl-C may go unnoticed.
  static constexpr std::chrono::milliseconds kPatience{50};

  void wait(Lock& lock);
  void serve(Lock& lock);
  void look_for_signals(Lock& lock);
  void fail(std::exception_ptr failure);

  std::mutex mutex_;
  std::condition_variable changed_;
  const std::function<void()>* callback_ = nullptr;  ///< that the work waits for
  std::exception_ptr failure_;                       ///< of a callback or signal, the first
  std::stop_source stop_;
  bool done_ = false;
};

namespace py = pybind11;

/// What Python calls a model: a problem that may yet lack a size.
struct ModelHandle {
  MeshProblem problem;
};

/// A model file of any kind that the command line knows.
ModelHandle read_model(const std::string& path);

/// Tells Python of models and of what they are made of.
void define_models(py::module_& m);

/// add_metric(), add_stage() and their like.
void define_parts(py::module_& m);
/// run(): the program.
void define_program(py::module_& m);

/// adapt(), and what it is made of.
void define_adapt(py::module_& m);

/// Functions that a problem calls; they are called in the thread that is there while it is meshed.
struct Callbacks {
  py::object size, metric, cross, progress;  ///< None: not given
};

/// A mesh and all that is known of it.
struct Result : Mesh {
  MeshResult rest;  ///< its mesh is empty, and what it was made of
  double expected_quads = 0;
};

std::shared_ptr<Result> as_result(MeshResult result);

/// Meshes a problem, with the GIL released.
std::shared_ptr<Result> mesh(MeshProblem problem, const Callbacks& callbacks, const std::string& word,
                             int threads, double time_limit);

}  // namespace delquad::python
