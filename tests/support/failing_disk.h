// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace delquad::testing_support {

/// While one lives, files of this process and its children are on a disk that fails. Writing, changing the
/// length, flushing and closing of regular files go through failing_disk.cpp, which a program gets by being
/// linked with it.
class FailingDisk {
 public:
  /// Takes so many bytes in all, then is full (ENOSPC).
  static FailingDisk full_after(long long bytes) { return {bytes, 0}; }
  /// The n-th call from 1, and no other, fails as if a quota were used up (EDQUOT).
  static FailingDisk failing_at(long long call) { return {-1, call}; }
  /// Only counts.
  static FailingDisk sound() { return {-1, 0}; }
  ~FailingDisk();
  FailingDisk(const FailingDisk&) = delete;
  FailingDisk& operator=(const FailingDisk&) = delete;
  /// Since it was made.
  long long calls() const;
  long long bytes() const;

 private:
  FailingDisk(long long room, long long call);
};

}  // namespace delquad::testing_support
