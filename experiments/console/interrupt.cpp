// SPDX-License-Identifier: GPL-3.0-or-later
#include "experiments/console/interrupt.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

#include "base/system.h"
#include "io/mesh_io.h"

namespace delquad {
namespace {

// A signal handler can only speak through variables that outlive every call.
std::atomic<int> sections{0};
std::atomic<int> pending{0};  ///< the signal's number
static_assert(std::atomic<int>::is_always_lock_free);

[[noreturn]] void leave(int signal_number) {
  remove_unfinished_files();
  constexpr char kInterruption[] = "\ninterrupted\n", kTermination[] = "\nterminated\n";
  const bool by_user = signal_number == SIGINT;
  // Nothing is left to do if even this cannot be written.
  [[maybe_unused]] const ssize_t written =
      write(STDERR_FILENO, by_user ? kInterruption : kTermination,
            by_user ? sizeof kInterruption - 1 : sizeof kTermination - 1);
  _exit(by_user ? kInterrupted : kTerminated);
}

void on_signal(int signal_number) {
  pending = signal_number;
  if (sections == 0) leave(signal_number);
}

constexpr int kMostFaces = 2048;  // at a time: twice the most threads

/// Made before main(), so that signal handlers need not make it.
Activities all(kMostFaces);

}  // namespace

void exit_on_interrupt() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

Uninterrupted::Uninterrupted() { ++sections; }
Uninterrupted::~Uninterrupted() {
  if (--sections == 0 && pending != 0) leave(pending);
}

void StageTimes::begin(const std::string& stage, double at) {
  seconds_[stage_] += at - since_;
  stage_ = stage;
  since_ = at;
}

std::string StageTimes::longest(double at) {
  begin(stage_, at);
  const auto& [stage, most] =
      *std::ranges::max_element(seconds_, {}, [](const auto& one) { return one.second; });
  return stage.empty() || stage == stage_ ? "" : fmt::format("; {} took longest: {:.1f} s", stage, most);
}

struct TimeLimit::Watch {
  std::mutex mutex;
  StageTimes stages;
  const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  std::condition_variable over;
  bool is_over = false;
  std::thread thread;
};

TimeLimit::TimeLimit(double seconds) : watch_(std::make_unique<Watch>()) {
  constexpr double kLongest = 1e9;  // seconds, 30 years: the clock counts nanoseconds
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::nanoseconds>(
                                             std::chrono::duration<double>(std::min(seconds, kLongest)));
  watch_->thread = std::thread([watch = watch_.get(), end, seconds] {
    std::unique_lock lock(watch->mutex);
    if (watch->over.wait_until(lock, end, [&] { return watch->is_over; })) return;
    const std::string at = program_activities().text() + watch->stages.longest(watch->seconds());
    if (!abandon_files()) return;
    fmt::print(stderr, "{}error: stopped after {:g} s (--time-limit): {} [time-limit]\n",
               errors_have_a_terminal() ? "\r\x1b[2K" : "", seconds, at);
    _exit(kTimeIsUp);
  });
  program_activities().on_stage = [watch = watch_.get()](const char* stage) {
    const std::lock_guard lock(watch->mutex);
    watch->stages.begin(stage, watch->seconds());
  };
}

TimeLimit::~TimeLimit() {
  program_activities().on_stage = nullptr;
  {
    const std::lock_guard lock(watch_->mutex);
    watch_->is_over = true;
  }
  watch_->over.notify_one();
  watch_->thread.join();
}

Activities& program_activities() { return all; }

}  // namespace delquad
