#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <stop_token>

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

}  // namespace delquad::python
