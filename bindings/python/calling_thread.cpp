#include "bindings/python/calling_thread.h"

#include <pybind11/pybind11.h>

#include <thread>

#include "delquad/error.h"

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
  // The exception itself stays with Python's thread.
  if (failure_) throw Cancelled("a callback failed, or the work was interrupted");
}

}  // namespace delquad::python
