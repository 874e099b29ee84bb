// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <compare>
#include <cstddef>
#include <span>
#include <vector>

// This header orients elements so that neighbors agree. Surfaces, CAD and given meshes use it.

namespace delquad {

/// Two neighbors (indices); unless they agree, exactly one of them must be reversed.
struct Neighbours {
  int a, b;
  bool agree;
  auto operator<=>(const Neighbours&) const = default;
};

struct Turned {
  std::vector<char> is_turned;           ///< which are reversed, so that neighbors agree
  std::vector<std::vector<int>> pieces;  ///< connected pieces; the first of each is not reversed
  int clash = -1;  ///< index of neighbors that cannot agree, as on a Moebius strip; -1: none
};

/// Returns which of `n` elements or faces must be reversed.
Turned turn_to_agree(std::size_t n, std::span<const Neighbours> neighbours);

}  // namespace delquad
