#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "algorithms/regularity/local_fill.h"

namespace delquad::across {

/// A polygon of a cavity that was filled.
struct Filled {
  int patch;
  std::vector<int> elements;
  std::vector<Change> changes;
  Rim rim;
  std::unique_ptr<LocalFill> fill;
};

/// Holds the results of a visit of a vertex. They hold as long as the patches that were looked at stay.
struct Visited {
  std::vector<int> looked_at;
  std::vector<std::uint64_t> lost;  ///< candidates that were tried
  long long tried = 0;
  int gain = 0;               ///< irregular vertices less
  std::vector<Filled> parts;  ///< none: nothing was found
};

/// Seeks cavities around an irregular vertex, and fills them.
Visited visit(const Shared& shared, Searches& searches, int patch, int vertex);

}  // namespace delquad::across
