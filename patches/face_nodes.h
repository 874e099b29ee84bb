#pragma once

#include <vector>

#include "base/budget.h"
#include "patches/across_view.h"
#include "patches/curve_nodes.h"

namespace delquad {

/// Moves nodes along their curves so that those on both sides of a narrow place lie opposite each other, as
/// far as their numbers allow; elsewhere edges stay of equal integrals, and between the two they change
/// gradually. Ends of curves stay. `group` is group_facing_curves(). Each look from a node takes of the
/// `steps`; once these are spent, nodes stay where they are.
CurvePlaces face_nodes(const Mesh& fine, const std::vector<CurveChain>& chains, const AcrossView& across,
                       const std::vector<SizeIntegral>& integrals, const std::vector<int>& counts,
                       const std::vector<int>& group, const SizeOnLine& size, Budget& steps);

}  // namespace delquad
