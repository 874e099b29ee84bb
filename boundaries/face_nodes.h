#pragma once

#include <vector>

#include "boundaries/across_view.h"
#include "boundaries/curve_nodes.h"

namespace delquad {

/// Moves nodes along their curves so that those on both sides of a narrow place lie opposite each other, as
/// far as their numbers allow; elsewhere edges stay of equal integrals, and between the two they change
/// gradually. Ends of curves stay. `group` is group_facing_curves().
CurvePlaces face_nodes(const Mesh& fine, const std::vector<CurveChain>& chains, const AcrossView& across,
                       const std::vector<SizeIntegral>& integrals, const std::vector<int>& counts,
                       const std::vector<int>& group, const SizeOnLine& size);

}  // namespace delquad
