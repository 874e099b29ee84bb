// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <vector>

#include "delquad/fields.h"
#include "geometry/planar/planar_model.h"
#include "geometry/surface/flatten.h"
#include "geometry/surface/surface_model.h"

// This header makes points and lines part of a surface. The preparation uses it.

namespace delquad {

/// Makes model.loose part of the triangulation of the model, which is split along the lines.
///
/// Points go to the nearest place of the surface. Between two points a line follows the section with the
/// plane through both and the mean of their normals, by the shortest way. The side of that plane on which
/// each vertex lies decides it. The line becomes embedded curves, one in each face, which share nodes with
/// all curves that they cross. Each single point on no curve gets a nameless curve, so that any mesh has it
/// as a node. The curve reaches about one size to either side, away from near curves and points (see
/// dangling_ends()).
///
/// Throws InputError for requested lines that are further than a thousandth of the model's diagonal from the
/// surface, leave it or run along another curve. So it does for requested lines of length zero, or with
/// points nearer to each other than a thousandth of the size. The last reason is a point with no room for a
/// curve. The model's warnings name lines of its file that are left out.
void imprint(SurfaceModel& model, const SizeField& size);

/// Opens a flattened model along embedded cracks, with the points of its maps. Each crack becomes two curves,
/// one of each side, which share its ends inside of faces (own method).
void open_cracks(SurfaceModel& model, std::vector<FlatPatch>& maps);

/// Imprints the loose lines and points of a model, and returns the size with all sizes by name, also of
/// these. Throws InputError as imprint(), and for a name that no part has.
std::shared_ptr<const SizeField> imprint_named(const std::vector<NamedSize>& named,
                                               std::shared_ptr<const SizeField> size, SurfaceModel& model,
                                               std::vector<Warning>& warnings);

}  // namespace delquad
