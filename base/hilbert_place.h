// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

// This header numbers cells along a Hilbert curve. Blocks of meshes and recombination use it.

namespace delquad {

/// Returns the position of cell (x, y), both below 2^16, along a Hilbert curve through 2^16 x 2^16 cells. The
/// formula is own: it has no branches, as they would be mispredicted half of the time.
inline std::uint32_t hilbert_place(std::uint32_t x, std::uint32_t y) {
  std::uint32_t place = 0;
  for (int bit = 15; bit >= 0; --bit) {
    const std::uint32_t right = x >> bit & 1, upper = y >> bit & 1;
    place = 4 * place + ((3 * right) ^ upper);
    // The curve enters the two lower quarters turned: normalize them.
    const std::uint32_t lower = upper - 1, turn = lower & (0 - right);
    const std::uint32_t swap = (x ^ y) & lower;
    x ^= swap ^ turn;
    y ^= swap ^ turn;
  }
  return place;
}

}  // namespace delquad
