#pragma once

#include "geometry/surface/compound.h"

namespace delquad {

/// The model without what is smaller than `length`:
/// - holes of a shorter outline are closed, see close_small_holes();
/// - a face narrower than that (twice its area by the length of its outline) becomes part of the neighbour
/// with
///   which it shares the longest curves; that one keeps its tag and names;
/// - a shorter curve becomes one with a curve that it continues (merge_short_curves);
/// - of other shorter curves, both ends become one point, where the surface stays what it is by that.
/// Warnings name each of these, and the short curves that stay. Throws InputError for a length that is not
/// below the model's diagonal.
SurfaceModel ignore_small(SurfaceModel model, double length, const CompoundOptions& options = {});

}  // namespace delquad
