#pragma once

#include <vector>

#include "geometry/planar/planar_model.h"
#include "patches/prepared.h"

namespace delquad {

/// Gives patches that are to be grids theirs. In the plane, and in the parameter plane of a surface, nodes
/// come from transfinite interpolation; on a surface also from that in space, each in the nearest point of
/// the patch, and the one whose quads are better in space in the mean counts. Where it would fold, and of
/// three sides always, it is smoothed. Patches that were not asked for stay free where that does not pay. On
/// a planar domain the nodes on the sides of those that were stay from then on. Throws InputError, with the
/// place, where a named one would fold.
void add_grids(const MappedSpec& spec, const std::vector<MappedPatch>& mapped, PreparedProblem& p);

}  // namespace delquad
