#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

// What the program is at, for those who look at it from outside: a time limit, the progress bar, a process
// that waits for another. Work says so by scopes, which cost a few atomic stores and allocate nothing.

namespace delquad {

/// The stage from here to the end of the scope: of the face that this thread works on or, outside of faces,
/// of the whole program.
class DoingStage {
 public:
  /// `name` must live as long as the program.
  explicit DoingStage(const char* name);
  ~DoingStage();
  DoingStage(const DoingStage&) = delete;
  DoingStage& operator=(const DoingStage&) = delete;

 private:
  std::atomic<const char*>& name_;
  const char* before_;
};

/// The face that this thread works on from here to the end of the scope.
class DoingFace {
 public:
  /// `kind`, such as "region", must live as long as the program.
  explicit DoingFace(int tag, const char* kind = "face");
  ~DoingFace();
  DoingFace(const DoingFace&) = delete;
  DoingFace& operator=(const DoingFace&) = delete;

 private:
  int entry_, before_;
};

/// A face that some thread is at.
struct FaceAtWork {
  std::string stage, kind;
  int tag = 0;
  double seconds = 0;      ///< on the clock
  double cpu_seconds = 0;  ///< of its thread; 0 for a thread of another process
};

/// What all threads of the program and of its child processes are at, those longest at it first.
std::vector<FaceAtWork> faces_at_work();
/// The stage, and the faces in it, longest at it first: "treatment of face 12 (4.2 s), face 3 (0.1 s)".
std::string doing();
/// The same as characters, as many as fit, ended by a zero; safe in signal handlers. Returns how many.
std::size_t describe_doing(char* text, std::size_t size) noexcept;
/// Just the faces, for a line that names the stage already: "face 12, face 3"; empty where there are none.
std::string faces_doing();

/// In a process just forked: it is not to be seen by its parent, nor to see what that one is at.
void start_own_activities();
/// Drops what a child process was at that did not come to the end of its scopes.
void forget_activities(pid_t process);

}  // namespace delquad
