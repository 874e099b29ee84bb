#pragma once

#include "geometry/surface/surface_model.h"

namespace delquad {

/// The model without holes of which the outline is shorter than `length`: where it bounds nothing else, or
/// leads into a tube or a pocket. A tube is a group of faces that hang together, all of whose outlines are so
/// short, and whose area is not much more than that of a tube of such a girth and their extent; it goes. The
/// hole is closed by triangles of the face around it. What has several faces around it stays. Warnings name
/// each hole.
SurfaceModel close_small_holes(SurfaceModel model, double length);

}  // namespace delquad
