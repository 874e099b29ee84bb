#pragma once

#include <algorithm>
#include <cstddef>

#include "base/parallel.h"

namespace delquad {

/// So many items are one piece of work, whatever the number of threads, so that what pieces collect does not
/// depend on it.
inline constexpr std::size_t kBlock = 2048;

inline std::size_t n_blocks(std::size_t n) { return (n + kBlock - 1) / kBlock; }

/// Calls work(begin, end) for each block of [0, n), in parallel. See parallel_for().
template <class Work>
void parallel_blocks(std::size_t n, Work work) {
  parallel_for(n_blocks(n), [&](std::size_t i) { work(i * kBlock, std::min(n, (i + 1) * kBlock)); });
}

}  // namespace delquad
