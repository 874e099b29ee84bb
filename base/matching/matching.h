// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>

#include "delquad/matching.h"

// This header has the solvers of perfect matching. Recombination and numbers of edges use it.

namespace delquad {

/// Makes the primal-dual method [edmonds1965; kolmogorov2009] with trees that grow from all free nodes at
/// once (docs/matching.md). Costs of either sign are allowed up to kMaxMatchingCost, and so are parallel
/// edges; self-loops are ignored. Its solve() throws std::invalid_argument for larger costs, invalid nodes,
/// too many edges, or a total above 64 bits.
std::unique_ptr<MatchingSolver> make_primal_dual_solver();

inline constexpr long long kMaxMatchingCost = 1LL << 60;

/// Makes LEMON's MaxWeightedPerfectMatching, started from the fractional solution. Its thread has a stack for
/// recursion over nested blossoms. Costs must be >= 0, without parallel edges and self-loops. It has no
/// certificate and cannot be cancelled.
std::unique_ptr<MatchingSolver> make_lemon_solver();

}  // namespace delquad
