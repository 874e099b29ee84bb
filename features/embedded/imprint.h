// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "delquad/fields.h"
#include "geometry/planar/planar_model.h"
#include "geometry/surface/surface_model.h"

// This header makes points and lines part of a surface. The preparation uses it.

namespace delquad {

/// Makes model.loose part of the model's triangulation, which is split along them.
///
/// Points go to the nearest place of the surface. Between two of them a line runs where the plane through
/// both and the mean of their normals cuts the surface. It takes the shortest way, decided by which side of
/// that plane each vertex lies on. It becomes embedded curves, one in each face that it runs through, which
/// share nodes with all that they cross. Each single point on no curve gets a nameless curve, so that any
/// mesh has it as a node. The curve reaches about one size to either side, away from curves and points that
/// are near (as dangling_ends() in the plane).
///
/// Throws InputError for requested lines that are further than a thousandth of the model's diagonal from the
/// surface, leave it or run along another curve. So it does for requested lines of length zero, or with
/// points nearer to each other than a thousandth of the size. The last reason is a point with no room for a
/// curve. The model's warnings name lines of its file that are left out.
void imprint(SurfaceModel& model, const SizeField& size);

/// Imprints the loose lines and points of a model, and returns the size with what is asked of it by names,
/// theirs among them. Throws InputError as imprint() does, and for a name that nothing has.
std::shared_ptr<const SizeField> imprint_named(const std::vector<NamedSize>& named,
                                               std::shared_ptr<const SizeField> size, SurfaceModel& model,
                                               std::vector<Warning>& warnings);

}  // namespace delquad
