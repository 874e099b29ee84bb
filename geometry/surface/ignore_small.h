#pragma once

#include "geometry/surface/compound.h"
#include "geometry/surface/surface_model.h"

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

/// The model without holes of which the outline is shorter than `length`: where it bounds nothing else, or
/// leads into a tube or a pocket. A tube is a group of faces that hang together, all of whose outlines are so
/// short, and whose area is not much more than that of a tube of such a girth and their extent; it goes. The
/// hole is closed by triangles of the face around it. What has several faces around it stays. Warnings name
/// each hole.
SurfaceModel close_small_holes(SurfaceModel model, double length);

/// Cuts faces where they become narrower than `length` for a while. What is so narrow becomes faces of their
/// own, behind the others. Returns for each face the one that it was a part of.
std::vector<int> cut_narrow_parts(SurfaceModel& model, double length);

}  // namespace delquad
