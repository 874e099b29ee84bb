// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "base/parallel.h"

// This header divides work into blocks. The files of this folder use it.

namespace delquad {

/// Items of one block. It does not depend on the number of threads, so neither do results.
inline constexpr std::size_t kBlock = 2048;

/// Returns the number of blocks of n items.
inline std::size_t n_blocks(std::size_t n) { return (n + kBlock - 1) / kBlock; }

/// Calls work(begin, end) for each block of [0, n) in parallel, see parallel_for().
template <class Work>
void parallel_blocks(std::size_t n, Work work) {
  parallel_for(n_blocks(n), [&](std::size_t i) { work(i * kBlock, std::min(n, (i + 1) * kBlock)); });
}

/// Returns the sum of term(i) over [0, n), summed up in each block, then over the blocks, in order.
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
