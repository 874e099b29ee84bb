#pragma once

#include <memory>

#include "delquad/matching.h"

namespace delquad {

/// The primal-dual method with trees that grow from all free nodes at once (docs/matching.md). Costs of
/// either sign up to kMaxMatchingCost; parallel edges are allowed, self-loops ignored. Throws
/// std::invalid_argument for larger costs, a node that is none, too many edges, or a total that 64 bits
/// cannot hold.
std::unique_ptr<MatchingSolver> make_primal_dual_solver();

inline constexpr long long kMaxMatchingCost = 1LL << 60;

/// LEMON's MaxWeightedPerfectMatching, started from the fractional solution, on a thread with a stack that is
/// large enough for its recursion over nested blossoms. Costs must be >= 0, without parallel edges and
/// self-loops. It has no certificate.
std::unique_ptr<MatchingSolver> make_lemon_solver();

}  // namespace delquad
