// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/regularity/local_fill.h"

// This header has the result of a visit of a vertex. Stage Q across curves uses it.

namespace delquad::across {

/// A filled polygon of a cavity.
struct Filled {
  int patch;
  std::vector<int> elements;
  std::vector<Change> changes;
  Rim rim;
  std::unique_ptr<LocalFill> fill;
};

/// Results of a visit of a vertex, valid as long as the patches in `looked_at` do not change.
struct Visited {
  std::vector<int> looked_at;
  std::vector<std::uint64_t> lost;  ///< tried candidates
  long long tried = 0;
  int gain = 0;               ///< removed irregular vertices
  std::vector<Filled> parts;  ///< empty: nothing was found
};

/// Searches cavities around an irregular vertex and fills them.
Visited visit(const Shared& shared, SearchPool& searches, int patch, int vertex);

}  // namespace delquad::across
