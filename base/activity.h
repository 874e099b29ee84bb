// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

// This header tells the current stage and faces of a run (context.h). Time limits, progress bars and parent
// processes read it. Scopes cost a few atomic stores and no allocation; outside of runs they do nothing.

namespace delquad {

struct FaceSnapshot;

/// A face that a thread works on.
struct ActiveFace {
  std::string stage, kind;
  int tag = 0;
  double seconds = 0;      ///< wall-clock time
  double cpu_seconds = 0;  ///< processor time of its thread; 0 for another process
};

/// Current stage of a run, and faces of its threads. Any thread may read it.
class Activities {
 public:
  /// `most_faces`, at least 1, limits the faces at work at once; other faces are not recorded.
  explicit Activities(int most_faces);
  ~Activities();
  Activities(const Activities&) = delete;
  Activities& operator=(const Activities&) = delete;

  /// Returns the faces, longest at work first.
  std::vector<ActiveFace> faces() const;
  /// Returns the stage and up to four faces, longest first: "treatment of face 12 (4.2 s), face 3 (0.1 s)".
  std::string text() const;
  /// Writes the same text into `size` > 0 bytes, as far as it fits, with a final zero. Returns its length
  /// without the zero. Signal handlers may call it.
  std::size_t describe(char* text, std::size_t size) const noexcept;
  /// Returns only the faces, for a line that names the stage: "face 12, face 3"; empty: none.
  std::string faces_text() const;
  /// Returns the stage outside of faces; empty: none.
  std::string stage() const;

  /// Clears everything in a forked process, where scopes never end.
  void clear();

  /// Called by each thread when it starts (`begins`) and ends a face. Set it before the work starts; may be
  /// empty.
  std::function<void(int tag, bool begins)> on_face;
  /// Called when a stage outside of faces starts.
  std::function<void(const char* name)> on_stage;

 private:
  friend class StageScope;
  friend class FaceScope;
  friend class RemoteFaceScope;
  struct Entry;
  int take_entry(int tag, const char* kind, const char* stage, bool is_of_this_thread);
  void release(int entry);
  int longest(std::size_t most, FaceSnapshot* first) const;

  std::atomic<const char*> stage_{nullptr};
  std::atomic<long long> since_{0};  ///< nanoseconds of the clock
  std::vector<Entry> entries_;
};

/// Scope of a stage: of this thread's face or, outside of faces, of the whole run.
class StageScope {
 public:
  /// `name` must outlive the activities of the run.
  explicit StageScope(const char* name);
  ~StageScope();
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  std::atomic<const char*>* name_;  ///< null: not recorded
  const char* before_ = nullptr;
};

/// Scope of a face or region, with its tag in the mesh, that this thread works on.
class FaceScope {
 public:
  /// `kind`, such as "region", must outlive the activities of the run.
  explicit FaceScope(int tag, const char* kind = "face");
  ~FaceScope();
  FaceScope(const FaceScope&) = delete;
  FaceScope& operator=(const FaceScope&) = delete;

 private:
  Activities* activities_;
  int tag_, entry_ = -1, before_ = -1;
};

/// Scope of a face that another process works on for this thread's run. `stage` must outlive the activities.
class RemoteFaceScope {
 public:
  RemoteFaceScope(int tag, const char* stage);
  ~RemoteFaceScope();
  RemoteFaceScope(const RemoteFaceScope&) = delete;
  RemoteFaceScope& operator=(const RemoteFaceScope&) = delete;

 private:
  Activities* activities_;
  int entry_ = -1;
};

}  // namespace delquad
