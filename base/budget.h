#pragma once

#include <atomic>

namespace delquad {

/// What a step may do that could go on for very long: steps of its own work, which are counted, as the same
/// input has to give the same bytes however fast the machine is. Several threads may spend at once; whether
/// all is spent is then asked between parallel loops only.
class Budget {
 public:
  explicit Budget(long long steps) : left_(steps) {}
  void spend(long long steps = 1) noexcept { left_.fetch_sub(steps, std::memory_order_relaxed); }
  long long left() const noexcept { return left_.load(std::memory_order_relaxed); }
  bool is_spent() const noexcept { return left() <= 0; }

 private:
  std::atomic<long long> left_;
};

}  // namespace delquad
