#pragma once

#include <cstdint>

namespace delquad {

/// Random numbers that are the same with every library: SplitMix64, whose state is a counter.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Equally likely from `low` up to, not with, `high`.
  double between(double low, double high) {
    constexpr double kStep = 1.0 / (std::uint64_t{1} << 53);
    return low + (high - low) * (static_cast<double>(next() >> 11) * kStep);
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace delquad
