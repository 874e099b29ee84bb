// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "geometry/planar/planar_model.h"
#include "geometry/surface/surface_model.h"

// This header turns planar models into surfaces with flat faces. Symmetry uses it.

namespace delquad {

/// Returns a planar model as a surface at z = 0 with the model's true curves behind chords. Its curves are
/// the pieces between compulsory nodes, with the number and name of their first curve. Curves in no loop are
/// embedded. Named points on no curve are vertices without triangles. Throws InputError as make_domain(), but
/// for sizes.
SurfaceModel flat_model(const PlanarModel& model);

}  // namespace delquad
