#pragma once

namespace delquad {

/// Exit code after Ctrl-C.
inline constexpr int kInterrupted = 130;

/// From now on SIGINT and SIGTERM end the program at once with kInterrupted, unless an Uninterrupted lives:
/// then as soon as the last of them dies.
void exit_on_interrupt();

/// While files are written that belong together.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

}  // namespace delquad
