#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>

namespace delquad {

/// Ranges of this many items are worked on as one, so that what a block collects does not depend on the
/// number of threads.
inline constexpr std::size_t kBlock = 1024;

inline std::size_t n_blocks(std::size_t n) { return (n + kBlock - 1) / kBlock; }
inline std::size_t block_of(std::size_t begin) { return begin / kBlock; }

/// Calls work(begin, end) for each block of 0 .. n - 1, in parallel.
template <class Work>
void parallel_blocks(std::size_t n, Work work) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n_blocks(n)), [&](const auto& blocks) {
    for (std::size_t i = blocks.begin(); i < blocks.end(); ++i)
      work(i * kBlock, std::min(n, (i + 1) * kBlock));
  });
}

}  // namespace delquad
