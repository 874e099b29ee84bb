// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <atomic>

// This header limits the work of a search. Searches whose time has no other bound use it.

namespace delquad {

/// Limit of work for a step that could run very long. It counts steps, not time, so the same input gives the
/// same bytes on any machine. Several threads may spend at once. Ask only between parallel loops whether it
/// is spent.
class Budget {
 public:
  /// Begins with this number of steps, >= 0; left() is negative once they are overspent.
  explicit Budget(long long steps) : left_(steps) {}
  void spend(long long steps = 1) noexcept { left_.fetch_sub(steps, std::memory_order_relaxed); }
  long long left() const noexcept { return left_.load(std::memory_order_relaxed); }
  bool is_spent() const noexcept { return left() <= 0; }

 private:
  std::atomic<long long> left_;
};

}  // namespace delquad
