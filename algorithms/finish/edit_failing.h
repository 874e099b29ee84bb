#pragma once

#include <cstddef>

#include "patches/places_inside.h"

namespace delquad {

/// Edits a patch's quads around those that fail in space, by is_beyond_asked() with sides over `size` or by
/// kAskedWarp: of the rotations, collapses, openings and splits there the one that leaves the fewest of those
/// around failing once its vertices have settled in the plane, where these are fewer and that costs not too
/// much of their eta. Nodes of the boundary stay. Returns how many edits were made.
int edit_failing(const AllPatches& in, std::size_t patch, const SizeField& size);

}  // namespace delquad
