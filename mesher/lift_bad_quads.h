#pragma once

#include <vector>

#include "mesher/stages.h"

namespace delquad {

/// Quads of a surface may be worse in space than in the plane in which they were treated, and nodes on curves
/// may have to give way: lifts those that are poor in space, see lift_worst_on_surface(). What is inverted,
/// folded or turned away from the model then gets a ring of quads inside, which is lifted again and kept if
/// fewer are bad. Last, quads are merged, and edges turned or opened, around what is bad still or flat, one
/// at a time, and what helps is kept. Patches of quads hold their places in space afterwards. Returns what
/// was done, without the time.
LiftingSummary lift_bad_quads(const AllPatches& in);

}  // namespace delquad
