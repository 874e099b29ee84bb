#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

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

/// The sum of term(i) over [0, n): of each block in its order, then of the blocks in theirs.
template <class Term>
double sum_of_blocks(std::size_t n, Term term) {
  std::vector<double> sums(n_blocks(n));
  parallel_blocks(n, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += term(i);
    sums[begin / kBlock] = sum;
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace delquad
