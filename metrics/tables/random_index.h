#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>

namespace delquad {

/// Whole numbers below n, the same with every compiler and library, unlike the standard's distributions.
class RandomIndex {
 public:
  explicit RandomIndex(std::uint64_t seed) : random_(seed) {}
  std::size_t operator()(std::size_t n) {
    const double part = std::ldexp(static_cast<double>(random_() >> 11), -53);
    return static_cast<std::size_t>(part * static_cast<double>(n));
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace delquad
