// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <cstddef>
#include <span>
#include <vector>

// This header orients elements so that neighbors agree. Surfaces, CAD and given meshes use it.

namespace delquad {

/// Two that agree as they are, or else where one of them is turned over.
struct Neighbours {
  int a, b;
  bool agree;
  auto operator<=>(const Neighbours&) const = default;
};

struct Turned {
  std::vector<char> is_turned;           ///< over, so that neighbors agree
  std::vector<std::vector<int>> pieces;  ///< of neighbors, by their first, which is not turned over
  int clash = -1;                        ///< neighbors that cannot agree, as on a Moebius strip; -1: none
};

/// Returns which of `n` elements or faces are to be turned over.
Turned turn_to_agree(std::size_t n, std::span<const Neighbours> neighbours);

}  // namespace delquad
