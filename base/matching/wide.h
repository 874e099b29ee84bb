// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>

#include "delquad/matching.h"

// This header has integers of 128 bits. The solvers of matching use it.

namespace delquad {

/// Integer of 128 bits for arithmetic.
__extension__ typedef __int128 Wide;

inline Wide wide(const WideInteger& i) { return Wide{i.high} * (Wide{1} << 64) + i.low; }
inline WideInteger narrow(Wide i) {
  return {static_cast<std::int64_t>(i >> 64), static_cast<std::uint64_t>(i)};
}

}  // namespace delquad
