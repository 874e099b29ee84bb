// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>

#include "base/parallel.h"

// This header has parallel loops over items of about equal cost. Curved elements, sweeps and the pipeline use
// it.

namespace delquad {

/// Calls work(i) for each i in [0, n), by parallel_ranges(), for many calls of about equal cost.
template <class Work>
void parallel_each(std::size_t n, const Work& work) {
  parallel_ranges(n, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

}  // namespace delquad
