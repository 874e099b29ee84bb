// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/parallel.h"

// This header collects items in parallel, in the same order for any number of threads. Matching and meshes
// use it.

namespace delquad {

/// Calls `make(begin, end, items)` by parallel_for() for ranges of 8192 (the last may be shorter) that cover
/// [0, n); it appends the items of its range. Returns all items in the order of ranges.
template <class Item, class Make>
std::vector<Item> parallel_collect(std::size_t n, const Make& make) {
  constexpr std::size_t kLength = 8192;
  std::vector<std::vector<Item>> parts((n + kLength - 1) / kLength);
  parallel_for(parts.size(),
               [&](std::size_t i) { make(i * kLength, std::min(n, (i + 1) * kLength), parts[i]); });
  std::vector<std::size_t> first = {0};
  for (const auto& part : parts) first.push_back(first.back() + part.size());
  std::vector<Item> all(first.back());
  parallel_for(parts.size(), [&](std::size_t i) {
    std::ranges::copy(parts[i], all.begin() + static_cast<std::ptrdiff_t>(first[i]));
    parts[i] = {};
  });
  return all;
}

}  // namespace delquad
