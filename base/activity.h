#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

// What a run (see context.h) is at, for those who look at it from outside: a time limit, the progress bar, a
// process that waits for another. Work says so by scopes, which cost a few atomic stores and allocate
// nothing; outside of runs nobody is told.

namespace delquad {

struct SeenFace;

/// A face that some thread is at.
struct FaceAtWork {
  std::string stage, kind;
  int tag = 0;
  double seconds = 0;      ///< on the clock
  double cpu_seconds = 0;  ///< of its thread; 0 for one of another process
};

/// The stage that a run is at, and the faces that its threads are at. Safe to read from any thread.
class Activities {
 public:
  /// `most_faces`: at a time; of further ones is not told.
  explicit Activities(int most_faces);
  ~Activities();
  Activities(const Activities&) = delete;
  Activities& operator=(const Activities&) = delete;

  /// The faces, those longest at work first.
  std::vector<FaceAtWork> faces() const;
  /// The stage, and the faces in it, longest at it first: "treatment of face 12 (4.2 s), face 3 (0.1 s)".
  std::string text() const;
  /// The same as characters, as many as fit, ended by a zero; safe in signal handlers. Returns how many.
  std::size_t describe(char* text, std::size_t size) const noexcept;
  /// Just the faces, for a line that names the stage already: "face 12, face 3"; empty where there are none.
  std::string faces_text() const;
  /// The stage outside of faces; empty: none.
  std::string stage() const;

  /// Forgets all, in a process just forked, where nobody comes to the end of the scopes.
  void clear();

  /// Called by each thread as it begins (`begins`) and ends a face. Set before the work begins; may be empty.
  std::function<void(int tag, bool begins)> on_face;
  /// The same for stages outside of faces, as they begin.
  std::function<void(const char* name)> on_stage;

 private:
  friend class DoingStage;
  friend class DoingFace;
  friend class FaceElsewhere;
  struct Entry;
  int take_entry(int tag, const char* kind, const char* stage, bool is_of_this_thread);
  void release(int entry);
  int longest(std::size_t most, SeenFace* first) const;

  std::atomic<const char*> stage_{nullptr};
  std::atomic<long long> since_{0};  ///< nanoseconds of the clock
  std::vector<Entry> entries_;
};

/// The stage from here to the end of the scope: of the face that this thread works on or, outside of faces,
/// of the whole run.
class DoingStage {
 public:
  /// `name` must live as long as the run's activities.
  explicit DoingStage(const char* name);
  ~DoingStage();
  DoingStage(const DoingStage&) = delete;
  DoingStage& operator=(const DoingStage&) = delete;

 private:
  std::atomic<const char*>* name_;  ///< null: nobody is told
  const char* before_ = nullptr;
};

/// The face that this thread works on from here to the end of the scope.
class DoingFace {
 public:
  /// `kind`, such as "region", must live as long as the run's activities.
  explicit DoingFace(int tag, const char* kind = "face");
  ~DoingFace();
  DoingFace(const DoingFace&) = delete;
  DoingFace& operator=(const DoingFace&) = delete;

 private:
  Activities* activities_;
  int tag_, entry_ = -1, before_ = -1;
};

/// A face that another process works on for this thread's run, as long as it lives.
class FaceElsewhere {
 public:
  FaceElsewhere(int tag, const char* stage);
  ~FaceElsewhere();
  FaceElsewhere(const FaceElsewhere&) = delete;
  FaceElsewhere& operator=(const FaceElsewhere&) = delete;

 private:
  Activities* activities_;
  int entry_ = -1;
};

}  // namespace delquad
