// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/python/problem.h"

#include <algorithm>
#include <span>
#include <thread>
#include <utility>

#include "base/located.h"
#include "delquad/error.h"
#include "program/python/arrays.h"

namespace delquad::python {

namespace py = pybind11;

void CallingThread::run(const std::function<void(std::stop_token)>& work) {
  std::exception_ptr thrown;
  {
    const py::gil_scoped_release released;
    const std::jthread worker([&] {
      try {
        work(stop_.get_token());
      } catch (...) {
        thrown = std::current_exception();
      }
      const Lock lock(mutex_);
      done_ = true;
      changed_.notify_all();
    });
    Lock lock(mutex_);
    wait(lock);
  }
  if (failure_) std::rethrow_exception(failure_);
  if (thrown) std::rethrow_exception(thrown);
}

void CallingThread::wait(Lock& lock) {
  while (!done_) {
    changed_.wait_for(lock, kPatience, [&] { return done_ || callback_ != nullptr; });
    if (callback_ != nullptr)
      serve(lock);
    else if (!done_ && !failure_)
      look_for_signals(lock);
  }
}

void CallingThread::serve(Lock& lock) {
  const std::function<void()>& callback = *callback_;
  lock.unlock();
  std::exception_ptr failure;
  {
    const py::gil_scoped_acquire acquired;
    try {
      callback();
    } catch (...) {
      failure = std::current_exception();
    }
  }
  lock.lock();
  if (failure) fail(failure);
  callback_ = nullptr;
  changed_.notify_all();
}

void CallingThread::look_for_signals(Lock& lock) {
  lock.unlock();
  std::exception_ptr failure;
  {
    const py::gil_scoped_acquire acquired;
    if (PyErr_CheckSignals() != 0) failure = std::make_exception_ptr(py::error_already_set());
  }
  lock.lock();
  if (failure) fail(failure);
}

void CallingThread::fail(std::exception_ptr failure) {
  if (!failure_) failure_ = std::move(failure);
  stop_.request_stop();
}

void CallingThread::call(const std::function<void()>& callback) {
  Lock lock(mutex_);
  if (!failure_) {
    callback_ = &callback;
    changed_.notify_all();
    changed_.wait(lock, [&] { return callback_ == nullptr; });
  }
  // The exception itself stays in Python's thread.
  if (failure_) throw Cancelled("a callback failed, or the work was interrupted");
}

namespace {

/// Adapts a Python function to batches of points; `what` names it in messages.
template <class V>
std::function<void(std::span<const V>, std::span<double>)> as_function(const py::object& function,
                                                                       CallingThread& python,
                                                                       const std::string& what) {
  if (function.is_none()) return {};
  return [&function, &python, what](std::span<const V> points, std::span<double> values) {
    python.call([&] {
      read_values(function(points_for_python(points)), values.data(), values.size(), "the result of " + what);
    });
  };
}

/// Adapts a metric function: `read` converts its result to vectors or tensors, `make` each of these to a
/// tensor.
template <class Point, class Tensor, class Read, class Make>
auto as_metric(const py::object& function, CallingThread& python, Read read, Make make) {
  return [&function, &python, read, make](std::span<const Point> points, std::span<Tensor> metric) {
    if (points.empty()) return;
    python.call([&] {
      const auto made = read(function(points_for_python(points)), "the result of the metric function");
      if (made.size() != metric.size())
        refuse("the metric function returned {} tensors for {} points: expected one for each", made.size(),
               metric.size());
      std::ranges::transform(made, metric.begin(), make);
    });
  };
}

}  // namespace

std::shared_ptr<Result> as_result(MeshResult made) {
  auto result = std::make_shared<Result>();
  result->rest = std::move(made);
  result->expected_quads = result->rest.prepared->size.expected_quads;
  result->rest.prepared = {};
  static_cast<Mesh&>(*result) = std::move(result->rest.mesh);
  return result;
}

std::shared_ptr<Result> mesh(MeshProblem problem, const Callbacks& callbacks, const std::string& word,
                             int threads, double time_limit) {
  CallingThread python;
  if (!callbacks.size.is_none())
    problem.size.function = as_function<Vec3>(callbacks.size, python, "the size function");
  if (!callbacks.cross.is_none())
    problem.cross.function = as_function<Vec2>(callbacks.cross, python, "the cross function");
  const bool is_planar = std::holds_alternative<PlanarModel>(problem.model) ||
                         std::holds_alternative<LineModel>(problem.model) ||
                         std::holds_alternative<GivenMesh>(problem.model);
  if (!callbacks.metric.is_none() && is_planar)
    problem.metric.function = as_metric<Vec2, Tensor2>(
        callbacks.metric, python, [](const auto&... given) { return read_points(given...); },
        [](const Vec3& m) {
          return Tensor2{m.x, m.y, m.z};
        });
  else if (!callbacks.metric.is_none())
    problem.metric.in_space = as_metric<Vec3, Tensor3>(
        callbacks.metric, python, [](const auto&... given) { return read_tensors(given...); },
        [](const Tensor3& m) { return m; });
  Context context;
  context.threads = threads;
  context.time_limit = time_limit;
  if (!callbacks.progress.is_none())
    context.progress = [&](const ProgressReport& report) {
      python.call([&] { callbacks.progress(report.stage, report.part); });
    };
  std::shared_ptr<Result> result;
  python.run([&](std::stop_token cancel) {
    context.cancel = std::move(cancel);
    result = as_result(delquad::mesh(std::move(problem), word, context));
  });
  return result;
}

}  // namespace delquad::python
