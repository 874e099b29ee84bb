#pragma once

#include <functional>
#include <string>

#include "algorithms/recombination/dual_graph.h"
#include "delquad/extend.h"

namespace delquad {

/// Gives the interior sides of a dual graph other costs.
using AddedCost = std::function<void(const TriPatch& tri, DualGraph& dual)>;

/// The cost that add_merge_cost() has added by that name, for a patch; null for "eta". What it returns throws
/// an Error that names the cost where one of its values is not from 0 to 3.
AddedCost added_cost(const std::string& name, const StageInput& in);

}  // namespace delquad
