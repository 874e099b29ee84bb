#include "pipeline/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace delquad {
namespace {

// A signal handler can only speak through variables that outlive every call.
std::atomic<int> sections{0};
std::atomic<bool> pending{false};
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<bool>::is_always_lock_free);

[[noreturn]] void leave() {
  constexpr char kMessage[] = "\ninterrupted\n";
  // Nothing is left to do if even this cannot be written.
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  _exit(kInterrupted);
}

void on_signal(int) {
  pending = true;
  if (sections == 0) leave();
}

}  // namespace

void exit_on_interrupt() {
  struct sigaction action = {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

Uninterrupted::Uninterrupted() { ++sections; }
Uninterrupted::~Uninterrupted() {
  if (--sections == 0 && pending) leave();
}

}  // namespace delquad
