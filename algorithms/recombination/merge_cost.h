// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>

#include "algorithms/recombination/dual_graph.h"
#include "delquad/extend.h"

// This header has costs of matching that were registered from outside. Recombination and the check of options
// use it.

namespace delquad {

/// Gives the interior sides of a dual graph other costs.
using AddedCost = std::function<void(const TriPatch& tri, DualGraph& dual)>;

/// Returns the cost that add_merge_cost() added under a known name, for a patch; null for "eta". Throws Error
/// if its factory returns none. The cost throws Error for values outside [0, 3].
AddedCost added_cost(const std::string& name, const StageInput& in);

}  // namespace delquad
